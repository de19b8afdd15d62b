"""The reference and the exact solution, run as engines are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mujoco_cases import EPS, at, norm, parts, states, system

from omegadot.adapters.exact.adapter import ExactAdapter
from omegadot.adapters.protocol import Integrator
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.schemes import COMMON, SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State, System


def start_of(of: System, seed: int) -> State:
    return place_on_pivot(of, at(states(1, seed=seed, far=1.0, fast=2.0), 0))


def reference(of: System) -> ReferenceAdapter:
    adapter = ReferenceAdapter()
    adapter.load(of)
    return adapter


def exact(of: System) -> ExactAdapter:
    adapter = ExactAdapter()
    adapter.load(of)
    return adapter


def test_the_reference_offers_common_schemes_under_their_own_names() -> None:
    offered = ReferenceAdapter().description.integrators
    assert {i.name: i.orders for i in offered} == {n: s.orders for n, s in COMMON.items()}
    assert all(i.name == i.scheme for i in offered)


@pytest.mark.parametrize("scheme", sorted(SCHEMES))
def test_the_reference_runs_the_scheme_that_was_named(scheme: str) -> None:
    of = system("full", "pivot_all")
    start = start_of(of, 31)
    found = reference(of).run(start, scheme, 0.01, 10, 4)
    times, expected = step_body(SCHEMES[scheme], of, start, 0.01, 10, 4)
    assert np.array_equal(found.time, times)
    for one, other in zip(parts(found.state), parts(expected), strict=True):
        assert np.array_equal(one, other)


def test_the_reference_needs_a_system_and_a_state() -> None:
    with pytest.raises(RuntimeError, match="load"):
        ReferenceAdapter().model()
    with pytest.raises(RuntimeError, match="state"):
        reference(system()).get_state()


@pytest.mark.parametrize("load", ["none", "all", "pivot_all"])
def test_the_exact_solution_does_not_depend_on_the_step(load: str) -> None:
    of = system("full", load)
    start = start_of(of, 32)
    coarse = exact(of).run(start, "series", 0.25, 8, 1)
    fine = exact(of).run(start, "series", 0.0625, 32, 4)
    assert np.array_equal(coarse.time, fine.time)
    for one, other in zip(parts(coarse.state), parts(fine.state), strict=True):
        assert np.max(norm(one - other)) <= 1e-13 * np.max(norm(one))


@pytest.mark.parametrize("load", ["all", "pivot_all"])
def test_the_reference_tends_to_the_exact_solution(load: str) -> None:
    """Halving the step of a fourth-order scheme leaves a sixteenth of the error."""
    of = system("full", load)
    start = start_of(of, 33)
    truth = exact(of).run(start, "series", 0.02, 50, 50).state
    errors = []
    for steps in (50, 100):
        found = reference(of).run(start, "rk4-quaternion", 1.0 / steps, steps, steps).state
        errors.append(norm(found.angular_velocity - truth.angular_velocity)[-1])
    assert 3.7 <= np.log2(errors[0] / errors[1]) <= 4.3


@pytest.mark.parametrize("load", ["none", "pivot_gravity"])
def test_the_exact_solution_keeps_what_is_conserved(load: str) -> None:
    of = system("full", load)
    found = exact(of).run(start_of(of, 34), "series", 0.5, 20, 1).state
    energy = total_energy(of, found)
    assert np.max(np.abs(energy - energy[0])) <= 1e-13 * np.max(np.abs(energy) + 1)
    momentum = angular_momentum(of, found)
    if of.load.pivot is None:
        assert np.max(norm(momentum - momentum[0])) <= 1e-13 * norm(momentum[0])
    else:
        about_gravity = momentum @ of.load.gravity / norm(of.load.gravity)
        largest = np.max(norm(momentum))
        assert np.max(np.abs(about_gravity - about_gravity[0])) <= 1e-13 * largest


def test_the_exact_solution_starts_at_the_start() -> None:
    of = system("full", "all")
    start = start_of(of, 35)
    found = exact(of).run(start, "series", 0.01, 0, 1)
    assert np.array_equal(found.time, [0.0])
    assert attitude_angle(found.state.orientation[0], start.orientation) <= 8 * EPS
    for given, reported in zip(parts(start)[1:], parts(found.state)[1:], strict=True):
        assert norm(reported[0] - given) <= 8 * EPS * norm(given)


def test_an_integrator_that_steps_the_origin_names_its_coordinates() -> None:
    """Adapters written before `coordinates` keep their meaning, in the harness and on the wire."""
    old = Integrator("euler", None, {"omega": 1}, steps_origin=True)
    assert old == Integrator("euler", None, {"omega": 1}, coordinates="origin-world")
    assert replace(old, note="as it is").coordinates == "origin-world"
