"""The same system with one thing the other way: which condition makes an equation wrong.

It is requested where forward dynamics are wrong, and judged by no gate.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness.drive import CaseResult, Driver
from omegadot.harness.requests.scaled import STATES
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import Load, System

# A rate of 1 per s, with the inertia, makes a torque or a damping that is seen beside the rest.
TORQUE, DAMPED, PULL = (0.3, -0.5, 0.8), 0.1, 9.80665
TURN = ((2.0, -1.0, 2.0), (2.0, 2.0, -1.0), (-1.0, 2.0, 2.0))  # three times a rotation
ASIDE = (0.1, -0.2, 0.3)  # of the radius of gyration


def opposites(system: System) -> Iterator[tuple[str, System]]:
    """What is the other way, and the system with it; all else is the same.

    A lever stays where the centre of mass or the pivot moves to the origin, or away from it.
    """
    yield from _with_other_loads(system.load, system)
    body, load = system.body, system.load
    tensor = np.asarray(body.inertia, dtype=float)
    diagonal = np.diag(np.diag(tensor))
    turn = np.array(TURN) / 3.0
    other = turn @ tensor @ turn.T if np.array_equal(tensor, diagonal) else diagonal
    if not np.array_equal(other, tensor):
        yield "products", replace(system, bodies=(replace(body, inertia=other),))
    aside = np.array(ASIDE) * np.sqrt(np.trace(tensor) / body.mass)
    centre, pivot = np.asarray(body.center_of_mass), load.pivot
    for what, place in (("centre", centre), ("pivot", pivot)):
        if place is not None:
            by = -place if np.any(place) else aside
            moved = replace(body, center_of_mass=centre + by)
            held = replace(load, pivot=None if pivot is None else pivot + by)
            yield what, replace(system, bodies=(moved,), load=held)
    support = centre - aside if pivot is None else None
    yield "support", replace(system, load=replace(load, pivot=support))


def _with_other_loads(load: Load, system: System) -> Iterator[tuple[str, System]]:
    size = float(np.trace(system.body.inertia))

    def with_load(**changed: object) -> System:
        return replace(system, load=replace(load, **changed))  # type: ignore[arg-type]

    none = np.zeros(3)
    if np.any(load.torque_body) or np.any(load.torque_world):
        yield "torque", with_load(torque_body=none, torque_world=none)
        yield "frame", with_load(torque_body=load.torque_world, torque_world=load.torque_body)
    else:
        yield "torque", with_load(torque_body=size * np.array(TORQUE))
    yield "damping", with_load(damping=np.asarray(0.0 if np.any(load.damping) else DAMPED * size))
    pull = float(norm(load.gravity))
    down = np.array([0.0, 0.0, -(pull or PULL)])
    yield "gravity", with_load(gravity=none if pull else down)
    if pull:
        turned = np.roll(load.gravity, 1) if np.array_equal(load.gravity, down) else down
        yield "direction", with_load(gravity=turned)


def request_opposites(
    driver: Driver, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> None:
    """Forward dynamics of each into `result`; what an engine refuses is kept as such."""
    for what, other in opposite_cases(case):
        placed = place_on_pivot(other.system, evaluation_states.random[:STATES])
        answer = driver.request(other, "forward", states=placed)
        result.opposites[what] = (other.system, placed, answer)


def opposite_cases(case: Case) -> Iterator[tuple[str, Case]]:
    """By what is the other way, the case with it."""
    for what, system in opposites(case.system):
        name = f"{case.name}-with-the-other-{what}"
        scenario = case.scenario.model_copy(update={"name": name})
        yield what, replace(case, scenario=scenario, system=system)
