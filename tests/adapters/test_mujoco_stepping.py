"""MuJoCo's steps against the reference's schemes, and the figures they are known by."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import mujoco
import numpy as np
import pytest
from mujoco_cases import (
    EPS,
    LOADS,
    at,
    norm,
    parts,
    states,
    system,
)

from omegadot.adapters.mujoco.adapter import MujocoAdapter
from omegadot.adapters.mujoco.integrators import version_of
from omegadot.adapters.mujoco.stepping import CHUNK, SPARSE
from omegadot.adapters.protocol import Setup, UnsupportedError
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import kept_steps, step_body
from omegadot.reference_impl.system import Array, Body, State, System

VERSION = version_of(mujoco.__version__)
NAMES = tuple(integrator.name for integrator in MujocoAdapter().description.integrators)
ZERO = np.zeros(3)
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])


def loaded(of: System, setup: Setup = "physics") -> MujocoAdapter:
    adapter = MujocoAdapter(setup)
    adapter.load(of)
    return adapter


@cache
def flip_by(scheme: str) -> tuple[State, float]:
    of, initial = flip()
    return stepped(of, scheme, initial, 0.001, 20_000)


def declared(adapter: MujocoAdapter, name: str) -> str | None:
    (found,) = (i for i in adapter.description.integrators if i.name == name)
    return found.scheme


def spread(state: State, distance: float) -> State:
    """Two lanes: the state, and one whose angular velocity is `distance` rad/s away."""
    q, w, p, v = (np.stack([value, value]) for value in parts(state))
    w[1] += distance / np.sqrt(3)
    return State(q, w, p, v)


def stepped(of: System, scheme: str, initial: State, dt: float, steps: int) -> tuple[State, float]:
    """The reference's run at the body's origin, and how much it enlarges an early error."""
    distance = 2.0**-26
    start = place_on_pivot(of, spread(initial, distance))
    lanes = step_body(SCHEMES[scheme], of, start, dt, steps, 1, "origin-world")[1]
    apart = [np.abs(value[:, 1] - value[:, 0]).max() for value in parts(lanes)]
    return State(*(value[:, 0] for value in parts(lanes))), float(max(apart)) / distance


def left_by_newton(of: System, scheme: str) -> float:
    """What MuJoCo 3.7 to 3.10 leave of the midpoint equation a step, relative to ω.

    Newton's method was seen to stop at residuals below 3e-13 of the momentum.
    """
    return 3e-13 * float(np.linalg.cond(of.body.inertia)) if "midpoint" in scheme else 0.0


def assert_equal_to_rounding(
    found: State, expected: State, growth: float, left: float = 0.0
) -> None:
    """Each step rounds by a few eps, and later steps enlarge what earlier ones rounded.

    left: what a step leaves besides, of an equation it solves.
    """
    steps = len(found.orientation)
    turned = State(normalize(expected.orientation), *parts(expected)[1:])
    for here, there in zip(parts(found), parts(turned), strict=True):
        size = max(1.0, float(np.abs(there).max()))
        assert np.abs(here - there).max() <= (16 * EPS + left) * steps * size * max(1.0, growth)


# -- schemes


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("setup", ["physics", "as-shipped", "as-shipped+mjDSBL_EULERDAMP"])
def test_steps_equal_the_declared_scheme(setup: Setup, name: str, load: str) -> None:
    """Every load acts in every stage; a step in the mass centre's velocity, another scheme, a

    load missing from a stage, or damping on the translation would show at 1e-6 or more.
    """
    of = system("full", load)
    adapter = loaded(of, setup)
    scheme = declared(adapter, name)
    assert scheme is not None
    initial = place_on_pivot(of, at(states(1, 11, 2.0, 2.0), 0))
    found = adapter.run(initial, name, 0.05, 40, 1).state
    expected, growth = stepped(of, scheme, initial, 0.05, 40)
    assert_equal_to_rounding(found, expected, growth, left_by_newton(of, scheme))


def test_the_declared_schemes_differ_on_these_runs() -> None:
    """The comparison above can fail: the schemes are far apart where it is made."""
    of = system("full", "pivot_damping")
    initial = place_on_pivot(of, at(states(1, 11, 2.0, 2.0), 0))
    names = {declared(loaded(of, setup), n) for n in NAMES for setup in ("physics", "as-shipped")}
    runs = [stepped(of, name, initial, 0.05, 40)[0].angular_velocity for name in names if name]
    assert len(runs) >= 4
    for i, one in enumerate(runs):
        assert all(np.abs(one - other).max() > 1e-6 for other in runs[:i])


def test_damping_leaves_the_translation_alone() -> None:
    of = system("full", "damping", center=ZERO)
    initial = at(states(1), 0)
    for name in NAMES:
        found = loaded(of).run(initial, name, 0.1, 50, 1).state.linear_velocity
        np.testing.assert_allclose(found, found[:1] + 0 * found, rtol=0, atol=64 * 50 * EPS * 50)


# -- runs


def test_run_starts_at_the_initial_state_and_keeps_time() -> None:
    of, initial = system(), at(states(1), 0)
    found = loaded(of).run(initial, "RK4", 0.01, 25, 10)
    np.testing.assert_array_equal(found.time, np.array([0, 10, 20, 25]) * 0.01)
    np.testing.assert_array_equal(found.state.angular_velocity[0], initial.angular_velocity)
    assert all(len(value) == 4 for value in parts(found.state))


@pytest.mark.parametrize("load", ["all", "none"])
@pytest.mark.parametrize("every", [1, 4, 7, SPARSE, 1000, 10**6])
def test_native_chunks_are_the_single_steps(
    load: str, every: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    of, steps = system("full", load), 2 * CHUNK + 5
    adapter, initial = loaded(of), at(states(1, 2, 1.0, 1.0), 0)
    native = adapter.run(initial, "Euler", 1e-4, steps, every)
    monkeypatch.setattr(adapter._stepper, "_rollout", None)
    single, kept = adapter.run(initial, "Euler", 1e-4, steps, 1), kept_steps(steps, every)
    np.testing.assert_array_equal(native.time, single.time[kept])
    # attitude and ω are as MuJoCo keeps them; the rest rounds as it is converted
    for one, other in zip(parts(native.state)[:2], parts(single.state)[:2], strict=True):
        np.testing.assert_array_equal(one, other[kept])


def test_without_rollout_the_steps_are_taken_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "mujoco.rollout", None)
    adapter = loaded(system())
    assert adapter._stepper._rollout is None
    assert len(adapter.run(at(states(1), 0), "Euler", 0.01, 3, 1).time) == 4


@pytest.mark.parametrize("name", NAMES)
def test_a_run_forgets_what_came_before(name: str) -> None:
    adapter, many = loaded(system("full", "all")), states(2, 6, 1.0, 1.0)
    first = adapter.run(at(many, 0), name, 0.01, 50, 5)
    adapter.run(at(many, 1), "RK4", 0.3, 20, 1)
    adapter.load(system("thin", "pivot_all"))
    adapter.run(at(many, 1), "Euler", 0.001, 20, 1)
    adapter.load(system("full", "all"))
    adapter.set_state(at(many, 1))
    adapter.forward_dynamics(many)
    second = adapter.run(at(many, 0), name, 0.01, 50, 5)
    for one, other in zip(parts(first.state), parts(second.state), strict=True):
        np.testing.assert_array_equal(one, other)


def test_refuses_an_integrator_it_has_not() -> None:
    with pytest.raises(UnsupportedError, match="no 'verlet'"):
        loaded(system()).run(at(states(1), 0), "verlet", 0.01, 1, 1)


# -- divergence


def exploding(setup: Setup, native: bool = True) -> Array:
    """Explicit steps of a whole second at 37 rad/s; ω is squared in each."""
    adapter = loaded(system("full", "all"), setup)
    if not native:
        adapter._stepper._rollout = None
    initial = State(UPRIGHT, np.array([30.0, 20.0, 10.0]), ZERO, ZERO)
    omega: Array = adapter.run(initial, "Euler", 1.0, 40, 1).state.angular_velocity
    return omega


def test_divergence_is_seen_and_not_reset() -> None:
    omega = exploding("physics")
    assert not np.isfinite(omega[-1]).any()
    finite = np.isfinite(omega).all(axis=-1)
    assert (np.diff(np.abs(omega[finite]).max(axis=-1)) > 0).all()  # never back to a pose at rest


def test_as_shipped_resets_when_it_diverges() -> None:
    """MuJoCo goes back to its first pose, at rest and without applied forces, and goes on."""
    speeds = norm(exploding("as-shipped"))
    fastest = int(speeds.argmax())
    assert speeds[fastest] > 1e6
    assert fastest < 39
    weight = 2.0 * norm(LOADS["all"].gravity)  # N; it turns nothing, but for rounding
    assert speeds[fastest + 1 :].max() <= 64 * EPS * 40 * weight


@pytest.mark.parametrize("setup", ["physics", "as-shipped"])
def test_a_diverging_run_is_the_same_natively(setup: Setup) -> None:
    np.testing.assert_array_equal(exploding(setup), exploding(setup, native=False))


def test_a_speed_beyond_the_largest_number_raises_no_warning() -> None:
    """The body's origin, 10 m from the centre of mass, moves at 10 times an ω that is finite."""
    body = Body(np.array(1.0), np.array([0.0, 10.0, 0.0]), np.eye(3))
    fast = State(UPRIGHT, np.array([1e308, 0.0, 0.0]), ZERO, ZERO)
    found = loaded(System((body,))).run(fast, "Euler", 1.0, 2, 1).state
    assert not np.isfinite(found.linear_velocity).all()


def test_divergence_leaves_no_file_and_prints_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    exploding("physics")
    exploding("as-shipped")
    assert list(tmp_path.iterdir()) == []
    assert "".join(capfd.readouterr()) == ""


def test_a_handler_of_warnings_that_is_set_already_is_kept() -> None:
    before, seen = mujoco.get_mju_user_warning(), []
    mujoco.set_mju_user_warning(seen.append)
    try:
        exploding("physics")
    finally:
        mujoco.set_mju_user_warning(before)
    assert seen


def test_a_slow_body_is_not_put_to_sleep() -> None:
    of = System((Body(np.array(1.0), ZERO, np.eye(3)),))
    initial = State(UPRIGHT, np.array([0.0, 0.0, 1e-6]), ZERO, np.array([1e-6, 0.0, 0.0]))
    for name in NAMES:
        last = loaded(of).run(initial, name, 0.01, 1000, 1000).state
        assert abs(last.angular_velocity[-1, 2] - 1e-6) <= 1000 * EPS * 1e-6
        assert abs(last.position[-1, 0] - 1e-5) <= 1000 * EPS * 1e-5


# -- figures


def flip() -> tuple[System, State]:
    of = System((Body(np.array(1.0), ZERO, np.diag([1.0, 2.0, 3.0])),))
    return of, State(UPRIGHT, np.array([0.01, 2.0, 0.01]), ZERO, ZERO)


def box() -> tuple[System, State]:
    """Half-sizes 0.1, 0.2, 0.3 m, 1 kg: moments m (b² + c²) / 3."""
    half = np.array([0.1, 0.2, 0.3]) ** 2
    of = System((Body(np.array(1.0), ZERO, np.diag((half.sum() - half) / 3)),))
    return of, State(UPRIGHT, np.array([1.0, 2.0, 3.0]), ZERO, ZERO)


def momentum_error(of: System, state: State) -> tuple[float, float]:
    """Relative: of the vector in the world, and of its length alone."""
    momentum = angular_momentum(of, state)
    start = norm(momentum[0])
    vector = norm(momentum - momentum[0]).max() / start
    return float(vector), float(np.abs(norm(momentum) / start - 1).max())


def test_flip_keeps_momentum_as_known() -> None:
    of, initial = flip()
    adapter = loaded(of)
    euler = adapter.run(initial, "Euler", 0.001, 20_000, 10).state
    assert f"{momentum_error(of, euler)[1]:.1e}" == "2.3e-03"
    vector, length = momentum_error(of, adapter.run(initial, "RK4", 0.001, 20_000, 10).state)
    assert length < 1e-13  # which cannot see the attitude
    assert f"{vector:.1e}" == ("2.5e-13" if VERSION >= (4,) else "1.9e-07")


@pytest.mark.parametrize("name", [name for name in NAMES if name != "RK4"])
def test_flip_equals_the_declared_scheme_over_20_000_steps(name: str) -> None:
    """The figures known are 1.7e-11 for Euler and 5e-11 for the implicit family."""
    of, initial = flip()
    adapter = loaded(of)
    scheme = declared(adapter, name)
    assert scheme is not None
    found = adapter.run(initial, name, 0.001, 20_000, 1).state
    assert_equal_to_rounding(found, *flip_by(scheme), left_by_newton(of, scheme))


def energy_ratio(name: str) -> float:
    of, initial = box()
    omega = loaded(of).run(initial, name, 0.01, 500, 500).state.angular_velocity
    moments = np.diagonal(of.body.inertia)
    energy = (omega**2 * moments).sum(axis=-1)
    return float(energy[-1] / energy[0])


def test_box_energy_shows_the_version() -> None:
    explicit, midpoint, implicit = "1.0869", "1.0000", "0.9260"
    assert f"{energy_ratio('Euler'):.4f}" == explicit
    assert f"{energy_ratio('RK4'):.4f}" == "1.0000"
    fast = explicit if VERSION < (3, 7) else midpoint if VERSION < (3, 11) else implicit
    assert f"{energy_ratio('implicitfast'):.4f}" == fast
    full = midpoint if (3, 7) <= VERSION < (3, 8, 1) else implicit
    assert f"{energy_ratio('implicit'):.4f}" == full
    if "discrete" in NAMES:
        assert f"{energy_ratio('discrete'):.4f}" == implicit


def test_box_momentum_in_the_world_shows_the_order_of_rk4() -> None:
    """The energy cannot see it: it is the same in both."""
    of, initial = box()
    coarse, fine = (
        momentum_error(of, loaded(of).run(initial, "RK4", h, round(5 / h), 1).state)[0]
        for h in (0.01, 0.005)
    )
    order = 4 if VERSION >= (4,) else 2
    assert abs(np.log2(coarse / fine) - order) < 0.1
    assert f"{coarse:.1e}" == ("1.2e-08" if VERSION >= (4,) else "8.3e-05")
