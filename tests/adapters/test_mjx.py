"""What MJX steps in both precisions, what is compiled for it, and what of it is unexpected."""

from __future__ import annotations

import subprocess
import sys
from functools import cache

import numpy as np
import pytest
from mujoco_cases import (
    BODY_TORQUE,
    EPS,
    INERTIAS,
    LOADS,
    OFFSET,
    WORLD_TORQUE,
    at,
    norm,
    parts,
    states,
    system,
)
from test_conformance import TENSORS, angular_bound, cases, linear_bound

from omegadot.adapters.mjx.adapter import MjxAdapter, MjxFloat32Adapter
from omegadot.adapters.mjx.integrators import KINDS
from omegadot.adapters.protocol import Adapter, Setup, UnsupportedError
from omegadot.adapters.xla_loop import ROWS, STATES
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import attitude_angle, normalize
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System

pytest.importorskip("jax")
pytest.importorskip("mujoco.mjx")

SINGLE = float(np.finfo(np.float32).eps)
STEP, STEPS = 0.05, 40
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
SETUPS: tuple[Setup, ...] = ("physics", "as-shipped")


@cache
def engine(single: bool = False, setup: Setup = "physics") -> MjxAdapter:
    """One instance serves every test: what it has compiled serves all systems."""
    return (MjxFloat32Adapter if single else MjxAdapter)(setup)


def loaded(of: System, single: bool = False, setup: Setup = "physics") -> MjxAdapter:
    adapter = engine(single, setup)
    adapter.load(of)
    return adapter


def a_start(of: System) -> State:
    return place_on_pivot(of, at(states(1, 11, 2.0, 2.0), 0))


def spinning(*omega: float) -> State:
    return State(NO_TURN, np.array(omega), np.zeros(3), np.zeros(3))


def expected_run(of: System, scheme: str, start: State) -> tuple[State, float]:
    """The reference's run at the body's origin, and how much it enlarges an early error."""
    distance = 2.0**-26
    lanes = State(*(np.stack([value, value]) for value in parts(start)))
    lanes.angular_velocity[1] += distance / np.sqrt(3)
    how = (STEP, STEPS, 1, "origin-world")
    found = step_body(SCHEMES[scheme], of, place_on_pivot(of, lanes), *how)[1]
    apart = max(float(np.abs(value[:, 1] - value[:, 0]).max()) for value in parts(found))
    q, *rest = (value[:, 0] for value in parts(found))
    return State(normalize(q), *rest), max(1.0, apart / distance)


def assert_steps_are_those_declared(
    of: System, name: str, eps: float, single: bool = False, setup: Setup = "physics"
) -> None:
    """Each step rounds by a few eps, and later steps enlarge what earlier ones rounded."""
    adapter, start = loaded(of, single, setup), a_start(of)
    (own,) = (i for i in adapter.description.integrators if i.name == name)
    assert own.scheme is not None
    expected, growth = expected_run(of, own.scheme, start)
    found = adapter.run(start, name, STEP, STEPS, 1).state
    for here, there in zip(parts(found), parts(expected), strict=True):
        size = max(1.0, float(np.abs(there).max()))
        assert np.abs(here - there).max() <= 16 * eps * STEPS * size * growth


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("name", sorted(KINDS))
def test_steps_equal_the_declared_scheme(name: str, load: str) -> None:
    assert_steps_are_those_declared(system("full", load), name, EPS)


@pytest.mark.parametrize("load", ["damping", "pivot_damping", "all"])
def test_euler_takes_damping_implicitly_as_shipped(load: str) -> None:
    of = system("full", load)
    assert_steps_are_those_declared(of, "Euler", EPS, setup="as-shipped")
    runs = [loaded(of, False, s).run(a_start(of), "Euler", STEP, STEPS, 1) for s in SETUPS]
    assert np.abs(runs[0].state.angular_velocity - runs[1].state.angular_velocity).max() > 1e-6


@pytest.mark.parametrize("load", ["all", "pivot_all"])
@pytest.mark.parametrize("name", sorted(KINDS))
def test_steps_in_single_precision_equal_the_declared_scheme(name: str, load: str) -> None:
    assert_steps_are_those_declared(system("full", load), name, SINGLE, single=True)


def test_rk4_is_of_order_4_in_omega_and_of_order_2_in_attitude() -> None:
    """As MuJoCo's was before 4: it turns the body by the mean of the stages' omegas."""
    adapter, start = loaded(system(center=np.zeros(3))), spinning(1.0, 2.0, 3.0)

    def end(steps: int) -> State:
        return adapter.run(start, "RK4", 1.0 / steps, steps, steps).state[-1]

    truth, (coarse, fine) = end(6400), (end(50), end(100))
    spins = [float(norm(e.angular_velocity - truth.angular_velocity)) for e in (coarse, fine)]
    turns = [float(attitude_angle(e.orientation, truth.orientation)) for e in (coarse, fine)]
    assert 3.8 < np.log2(spins[0] / spins[1]) < 4.2
    assert 1.8 < np.log2(turns[0] / turns[1]) < 2.2


@pytest.mark.parametrize("load", sorted(LOADS))
@pytest.mark.parametrize("inertia", TENSORS)
def test_single_precision_has_the_equation(inertia: str, load: str) -> None:
    """Within the bound of double precision, times the ratio of the roundings."""
    of = system(inertia, load)
    many = cases(12, of, 2, fast=1.0)
    found, expected = loaded(of, True).forward_dynamics(many), forward_dynamics(of, many)
    more = SINGLE / EPS
    assert np.all(norm(found.angular - expected.angular) <= more * angular_bound(of, many))
    assert np.all(norm(found.linear - expected.linear) <= more * linear_bound(of, many))


@pytest.mark.parametrize("load", ["all", "pivot_all"])
def test_single_precision_has_inverse_dynamics(load: str) -> None:
    of = system("full", load)
    many = cases(12, of, 4, fast=0.0)
    wanted = forward_dynamics(of, many)
    found = loaded(of, True).inverse_dynamics(many, wanted)
    expected = inverse_dynamics(of, many, wanted)
    terms = norm(many.angular_velocity) ** 2 + norm(wanted.angular) + norm(wanted.linear)
    # the largest moment about the origin or the pivot, and the applied torques
    sizes = 8.0 * (terms + 10.0) + norm(BODY_TORQUE) + norm(WORLD_TORQUE)
    assert np.all(norm(found - expected) <= 64 * SINGLE * sizes)
    assert np.any(norm(found - expected) > 64 * EPS * sizes)


def test_the_two_precisions_leave_each_other_alone() -> None:
    of = system("full", "all")
    both = [loaded(of, single) for single in (False, True)]
    once = [adapter.run(a_start(of), "RK4", STEP, 5, 1).state for adapter in both]
    again = [adapter.run(a_start(of), "RK4", STEP, 5, 1).state for adapter in both]
    for first, second in zip(once, again, strict=True):
        assert all(map(np.array_equal, parts(first), parts(second)))
    omegas = [state.angular_velocity for state in once]
    assert [np.array_equal(w, w.astype(np.float32)) for w in omegas] == [False, True]


@pytest.mark.parametrize("pivot", [None, OFFSET])
def test_one_program_serves_every_body(pivot: Array | None) -> None:
    """MuJoCo's compiler marks a body at its origin, in principal axes: XLA must not see it."""
    adapter = MjxAdapter()
    for inertia in ("diagonal", "full", "sphere"):
        for center in (np.zeros(3), OFFSET):
            body = system(inertia, center=center).body
            adapter.load(System((body,), Load(pivot=pivot)))
            for steps, every in ((1, 1), (7, 3), (2 * ROWS, 1)):
                adapter.run(spinning(1.0, 2.0, 3.0), "Euler", 0.01 / steps, steps, every)
            adapter.forward_dynamics(states(3))
            adapter.forward_dynamics(states(STATES + 1))
    kinds = sorted(kind for kind, _ in adapter._programs.compiled)
    assert kinds == ["EULER", "forward"]


def test_long_runs_and_large_batches_are_those_of_their_parts() -> None:
    of = system("full", "all")
    adapter, start, steps = loaded(of), a_start(of), 2 * ROWS + 5
    whole = adapter.run(start, "Euler", 1e-3, steps, 1).state
    sampled = adapter.run(start, "Euler", 1e-3, steps, 3)
    assert np.array_equal(sampled.time, [*np.arange(0, steps, 3) * 1e-3, steps * 1e-3])
    kept = [*range(0, steps, 3), steps]
    assert all(map(np.array_equal, parts(sampled.state), (p[kept] for p in parts(whole))))
    many = cases(STATES + 44, of, 5, fast=2.0)
    found = adapter.forward_dynamics(many)
    for row in (0, STATES - 1, STATES, STATES + 43):
        one = State(*(value[row : row + 1] for value in parts(many)))
        alone = adapter.forward_dynamics(one).angular
        assert norm(alone - found.angular[row])[0] <= angular_bound(of, one)[0]


def test_a_slow_omega_does_not_turn_the_body() -> None:
    """`mjx._src.math.norm` takes a vector for zero of which no component exceeds 1e-8."""
    adapter = loaded(system("sphere", center=np.zeros(3)))
    ends = [
        adapter.run(spinning(0.0, 0.0, w), "Euler", 1.0, 100, 100).state[-1]
        for w in (0.99e-8, 1.01e-8)
    ]
    turns = [float(attitude_angle(end.orientation, NO_TURN)) for end in ends]
    assert turns[0] == 0.0
    assert abs(turns[1] - 1.01e-6) <= 100 * 16 * EPS


def test_what_mjx_has_not_is_refused() -> None:
    adapter, body = loaded(system()), system().body
    for name in ("implicit", "discrete", "no-such"):
        with pytest.raises(UnsupportedError, match=f"mjx has no integrator '{name}'"):
            adapter.run(a_start(system()), name, STEP, 1, 1)
    with pytest.raises(UnsupportedError, match="one body"):
        adapter.load(System((body, body), Load()))
    with pytest.raises(RuntimeError, match="no system"):
        adapter.forward_dynamics(states(1))
    with pytest.raises(RuntimeError, match="no system"):
        adapter.inverse_dynamics(states(1), Acceleration(np.ones((1, 3)), np.ones((1, 3))))


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("inertia", sorted(INERTIAS))
def test_the_model_reads_back(inertia: str, single: bool) -> None:
    of, eps = system(inertia, "pivot"), SINGLE if single else EPS
    (found,) = loaded(of, single).model()
    assert abs(found.mass - of.body.mass) <= eps * of.body.mass
    assert norm(found.center_of_mass - OFFSET) <= eps * norm(OFFSET)
    size = float(np.max(np.abs(of.body.inertia)))
    assert np.max(np.abs(found.inertia - of.body.inertia)) <= 64 * eps * size


def test_it_describes_itself() -> None:
    double, single = (adapter.description for adapter in (MjxAdapter(), MjxFloat32Adapter()))
    assert isinstance(engine(), Adapter)
    assert (double.name, double.precision) == ("mjx", "float64")
    assert (single.name, single.precision) == ("mjx-float32", "float32")
    assert any("damping" in clause for clause in double.switched_off)
    assert not any("AUTORESET" in clause or "reset" in clause for clause in double.switched_off)
    assert not MjxAdapter("as-shipped").description.switched_off
    native = engine().native()
    assert native["conventions"]["free joint angular velocity frame"] == "body axes"
    assert native["conventions"]["free joint linear velocity point"] == "body origin"
    assert native["defaults"]["timestep"] == "0.002"
    assert native["defaults"]["jax_enable_x64"] == "False"


def test_it_is_silent() -> None:
    """In a process of its own: MJX prints as it is imported."""
    code = (
        "from omegadot.adapters.mjx.adapter import MjxAdapter; from omegadot.reference_impl.system"
        " import Body, Load, System; import numpy as np; MjxAdapter().load(System((Body("
        "np.array(1.0), np.zeros(3), np.eye(3)),), Load()))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert (done.stdout, done.stderr) == (b"", b"")
