"""Engines whose schemes are methods on a chart step these, to rounding and for every load."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from mujoco_cases import EPS, LOADS, at, norm, parts, states, system

from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.adapters.registry import OURS, build_adapter, is_absent
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.schemes import COMMON, SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State, System

# Whether in the world's axes or not, each of a dozen operations of a step rounds rates that may
# double it; turns of the runs are 1 rad.
STEP, STEPS = 0.02, 25
SAME = 64 * EPS * STEPS
INSTALLED = sorted(
    {"drake", "exudyn", "opensim", "basilisk", "jaxsim"} - {*filter(is_absent, OURS)}
)


@cache
def engine(name: str) -> Adapter:
    return build_adapter(OURS[name])


def apart(one: State, other: State) -> float:
    """The largest distance between two states, of parts of the size of one."""
    pairs = zip(parts(one)[1:], parts(other)[1:], strict=True)
    sizes = [float(norm(a - b) / max(1.0, float(norm(b)))) for a, b in pairs]
    return max(float(attitude_angle(one.orientation, other.orientation)), *sizes)


def ends(name: str, of: System) -> dict[str, tuple[str, float]]:
    """By integrator its declared scheme, and how far apart the two are after the steps."""
    adapter, found = engine(name), dict[str, tuple[str, float]]()
    adapter.load(of)
    start = at(place_on_pivot(of, states(1, seed=3, far=1.0, fast=2.0)), 0)
    for one in adapter.description.integrators:
        if one.scheme is None:
            continue
        try:
            run = adapter.run(start, one.name, STEP, STEPS, STEPS)
        except UnsupportedError:
            continue
        how = (STEP, STEPS, STEPS, one.coordinates)
        expected = step_body(SCHEMES[one.scheme], of, start, *how)[1]
        found[one.name] = one.scheme, apart(run.state[-1], expected[-1])
    return found


@pytest.mark.parametrize("load", sorted(LOADS))
@pytest.mark.parametrize("name", INSTALLED)
def test_steps_are_those_of_the_declared_schemes(name: str, load: str) -> None:
    try:
        found = ends(name, system("full", load))
    except UnsupportedError:
        return
    assert all(distance <= SAME for _, distance in found.values()), found


@pytest.mark.parametrize("name", INSTALLED)
def test_schemes_on_its_chart_are_declared_by_each(name: str) -> None:
    """Caught: an adapter that declares none, of which the test above compares nothing."""
    found = ends(name, system("full"))
    assert len({scheme for scheme, _ in found.values()} - {*COMMON}) >= 2


def test_nearby_schemes_are_further_apart_than_that() -> None:
    """Those of one method on two charts, so that the bound distinguishes charts."""
    of = system("full", "gravity")
    start = at(states(1, seed=3, far=1.0, fast=2.0), 0)
    charts = ("world-quaternion", "roll-pitch-yaw", "two-frames-xyz")
    runs = [step_body(SCHEMES[f"heun-{c}"], of, start, STEP, STEPS, STEPS)[1][-1] for c in charts]
    runs.append(step_body(SCHEMES["heun-mrp"], of, start, STEP, STEPS, STEPS)[1][-1])
    for k, one in enumerate(runs):
        assert np.all([apart(one, other) > 1e3 * SAME for other in runs[:k]])
