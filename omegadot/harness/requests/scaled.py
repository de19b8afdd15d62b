"""The same system with one size doubled, or turned: how what is wrong depends on that alone.

It is requested where forward dynamics are wrong, and judged by no gate.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.states import equation
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness.drive import CaseResult, Driver
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import turn_in_world
from omegadot.reference_impl.system import Acceleration, Load, State, System

TWICE = 2.0
STATES = 12
ATTITUDE = "the attitude"
TURN = np.array([0.3, 0.5, 0.8])  # rad, about no axis of symmetry


def doubled(system: System, states: State) -> Iterator[tuple[str, System, State]]:
    """What is doubled, the system with it, and the states; all else is the same.

    The attitude is turned instead, in the world.
    """
    body, load = system.body, system.load
    yield "|omega|", system, replace(states, angular_velocity=TWICE * states.angular_velocity)
    if load.pivot is None and np.any(states.linear_velocity):
        faster = replace(states, linear_velocity=TWICE * states.linear_velocity)
        yield "the linear velocity", system, faster
    if load.pivot is None and np.any(states.position):
        yield "the position", system, replace(states, position=TWICE * states.position)
    turned = turn_in_world(states.orientation, TURN, 1.0)
    yield ATTITUDE, system, replace(states, orientation=turned)
    yield "the mass", replace(system, bodies=(replace(body, mass=TWICE * body.mass),)), states
    longer = replace(
        body, inertia=TWICE**2 * body.inertia, center_of_mass=TWICE * body.center_of_mass
    )
    pivot = None if load.pivot is None else TWICE * load.pivot
    yield "the size", replace(system, bodies=(longer,), load=replace(load, pivot=pivot)), states
    yield (
        "the inertia",
        replace(system, bodies=(replace(body, inertia=TWICE * body.inertia),)),
        states,
    )

    def loaded(other: Load) -> System:
        return replace(system, load=other)

    if np.any(load.damping):
        yield "the damping", loaded(replace(load, damping=TWICE * load.damping)), states
    if np.any(load.gravity):
        yield "gravity", loaded(replace(load, gravity=TWICE * load.gravity)), states
    if np.any(load.torque_body) or np.any(load.torque_world):
        more = {k: TWICE * getattr(load, k) for k in ("torque_body", "torque_world")}
        yield "the applied torque", loaded(replace(load, **more)), states


def request_scaled(
    driver: Driver, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> None:
    """Forward dynamics of each into `result`, where those of the case itself are wrong."""
    if not result.forward.ok or result.scaled:
        return
    found, eps = Acceleration(**result.forward.result), eps_of(result.precision)
    rows = equation.forward_rows(case.system, evaluation_states.random, found, "residual", eps)
    if all(row.verdict != "fail" for row in rows):
        return
    few = evaluation_states.random[:STATES]
    for what, system, states in doubled(case.system, few):
        how = "other" if what == ATTITUDE else "twice"
        name = f"{case.name}-with-{how}-{what.replace(' ', '-').replace('|', '')}"
        scenario = case.scenario.model_copy(update={"name": name})
        other = replace(case, scenario=scenario, system=system)
        placed = place_on_pivot(system, states)
        answer = driver.request(other, "forward", states=placed)
        result.scaled[what] = (system, placed, answer)
