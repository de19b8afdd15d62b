"""Velocities taken from two places: their rounding is allowed for, and no wrong equation is.

What these tests catch: position-based dynamics accused of its rounding, and a rule that excuses the
steps of any scheme which turns the body by the new omega.
"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.roundings import PLAIN, Roundings, roundings_per_step
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.steps.limits import roundings_of
from omegadot.gates.steps.probe import Probe, probe_of
from omegadot.gates.steps.vanishing_step import rows
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import (
    conjugate,
    exp_quaternion,
    normalize,
    quaternion_product,
)
from omegadot.reference_impl.system import Body, Load, State, System

TENSOR = np.array([[1.0, 0.1, 0.2], [0.1, 1.6, -0.15], [0.2, -0.15, 2.1]])
SYSTEM = System(
    (Body(np.array(2.0), np.zeros(3), TENSOR),),
    Load(gravity=np.array([0.3, -1.0, -9.0]), damping=np.array(0.2)),
)
BOTH = Roundings(of_places=True, of_turns=True)


@pytest.fixture(scope="module")
def probe() -> Probe:
    draw = np.random.default_rng(3)
    q = normalize(draw.normal(size=(6, 4)))
    states = State(q, *(draw.normal(size=(6, 3)) * size for size in (2.0, 50.0, 3.0)))
    return probe_of(SYSTEM, SimpleNamespace(random=states, path=states))  # type: ignore[arg-type]


def stepped(probe: Probe, from_places: bool, equation: float = 1.0) -> State:
    """Semi-implicit Euler of omega-dot times `equation`; then velocities from places, or not."""
    shape, h = probe.timesteps.shape, probe.timesteps[..., None]
    q, w, x, v = (
        np.broadcast_to(f[:, None], (*shape, f.shape[-1])) for f in vars(probe.states).values()
    )
    acceleration = forward_dynamics(SYSTEM, State(q, w, x, v))
    w, v = w + h * equation * acceleration.angular, v + h * acceleration.linear
    turned, moved = quaternion_product(q, exp_quaternion(h * w)), x + h * v
    if from_places:
        between = quaternion_product(conjugate(q), normalize(turned))
        w = 2.0 * between[..., 1:] * np.sign(between[..., :1]) / h
        v = (moved - x) / h
    return State(normalize(turned), w, moved, v)


def failing(probe: Probe, ends: State, roundings: Roundings) -> set[str]:
    found = rows(SYSTEM, probe, ends, known=True, roundings=roundings)
    return {row.channel for row in found if row.verdict == "fail"}


def test_rounding_of_places_is_allowed_in_velocities_that_are_taken_from_them(
    probe: Probe,
) -> None:
    ends = stepped(probe, from_places=True)
    assert roundings_of(SYSTEM, probe, ends, EPS, 16.0) == BOTH
    assert failing(probe, ends, BOTH) == set()
    assert {"omega", "linear_momentum"} <= failing(probe, ends, PLAIN)


@pytest.mark.parametrize("seed", range(40))
def test_a_single_state_shows_a_velocity_that_is_the_change_of_a_place(seed: int) -> None:
    """Caught: a thin body accused, of whose states only the one at rest shows the rounding.

    By how much more the shorter steps of one state are off is left to chance.
    """
    draw = np.random.default_rng(seed)
    states = State(
        normalize(draw.normal(size=(1, 4))),
        *(draw.normal(size=(1, 3)) * size for size in (2.0, 50.0, 3.0)),
    )
    one = probe_of(SYSTEM, SimpleNamespace(random=states, path=states))  # type: ignore[arg-type]
    one = Probe(one.states[:1], one.timesteps[:1])
    found = roundings_of(SYSTEM, one, stepped(one, from_places=True), EPS, 16.0)
    assert failing(one, stepped(one, from_places=True), found) == set()
    assert roundings_of(SYSTEM, one, stepped(one, from_places=False), EPS, 16.0) == PLAIN
    wrong = stepped(one, from_places=False, equation=1.001)
    assert roundings_of(SYSTEM, one, wrong, EPS, 16.0) == PLAIN


@pytest.mark.parametrize("equation", [1.0, 1.0 + 1e-8])
def test_a_scheme_that_turns_by_the_new_omega_has_no_such_rounding(
    probe: Probe, equation: float
) -> None:
    ends = stepped(probe, from_places=False, equation=equation)
    found = roundings_of(SYSTEM, probe, ends, EPS, 16.0)
    assert found == PLAIN
    assert failing(probe, ends, found) == ({"omega"} if equation > 1.0 else set())


@pytest.mark.parametrize("equation", [0.999, 1.001])
def test_a_wrong_equation_fails_all_the_same(probe: Probe, equation: float) -> None:
    ends = stepped(probe, from_places=True, equation=equation)
    assert "omega" in failing(probe, ends, BOTH)


def test_in_a_run_the_rounding_of_a_turn_and_of_a_place_is_that_of_each_step() -> None:
    """``16 eps (n + 1)`` of ``1 / (h rate)`` in omega, and of ``|x| / h`` in the velocity."""
    times, one = np.array([0.0, 1.0]), np.ones(2)
    q = np.array([[1.0, 0.0, 0.0, 0.0]] * 2)
    states = State(q, *(np.array([[0.0, 0.0, size]] * 2) for size in (2.0, 7.0, 3.0)))
    sphere = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),))
    own = Yardstick(sphere, times, states)
    h, steps = 1e-3, np.array([0.0, 1000.0])
    amount = 16 * EPS * (steps + 1.0)
    theta = own.of_roundings(Roundings(of_turns=True)).round_off(h, steps, one)["omega"]
    assert theta == pytest.approx(amount * (1.0 / (h * 2.0) + h * own.acceleration / 2.0))
    channel = "linear_momentum"
    plain = own.round_off(h, steps, one)[channel]
    more = own.of_roundings(Roundings(of_places=True)).round_off(h, steps, one)[channel]
    assert (more - plain) * own.sizes[channel] == pytest.approx(amount * 7.0 / h)


def test_an_extrapolation_of_high_order_rounds_more_often() -> None:
    """Order 4 has the weights 4/3 and 1/3 of 4 and 2 steps: 3 halves of a rounding each."""
    assert [roundings_per_step(order) for order in (0, 1, 4, 6)] == [16.0] * 4
    assert roundings_per_step(8) == pytest.approx(22.0, abs=0.5)
    assert roundings_per_step(12) == pytest.approx(136.0, abs=0.5)
    assert roundings_per_step(7) == roundings_per_step(8)


def test_in_single_precision_a_velocity_that_is_the_change_of_place_tells_it() -> None:
    """The start is the engine's own, rounded; a velocity that is stepped is no change of place."""
    single = float(np.finfo(np.float32).eps)
    draw = np.random.default_rng(4)
    q = normalize(draw.normal(size=(6, 4)))
    states = State(q, *(draw.normal(size=(6, 3)) * size for size in (2.0, 50.0, 3.0)))
    found = SimpleNamespace(random=states, path=states)
    probe = probe_of(SYSTEM, found, single)  # type: ignore[arg-type]
    for from_places in (True, False):
        ends = in_single(probe, from_places)
        roundings = roundings_of(SYSTEM, probe, ends, single, 16.0)
        assert (roundings.of_places, roundings.of_turns) == (from_places, from_places)


def in_single(probe: Probe, from_places: bool) -> State:
    """Semi-implicit Euler in numbers of single precision."""
    f = np.float32
    shape, h = probe.timesteps.shape, probe.timesteps[..., None].astype(f)
    q, w, x, v = (
        np.broadcast_to(one[:, None], (*shape, one.shape[-1])).astype(f)
        for one in vars(probe.states).values()
    )
    acceleration = forward_dynamics(SYSTEM, State(q, w, x, v))
    w, v = w + h * acceleration.angular.astype(f), v + h * acceleration.linear.astype(f)
    turned, moved = normalize(quaternion_product(q, exp_quaternion(h * w))), x + h * v
    if from_places:
        between = quaternion_product(conjugate(q), turned)
        w = 2.0 * between[..., 1:] * np.sign(between[..., :1]) / h
        v = (moved - x) / h
    return State(*(one.astype(float) for one in (turned, w, moved, v)))
