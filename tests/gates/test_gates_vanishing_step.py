"""Steps made ever smaller: where the states and steps come from, the limit, and its notes.

What these tests catch: an extrapolant of the wrong level, whose difference from the best would show
nothing; steps that are long against the motion; a fault of one channel reported as one of all.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    ROUNDINGS_PER_STEP,
    angular_size,
    between_ellipsoids,
    products_in_momentum,
)
from omegadot.gates.steps.limits import Limit, Tolerated, _extrapolants, limits
from omegadot.gates.steps.probe import DOUBLE, Probe, probe_of
from omegadot.gates.steps.vanishing_step import _common_factor, rows
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import exp_quaternion, rotation_matrix
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, Body, Load, State, System

RADIANS, STEPS = DOUBLE.radians, DOUBLE.count
UNIT = np.array([1.0, 0.0, 0.0, 0.0])


def states(*omegas: object) -> State:
    w = np.array(omegas, float)
    nothing = np.zeros_like(w)
    return State(np.broadcast_to(UNIT, (len(w), 4)), w, nothing, nothing)


def system(*moments: float, **load: object) -> System:
    return System((Body(np.array(1.0), np.zeros(3), np.diag(moments)),), Load(**load))


def probe(on: System, *omegas: object) -> Probe:
    found = states(*omegas)
    return probe_of(on, SimpleNamespace(random=found, path=found))  # type: ignore[arg-type]


def test_steps_to_no_numbers_fail_also_from_rest() -> None:
    on = system(1.0, 2.0, 3.0)
    still = probe(on, [0.0, 0.0, 0.0])
    lost = State(*(np.full((*still.timesteps.shape, n), np.nan) for n in (4, 3, 3, 3)))
    found = rows(on, still, lost)
    assert {row.verdict for row in found} == {"fail"}
    assert {row.note for row in found} == {"a step leads to numbers that are not finite"}


@pytest.mark.parametrize(("level", "degree"), [(0, 4), (1, 3), (2, 2)])
def test_each_extrapolant_is_exact_for_its_own_degree(level: int, degree: int) -> None:
    h = 2.0 ** -np.arange(5)
    powers = np.arange(1, degree + 2)
    exact = 3.0 + np.sum(h[:, None] ** powers[:-1], axis=-1)
    beyond = 3.0 + np.sum(h[:, None] ** powers, axis=-1)
    assert _extrapolants(exact[:, None])[level][0] == pytest.approx(3.0, abs=1e-13)
    assert abs(_extrapolants(beyond[:, None])[level][0] - 3.0) > 1e-5


def test_steps_are_short_against_the_fastest_that_goes_on() -> None:
    # A sphere turns and does nothing else: |omega| = 5 rad/s.
    found = probe(system(2.0, 2.0, 2.0), [3.0, 4.0, 0.0])
    assert found.timesteps.shape == (2, STEPS)
    assert np.allclose(found.timesteps[:, 0], RADIANS / 5.0, rtol=1e-15)
    assert np.all(found.timesteps[:, :-1] == 2.0 * found.timesteps[:, 1:])
    # From rest a torque of 32 N m on 2 kg m^2 turns it at 16 rad/s^2: sqrt(16) = 4 rad/s.
    found = probe(system(2.0, 2.0, 2.0, torque_body=np.array([0.0, 32.0, 0.0])), [0.0, 0.0, 0.0])
    assert np.allclose(found.timesteps[:, 0], RADIANS / 4.0, rtol=1e-15)
    # A damping of 20 N m s/rad on 2 kg m^2 brakes at 10 per s.
    found = probe(system(2.0, 2.0, 2.0, damping=np.array(20.0)), [1.0, 0.0, 0.0])
    assert np.allclose(found.timesteps[:, 0], RADIANS / 10.0, rtol=1e-12)
    # Where nothing goes on, any will do: one as for 1 rad/s.
    assert np.all(probe(system(2.0, 2.0, 2.0), [0.0, 0.0, 0.0]).timesteps[:, 0] == RADIANS)


def test_the_nearer_of_two_ranges_counts() -> None:
    expected = np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    apart = np.array([[[0, 0, 0], [0, 6e-3, 0]], [[1e-3, 0, 0], [0, 0, 2e-3]]])
    found = expected + apart
    limit = Limit(found, expected, np.full((2, 2), 1e-3))
    assert limit.shares() == pytest.approx([0.0, 2.0])
    assert limit.off("m/s") == "the relative error is 0.001"
    still = Limit(apart, np.zeros((2, 3)), np.full((2, 2), 1e-3))
    assert still.off("m/s") == "it is 0.002 m/s instead of nothing"
    assert Limit(found, expected, np.full((2, 2), np.nan)).shares().tolist() == [0.0, np.inf]


def reported(
    on: System,
    requested: Probe,
    stretch: float = 1.0,
    omega: float = 1.0,
    kept: Callable[[Array], Array] = lambda w: w,
) -> dict[str, str]:
    """The notes of failing channels where steps and omega's changes are longer than requested."""

    def lane(k: int) -> State:
        dt = stretch * h[:, k]
        ends = step_body(SCHEMES["lie-rk4"], on, requested.states, dt, 1, 1)[1]
        return State(*(values[-1] for values in vars(ends).values()))

    h = requested.timesteps
    lanes = [lane(k) for k in range(STEPS)]
    stepped = State(*(np.stack(v, 1) for v in zip(*(vars(s).values() for s in lanes), strict=True)))
    before: Array = requested.states.angular_velocity[:, None]
    w = kept(before + omega * (stepped.angular_velocity - before))
    stepped = State(stepped.orientation, w, stepped.position, stepped.linear_velocity)
    assert set(limits(on, requested, stepped)) == {
        "attitude",
        "omega",
        "position",
        "linear_momentum",
    }
    return {row.channel: row.note for row in rows(on, requested, stepped) if row.verdict == "fail"}


def test_velocities_kept_as_momenta_are_rounded_as_such() -> None:
    # A thin bar askew: what rounds its momentum by eps turns omega by eps |J w| / lambda.
    axes = rotation_matrix(np.array([0.5, 0.1, -0.7, 0.5]))
    inertia = axes @ np.diag([1.0, 1.0, 1e-6]) @ axes.T
    on = System((Body(np.array(1.0), np.zeros(3), 0.5 * (inertia + inertia.T)),), Load())
    requested = probe(on, [0.4, -1.0, 0.7], [1.2, 0.3, -0.5])

    def kept(w: Array) -> Array:
        return np.linalg.solve(on.body.inertia, (on.body.inertia @ w[..., None]))[..., 0]

    assert reported(on, requested, kept=kept) == {}
    assert set(reported(on, requested, omega=1.01)) == {"omega"}


def test_a_momentum_is_rounded_by_the_products_that_cancel_in_it() -> None:
    # About the thin axis of a bar askew J w is 1e-3 w, the sum of products of the size of w.
    driven = Load(torque_world=np.array([1e-7, 0.0, 0.0]))  # nothing keeps its ellipsoids
    axes = rotation_matrix(np.array([0.5, 0.1, -0.7, 0.5]))
    inertia = axes @ np.diag([1.0, 1.0, 1e-3]) @ axes.T
    on = System((Body(np.array(1.0), np.zeros(3), 0.5 * (inertia + inertia.T)),), driven)
    requested = probe(on, axes @ [0.0, 0.0, 0.1], axes @ [0.0, 0.0, 0.07])
    h = requested.timesteps
    stepped = State(*(np.repeat(x[:, None], STEPS, 1) for x in vars(requested.states).values()))
    w = requested.states.angular_velocity
    inertia = on.body.inertia
    formed = inertia.astype(np.float32).astype(float) @ w[..., None]  # products in single precision
    off = np.linalg.norm(np.linalg.solve(inertia, formed)[..., 0] - w, axis=-1)
    off = ROUNDINGS_PER_STEP * off * EPS / np.finfo(np.float32).eps
    assert np.all(limits(on, requested, stepped)["omega"].rounding[1] >= off / h[:, -1])
    # along the principal axes nothing cancels
    straight = system(1.0, 2.0, 1e-8)
    w = np.array([0.1, -0.2, 0.3])
    assert products_in_momentum(straight, w) == pytest.approx(np.sqrt(0.17), rel=4 * EPS)


def test_a_step_that_does_not_vanish_is_reported_as_one() -> None:
    on = system(1.0, 2.0, 3.0)
    requested = probe(on, [0.4, -1.0, 0.7], [1.2, 0.3, -0.5])
    notes = reported(on, requested, kept=lambda w: w + np.array([0.0, 0.25, 0.0]))
    assert notes["omega"] == "as the step vanishes, it still changes by 0.25 rad/s"


def test_omega_put_back_on_its_ellipsoids_is_open_in_one_direction_only() -> None:
    # Moments that differ by 1e-6: the ellipsoids of energy and momentum nearly coincide.
    on = system(1.0, 1.0 + 1e-6, 1.0 + 3e-6)
    requested = probe(on, [0.4, -1.0, 0.7], [1.2, 0.3, -0.5])
    w = requested.states.angular_velocity
    along, roundings = between_ellipsoids(on, w, EPS)
    assert np.all((roundings > 1e5) & (roundings < 1e7))
    signs = np.where(np.arange(STEPS) % 2, 1.0, -1.0)[:, None]
    push = 8 * EPS * roundings[:, None, None] * signs
    assert reported(on, requested, kept=lambda w: w + push * along[:, None]) == {}
    across = np.cross(along, w)
    assert set(reported(on, requested, kept=lambda w: w + push * across[:, None])) == {"omega"}
    # The gyroscopic term acts across that direction: of its 1e-6 a hundredth still shows.
    assert set(reported(on, requested, omega=1.01)) == {"omega"}
    # A torque moves omega off its ellipsoids, and no scheme puts it back.
    pushed = system(1.0, 1.0 + 1e-6, 1.0 + 3e-6, torque_body=np.array([0.0, 0.0, 0.1]))
    assert not np.any(between_ellipsoids(pushed, w, EPS)[1])


def test_at_rest_an_accuracy_is_that_of_what_changes() -> None:
    # From rest omega grows as w_dot t: parts of it, as of anything that is stepped, may be off, and
    # each step by an accuracy of 1 rad/s, as nothing has no size to take parts of.
    on = system(1.0, 2.0, 3.0, torque_body=np.array([0.3, -0.5, 0.7]))
    requested = probe(on, [0.0, 0.0, 0.0])
    h = requested.timesteps[..., None]
    still = {k: np.repeat(v[:, None], STEPS, 1) for k, v in vars(requested.states).items()}
    spun = h * np.array([0.3, -0.25, 0.7 / 3.0])

    def failing(off: float, accuracy: float) -> set[str]:
        found = State(**still | {"angular_velocity": spun * (1.0 + off)})
        tolerated = Tolerated(accuracy, accuracy * 10.0)
        return {
            r.channel for r in rows(on, requested, found, EPS, tolerated) if r.verdict == "fail"
        }

    assert failing(1e-9, 1e-9) == set()
    assert failing(1e-9, 0.0) == failing(1e-6, 1e-13) == {"omega"}


def test_a_momentum_about_the_worlds_origin_is_rounded_as_such() -> None:
    # m |x| |v| / lambda = 1 * 1e3 * 1e3 / 1: omega is off by 1e6 roundings.
    on = system(1.0, 2.0, 3.0)
    requested = probe(on, [0.4, -1.0, 0.7], [1.2, 0.3, -0.5])
    far = np.broadcast_to([1e3, 0.0, 0.0], (len(requested.timesteps), 3))
    requested = replace(
        requested, states=replace(requested.states, position=far, linear_velocity=far)
    )
    ends = [
        step_body(SCHEMES["lie-rk4"], on, requested.states, requested.timesteps[:, k], 1, 1)[1][-1]
        for k in range(STEPS)
    ]
    stepped = State(*(np.stack(v, 1) for v in zip(*(vars(s).values() for s in ends), strict=True)))
    signs = np.where(np.arange(STEPS) % 2, 1.0, -1.0)[:, None]
    rounded = replace(stepped, angular_velocity=stepped.angular_velocity + 8e6 * EPS * signs)
    of_unknown = {row.channel: row.verdict for row in rows(on, requested, rounded, known=False)}
    of_known = {row.channel: row.verdict for row in rows(on, requested, rounded)}
    assert (of_unknown["omega"], of_known["omega"]) == ("pass", "fail")


def test_a_place_at_the_origin_is_rounded_by_its_velocity() -> None:
    on = system(1.0, 2.0, 3.5)
    found = probe(on, [0.4, -1.0, 0.7], [1.2, 0.3, -0.5])
    speeds = np.resize([0.3, -2.0, 1.1, 0.7, 0.2, -0.9], (4, 3))
    moving = replace(found.states, linear_velocity=speeds)
    requested = Probe(moving, found.timesteps)

    def carried(errors: float) -> State:
        one = replace(moving[:, None], position=np.zeros((4, 1, 3)))
        wide = State(*(np.repeat(v, STEPS, 1) for v in vars(one).values()))
        h = requested.timesteps[..., None]
        way = h * wide.linear_velocity * (1.0 + errors * EPS)
        return replace(wide, position=way)

    assert limits(on, requested, carried(4.0))["position"].shares().max() <= 1.0
    assert limits(on, requested, carried(1e7))["position"].shares().max() > 1.0


def test_what_starts_from_rest_is_rounded_by_its_torque() -> None:
    on = system(1.0, 2.0, 3.5, torque_body=np.array([0.3, -0.2, 0.5]))
    requested = probe(on, [0.0, 0.0, 0.0])
    rate = np.array([0.3, -0.1, 0.5 / 3.5])

    def pushed(errors: float) -> State:
        one = requested.states[:, None]
        wide = State(*(np.repeat(v, STEPS, 1) for v in vars(one).values()))
        w = requested.timesteps[..., None] * rate * (1.0 + errors * EPS)
        return replace(wide, angular_velocity=w)

    assert limits(on, requested, pushed(32.0))["omega"].shares().max() <= 1.0
    assert limits(on, requested, pushed(3200.0))["omega"].shares().max() > 1.0


def test_a_factor_is_common_where_every_rate_is_off_by_it() -> None:
    expected = np.array([[1.0, 0.0, 0.0]])

    def limit(aside: float) -> Limit:
        found = 1.001 * expected + np.array([0.0, aside, 0.0])
        return Limit(np.stack([found, found]), expected, np.full((2, 1), 1e-6))

    assert _common_factor({"attitude": limit(0.0), "omega": limit(0.9e-6)}) == pytest.approx(1.001)
    assert _common_factor({"attitude": limit(0.0), "omega": limit(1.1e-6)}) is None


def test_what_is_reported_of_the_limit() -> None:
    on = system(1.0, 2.0, 3.5)
    requested = probe(on, [0.4, -1.0, 0.7], [1.2, 0.3, -0.5])
    assert reported(on, requested) == {}
    assert reported(on, requested, stretch=1.001) == {
        "attitude": "steps are 0.1 % too long",
        "omega": "steps are 0.1 % too long",
    }
    assert set(reported(on, requested, stretch=0.5).values()) == {"steps are 50 % too short"}
    # The state and the steps: of a run that comes near neither, nothing is seen in its trajectory.
    where = "from a state of |omega| = 1.33 rad/s, in steps up to 0.0052 s"
    off = "the relative error is 0.01 (0.8 rad/s^2 instead of 0.79)"
    assert reported(on, requested, omega=1.01) == {
        "omega": f"as the step vanishes, its rate is not the equation's: {off}, {where}"
    }


def test_from_rest_a_body_moves_by_what_rounding_makes_of_its_acceleration() -> None:
    """Caught: the attitude's rate at rest, held to less than its omega is rounded by in a step."""
    on = system(1e-9, 1.0, 1.0, torque_body=np.array([0.0, 1.0, 0.0]))
    still = probe(on, [0.0, 0.0, 0.0])
    true = acceleration_of(on)(still.states)
    size = ROUNDINGS_PER_EVALUATION * EPS * angular_size(on, still.states, true)
    h, random, shares = still.timesteps[..., None], np.random.default_rng(3), list[float]()
    for _ in range(100):
        off = 0.3 * size[:, None, None] * random.uniform(-1.0, 1.0, (STEPS, 1))
        w = h * (true.angular[:, None] + off * np.array([1.0, 0.0, 0.0]))
        stepped = State(exp_quaternion(0.5 * h * w), w, np.zeros_like(w), np.zeros_like(w))
        shares.append(float(np.max(limits(on, still, stepped)["attitude"].shares())))
    assert max(shares) < 1.0
    assert max(shares) > 0.01  # such rounding is seen
