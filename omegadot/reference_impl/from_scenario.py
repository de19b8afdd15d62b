"""From a scenario, as a person writes it, to the system and state that the equations take."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.inertia import assemble, inertia_of_moments, place
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Body, Load, State, System
from omegadot.scenarios import Scenario
from omegadot.scenarios.parts import Part
from omegadot.scenarios.solids import mass, mean_squares


def body_of_part(part: Part) -> Body:
    """One part as a body, in the axes and from the origin of the whole."""
    amount = np.array(mass(part))
    alone = Body(amount, np.zeros(3), inertia_of_moments(amount, np.array(mean_squares(part))))
    return place(alone, np.array(part.position), np.array(part.orientation))


def system_of(scenario: Scenario) -> System:
    """The scenario's body and load. Parts are summed by equation (5)."""
    given = scenario.body
    if given.part:
        body = assemble([body_of_part(part) for part in given.part])
    else:
        body = Body(
            mass=np.array(given.mass, dtype=float),
            center_of_mass=np.array(given.center_of_mass, dtype=float),
            inertia=np.array(given.inertia, dtype=float),
        )
    return System(bodies=(body,), load=_load_of(scenario))


def _load_of(scenario: Scenario) -> Load:
    given = scenario.load
    torques = {one.frame: np.array(one.value, dtype=float) for one in given.torque}
    return Load(
        gravity=np.array(given.gravity, dtype=float),
        pivot=None if given.pivot is None else np.array(given.pivot, dtype=float),
        damping=np.array(given.damping, dtype=float),
        torque_body=torques.get("body", np.zeros(3)),
        torque_world=torques.get("world", np.zeros(3)),
    )


def initial_state_of(scenario: Scenario) -> State:
    """The scenario's initial state; a pivoted body is placed where its pivot holds it."""
    given = scenario.initial

    state = State(
        orientation=normalize(np.array(given.orientation, dtype=float)),
        angular_velocity=np.array(given.angular_velocity, dtype=float),
        position=np.array(given.position, dtype=float),
        linear_velocity=np.array(given.linear_velocity, dtype=float),
    )
    return place_on_pivot(system_of(scenario), state)
