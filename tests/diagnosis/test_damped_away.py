"""A wrong damping that takes omega off within the shortest steps is named as on other scenarios."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from wrong_equations import CASES, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.in_steps import StepCauses
from omegadot.diagnosis.kept_case import KeptCase
from omegadot.diagnosis.over_scenarios import OverScenarios
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.gates.steps.probe import probe_at
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State, System

SCHEME = "semi-implicit-euler"
LIGHT = case("light", {"damping": 0.5}, 1e-9)
DAMPED = tuple(
    case(f"damped-{k}", {"damping": damping}, mass)
    for k, (damping, mass) in enumerate(
        ((0.3, 2.0), (1.7, 0.7), (2.9, 5.0), (0.6, 9.0), (0.1, 1.1))
    )
)
EVERY = (CASES[0], *DAMPED, LIGHT)
Rate = Callable[[System], float]


def over_the_mass(system: System) -> float:
    return float(system.load.damping) / float(system.body.mass)


def of_no_law(system: System) -> float:
    """Of one mass it is as large as of all others that are not light."""
    return float(system.load.damping) * np.sin(7.0 / float(system.body.mass)) ** 2 + (
        1e9 if float(system.body.mass) < 1e-3 else 0.0
    )


def steps_of(one: Case, rate: Rate) -> VanishingSteps:
    """Euler's steps without damping, each with omega times ``exp(-h rate)`` at its end."""
    probe = probe_at(one.system, random_states(one, 12, [1]))
    free = replace(one.system, load=replace(one.system.load, damping=np.zeros(())))
    rates, h = forward_dynamics(free, probe.states), probe.timesteps[..., None]
    q, w, p, v = (values[:, None] for values in vars(probe.states).values())
    turned = quaternion_product(q, exp_quaternion(h * w))
    slower = (w + h * rates.angular[:, None]) * np.exp(-h * rate(one.system))
    after = State(turned, slower, p + h * v, v + h * rates.linear[:, None])
    return vanishing_steps(one.system, probe, after)


def jumped(name: str, rate: Rate, cases: tuple[Case, ...]) -> list[str]:
    across, integrator = Across(), Integrator(SCHEME, None, SCHEMES[SCHEME].orders)
    known = {one.name: steps_of(one, rate) for one in cases}
    kept = KeptCase(name, integrator, "", None, False, False, known[name])
    for one in cases:
        evidence = {kept.source: known[one.name].evidence}
        across.add(Scene(one.name, one.system, features_of(one.system, one.initial), evidence))
    return StepCauses(across, OverScenarios(), kept, list).jumped(known[name])


def test_a_damping_that_is_found_elsewhere_stops_a_light_body() -> None:
    """Caught: "omega is set to zero", which is no more than what such a damping does."""
    right = "in the steps, the damping is divided by the mass instead of the inertia"
    assert jumped("light", over_the_mass, EVERY) == [right]


def test_where_the_damping_is_not_understood_nothing_is_named() -> None:
    assert jumped("light", of_no_law, EVERY) == []


def test_where_every_other_damping_is_right_omega_is_set_to_zero() -> None:
    assert jumped("light", over_the_mass, (CASES[0], LIGHT)) == ["omega is set to zero"]
