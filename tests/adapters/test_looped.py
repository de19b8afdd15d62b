"""What is alike of engines that have dynamics and no stepper: the reference's schemes over them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, at, norm, states, system

from omegadot.adapters.looped import LOOPED, LoopedAdapter
from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.registry import OURS, build_adapter, is_absent
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State, System

ENGINES = [name for name in ("pinocchio", "idyntree", "biorbd") if not is_absent(name)]
of_every_engine = pytest.mark.parametrize("name", ENGINES)


def loaded(name: str, of: System) -> Any:
    adapter = build_adapter(OURS[name])
    assert isinstance(adapter, LoopedAdapter)
    adapter.load(of)
    return adapter


def growth(of: System, start: State, time: float) -> float:
    """How far a change may grow: ω̇ is quadratic in ω, ``|∂ω̇/∂ω| <= 2 cond(I) |ω|``."""
    moments = np.linalg.eigvalsh(moving_inertia(of))
    rate = 2 * moments[-1] / moments[0] * float(norm(start.angular_velocity))
    return float(np.exp(rate * time)) * (1 + time)


@of_every_engine
def test_every_scheme_is_an_integrator_named_for_what_it_is(name: str) -> None:
    adapter: Any = build_adapter(OURS[name])
    reported = adapter.description
    prefix = adapter.prefix
    assert {i.name: i.scheme for i in reported.integrators} == {
        prefix + scheme: scheme for scheme in LOOPED
    }
    assert all(i.orders == SCHEMES[str(i.scheme)].orders for i in reported.integrators)


@of_every_engine
@pytest.mark.parametrize("scheme", LOOPED)
@pytest.mark.parametrize("load", ["none", "all", "pivot_all"])
def test_loops_over_its_dynamics_are_the_references_loops(
    name: str, scheme: str, load: str
) -> None:
    of = system("full", load)
    start = place_on_pivot(of, at(states(1, seed=21, far=1.0, fast=2.0), 0))
    adapter = loaded(name, of)
    found = adapter.run(start, adapter.prefix + scheme, 0.005, 40, 5).state
    _, expected = step_body(SCHEMES[scheme], of, start, 0.005, 40, 5, "body-spatial")
    # a step evaluates at most some twenty accelerations, and each errs by a few roundings
    allowed = 64 * EPS * 40 * 20 * growth(of, start, 0.2)
    assert np.max(attitude_angle(found.orientation, expected.orientation)) <= allowed
    for one, other in (
        (found.angular_velocity, expected.angular_velocity),
        (found.position, expected.position),
        (found.linear_velocity, expected.linear_velocity),
    ):
        assert np.max(norm(one - other)) <= allowed * np.max(norm(other))


@of_every_engine
@pytest.mark.parametrize("load", ["all", "pivot_all"])
def test_states_are_answered_one_by_one(name: str, load: str) -> None:
    of = system("full", load)
    many = place_on_pivot(of, states(6, seed=22, fast=2.0))
    adapter = loaded(name, of)
    flat = adapter.forward_dynamics(many)
    single = adapter.forward_dynamics(State(*(values[4:5] for values in vars(many).values())))
    assert np.array_equal(single.angular[0], flat.angular[4])
    assert np.array_equal(single.linear[0], flat.linear[4])


@of_every_engine
def test_an_answer_is_not_overwritten_by_the_next(name: str) -> None:
    adapter, many = loaded(name, system("full", "all")), states(2, seed=23, fast=2.0)
    one, other = (State(*(v[n : n + 1] for v in vars(many).values())) for n in range(2))
    first = adapter.forward_dynamics(one)
    kept = replace(first, angular=first.angular.copy(), linear=first.linear.copy())
    adapter.forward_dynamics(other)
    assert np.array_equal(first.angular, kept.angular)
    assert np.array_equal(first.linear, kept.linear)


@of_every_engine
def test_the_force_of_rnea_is_newtons(name: str) -> None:
    """``F = m (a - g)``: the spatial acceleration that RNEA is given is the one requested."""
    of = system("full", "all")
    many, joint = states(10, seed=26, fast=2.0), loaded(name, of)._joint
    wanted = np.random.default_rng(27).normal(size=(10, 2, 3))
    for n in range(10):
        force = joint.wrench(at(many, n), *wanted[n])[:3]
        expected = of.body.mass * (wanted[n, 1] - of.load.gravity)
        expected = rotate_inverse(at(many, n).orientation, expected)
        assert norm(force - expected) <= 1e-13 * (norm(expected) + 50)


@of_every_engine
def test_rounding_does_not_grow_with_the_distance_from_the_origin(name: str) -> None:
    """ABA in the world's frame would lose (m d^2 / I) eps; at 1e5 m that is a part in a million."""
    of = system("full", "none")
    many = states(20, seed=24, far=1e5, fast=0.0)
    found, expected = loaded(name, of).forward_dynamics(many), forward_dynamics(of, many)
    most = np.max(norm(expected.angular))
    assert np.max(norm(found.angular - expected.angular)) <= 1e-13 * most


@of_every_engine
def test_only_its_own_names_are_integrators(name: str) -> None:
    start = at(states(1, seed=25), 0)
    with pytest.raises(UnsupportedError, match="semi-implicit-euler"):
        loaded(name, system()).run(start, "semi-implicit-euler", 0.01, 2, 1)
