"""What JaxSim's integrators step, what is compiled for it, and what of it is unexpected."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
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
from test_conformance import FEW, TENSORS, angular_bound, linear_bound

from omegadot.adapters.jaxsim.adapter import JaxsimAdapter, JaxsimFloat32Adapter
from omegadot.adapters.jaxsim.coordinates import coordinates_of
from omegadot.adapters.jaxsim.integrators import NAMES, TURNING
from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.adapters.registry import is_absent
from omegadot.adapters.xla_loop import ROWS, STATES
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import (
    attitude_angle,
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System

if is_absent("jaxsim"):  # without importing it, which sets how JAX computes and NumPy prints
    pytest.skip("jaxsim is not installed", allow_module_level=True)

SINGLE = float(np.finfo(np.float32).eps)
STEP, STEPS = 0.02, 25
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
FREE = sorted(name for name, load in LOADS.items() if load.pivot is None)


@cache
def engine(single: bool = False) -> JaxsimAdapter:
    """One instance serves every test: what it has compiled serves all systems."""
    return (JaxsimFloat32Adapter if single else JaxsimAdapter)()


def loaded(of: System, single: bool = False) -> JaxsimAdapter:
    adapter = engine(single)
    adapter.load(of)
    return adapter


def a_start() -> State:
    return at(states(1, 11, 2.0, 2.0), 0)


def spinning(*omega: float) -> State:
    return State(NO_TURN, np.array(omega), np.zeros(3), np.zeros(3))


def row_of(of: System, state: State) -> Array:
    """(q, p, omega, u), (13,): omega in world axes, u of the point at the world's origin."""
    origin = at_point(state, -of.body.center_of_mass)
    w = rotate(state.orientation, state.angular_velocity)
    u = origin.linear_velocity - np.cross(w, origin.position)
    return np.concatenate((state.orientation, origin.position, w, u))


def state_of(of: System, row: Array) -> State:
    q, p, w, u = np.split(row, (4, 7, 10))
    moving = State(normalize(q), rotate_inverse(normalize(q), w), p, u + np.cross(w, p))
    return at_point(moving, of.body.center_of_mass)


def held_torque(of: System, state: State) -> Array:
    """Of the loads at a state, in world axes, as JaxSim holds it during a step."""
    load = of.load
    body = load.torque_body - load.damping * state.angular_velocity
    torque: Array = rotate(state.orientation, body) + load.torque_world
    return torque


def rate(of: System, torque: Array, row: Array) -> Array:
    """The rate of a row, under gravity and this torque in world axes."""
    w, p = row[7:10], row[4:7]
    now = state_of(of, row)
    found = forward_dynamics(
        System(of.bodies, Load(gravity=of.load.gravity, torque_world=torque)), now
    )
    w_dot = rotate(now.orientation, found.angular)
    arm = rotate(now.orientation, of.body.center_of_mass)
    origin = found.linear - np.cross(w_dot, arm) - np.cross(w, np.cross(w, arm))
    velocity = row[10:] + np.cross(w, p)
    u_dot = origin - np.cross(w_dot, p) - np.cross(w, velocity)
    turning = 0.5 * quaternion_product(np.append(0.0, w), normalize(row[:4]))
    return np.concatenate((turning, velocity, w_dot, u_dot))


def euler(f: Callable[[Array], Array], row: Array, h: float) -> Array:
    """Velocities first, then position and quaternion by them, from where they are."""
    pushed = row.copy()
    pushed[7:] += h * f(row)[7:]
    pushed[:7] += h * f(pushed)[:7]
    return pushed


def kutta(f: Callable[[Array], Array], row: Array, h: float) -> Array:
    k1 = f(row)
    k2 = f(row + h / 2 * k1)
    k3 = f(row + h / 2 * k2)
    k4 = f(row + h * k3)
    found: Array = row + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return found


METHODS = {"SemiImplicitEuler": euler, "RungeKutta4": kutta}


def by_formula(of: System, name: str, start: State) -> State:
    row = row_of(of, start)
    for _ in range(STEPS):
        torque = held_torque(of, state_of(of, row))
        row = METHODS[name](lambda y, held=torque: rate(of, held, y), row, STEP)
        row[:4] = normalize(row[:4])
    return state_of(of, row)


def apart(one: State, other: State) -> float:
    """The largest distance between two states, of parts of the size of one."""
    pairs = list(zip(parts(one)[1:], parts(other)[1:], strict=True))
    sizes = [float(norm(a - b) / max(1.0, float(norm(b)))) for a, b in pairs]
    return max(float(attitude_angle(one.orientation, other.orientation)), *sizes)


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("load", FREE)
@pytest.mark.parametrize("name", NAMES)
def test_steps_are_those_of_the_formulas(name: str, load: str, single: bool) -> None:
    """A step rounds by a few eps; what it has rounded is enlarged as a near start is."""
    of, start = system("full", load), a_start()
    adapter, eps = loaded(of, single), SINGLE if single else EPS
    found = adapter.run(start, name, STEP, STEPS, STEPS).state[-1]
    expected, distance = by_formula(of, name, start), 2.0**-26
    nudged = replace(start, angular_velocity=start.angular_velocity + distance)
    growth = max(1.0, apart(by_formula(of, name, nudged), expected) / distance)
    assert apart(found, expected) <= FEW * eps * STEPS * growth


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("load", ["none", "torque_world", "torque_body", "all"])
def test_orders_are_those_declared(name: str, load: str) -> None:
    """RungeKutta4 is of order 1 where a torque of the link goes with the body or its omega."""
    of, start = system("full", load), a_start()
    adapter = loaded(of)
    declared = {i.name: i.orders for i in adapter.description.integrators}[name]

    def end(steps: int) -> State:
        return adapter.run(start, name, 1.0 / steps, steps, steps).state[-1]

    # From errors at two steps to the next halving: no truth is needed.
    ends = [end(steps) for steps in (100, 200, 400)]
    spins = [e.angular_velocity for e in ends]
    order = np.log2(norm(spins[0] - spins[1]) / norm(spins[1] - spins[2]))
    assert abs(order - declared["omega"]) < 0.2
    assert set(TURNING) <= set(declared)


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("inertia", TENSORS)
@pytest.mark.parametrize("load", FREE)
def test_forward_dynamics_is_the_equation(inertia: str, load: str, single: bool) -> None:
    of, more = system(inertia, load), SINGLE / EPS if single else 1.0
    many = states(12, 2, fast=1.0)
    found, expected = loaded(of, single).forward_dynamics(many), forward_dynamics(of, many)
    # What is formed at the body's origin: m |c|^2 above the moments about the centre of mass.
    whole = 1.0 + of.body.mass * norm(OFFSET) ** 2 / np.linalg.eigvalsh(of.body.inertia)[0]
    assert np.all(norm(found.angular - expected.angular) <= more * whole * angular_bound(of, many))
    assert np.all(norm(found.linear - expected.linear) <= more * whole * linear_bound(of, many))


@pytest.mark.parametrize("load", ["none", "all"])
def test_omega_dot_of_an_ordinary_body_is_right_to_1e_13(load: str) -> None:
    of = system("full", load)
    many = states(50, 3, fast=1.0)
    found, expected = loaded(of).forward_dynamics(many), forward_dynamics(of, many)
    error = norm(found.angular - expected.angular) / norm(expected.angular)
    assert np.all(error <= 1e-13)


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("load", FREE)
def test_inverse_dynamics_is_the_equation(load: str, single: bool) -> None:
    of, eps = system("full", load), SINGLE if single else EPS
    many, rng = states(12, 4, fast=1.0), np.random.default_rng(5)
    wanted = Acceleration(10 * rng.normal(size=(12, 3)), 10 * rng.normal(size=(12, 3)))
    found = loaded(of, single).inverse_dynamics(many, wanted)
    expected = inverse_dynamics(of, many, wanted)
    terms = norm(many.angular_velocity) ** 2 + norm(wanted.angular) + norm(wanted.linear)
    # the largest moment about the origin, and the applied torques
    sizes = 8.0 * (terms + 10.0) + norm(BODY_TORQUE) + norm(WORLD_TORQUE)
    assert np.all(norm(found - expected) <= FEW * eps * sizes)


@pytest.mark.parametrize(
    "gravity", [[0, 0, -9.81], [0, 0, 3.0], [9.81, 0, 0], [1, 2, -9.81], [1, -2, 0.5], [0, 0, 0]]
)
def test_gravity_may_point_anywhere(gravity: list[float]) -> None:
    """JaxSim has it along z, so that its world is turned; not where it is along z already."""
    load = Load(gravity=np.array(gravity, float))
    of = System(system().bodies, load)
    many = states(5, 6, fast=1.0)
    assert np.all(
        norm(loaded(of).forward_dynamics(many).linear - load.gravity) <= linear_bound(of, many)
    )
    coordinates = coordinates_of(OFFSET, load.gravity)
    there = rotate(coordinates.turn, load.gravity)
    assert norm(there - [0.0, 0.0, coordinates.gravity]) <= 8 * EPS * norm(load.gravity)
    assert np.array_equal(coordinates.turn, NO_TURN) == (not np.any(load.gravity[:2]))


def velocity_lost(name: str, steps: int) -> float:
    """In m/s of 1 m/s, in a second of free flight about the centre of mass."""
    adapter = loaded(system("full", center=np.zeros(3)))
    start = replace(spinning(1.0, 2.0, 3.0), linear_velocity=np.array([1.0, 0.0, 0.0]))
    end = adapter.run(start, name, 1.0 / steps, steps, steps).state[-1]
    return float(norm(end.linear_velocity - start.linear_velocity))


@pytest.mark.parametrize(("name", "order"), [("SemiImplicitEuler", 1), ("RungeKutta4", 4)])
def test_a_body_that_turns_does_not_keep_its_velocity(name: str, order: int) -> None:
    """Without any load: what is stepped is the velocity of another point, which turns with it."""
    coarse, fine = velocity_lost(name, 50), velocity_lost(name, 100)
    assert abs(np.log2(coarse / fine) - order) < 0.3
    assert coarse > 1e-8


def test_as_shipped_it_rounds_by_the_distance_from_the_worlds_origin() -> None:
    """It keeps the velocity of the point there, which is as fast as omega and the distance."""
    of, far = system("full"), replace(a_start(), position=np.full(3, 2.0**20))
    errors = []
    for adapter in (engine(), JaxsimAdapter("as-shipped")):
        adapter.load(of)
        adapter.set_state(far)
        errors.append(norm(adapter.get_state().linear_velocity - far.linear_velocity))
    size = norm(far.linear_velocity) + norm(far.angular_velocity) * norm(OFFSET)
    assert errors[0] <= FEW * EPS * size < errors[1]


@pytest.mark.parametrize("single", [False, True])
def test_one_program_serves_every_body_and_load(single: bool) -> None:
    adapter = (JaxsimFloat32Adapter if single else JaxsimAdapter)()
    for inertia in ("diagonal", "sphere"):
        for load in ("none", "all"):
            adapter.load(system(inertia, load))
            for steps, every in ((1, 1), (7, 3), (2 * ROWS, 1)):
                adapter.run(spinning(1.0, 2.0, 3.0), NAMES[0], 0.01 / steps, steps, every)
            adapter.forward_dynamics(states(3))
            adapter.forward_dynamics(states(STATES + 1))
    assert sorted(adapter._programs.compiled) == ["SemiImplicitEuler", "begin", "forward"]


def test_long_runs_and_large_batches_are_those_of_their_parts() -> None:
    of = system("full", "all")
    adapter, start, steps = loaded(of), a_start(), 2 * ROWS + 5
    whole = adapter.run(start, NAMES[0], 1e-3, steps, 1).state
    sampled = adapter.run(start, NAMES[0], 1e-3, steps, 3)
    assert np.array_equal(sampled.time, [*np.arange(0, steps, 3) * 1e-3, steps * 1e-3])
    kept = [*range(0, steps, 3), steps]
    assert all(map(np.array_equal, parts(sampled.state), (p[kept] for p in parts(whole))))
    many = states(STATES + 44, 5, fast=1.0)
    found = adapter.forward_dynamics(many)
    for row in (0, STATES - 1, STATES, STATES + 43):
        one = State(*(value[row : row + 1] for value in parts(many)))
        alone = adapter.forward_dynamics(one).angular
        assert norm(alone - found.angular[row])[0] <= angular_bound(of, one)[0]


def test_no_call_leaves_anything_for_the_next_in_either_precision() -> None:
    of = system("full", "all")
    both = [loaded(of, single) for single in (False, True)]
    once = [adapter.run(a_start(), NAMES[1], STEP, 5, 1).state for adapter in both]
    for adapter in both:
        adapter.load(system("thin"))
        adapter.forward_dynamics(states(3))
        adapter.run(spinning(1.0, 2.0, 3.0), NAMES[0], 0.003, 3, 1)
        adapter.load(of)
    again = [adapter.run(a_start(), NAMES[1], STEP, 5, 1).state for adapter in both]
    for first, second in zip(once, again, strict=True):
        assert all(map(np.array_equal, parts(first), parts(second)))
    assert 0.0 < apart(once[0][-1], once[1][-1]) < 1e-4


@pytest.mark.parametrize("name", NAMES)
def test_nan_comes_back_as_nan_and_no_steps_are_the_start(name: str) -> None:
    adapter, start = loaded(system("full")), a_start()
    broken = replace(start, angular_velocity=np.array([1.0, np.nan, 0.0]))
    found = adapter.run(broken, name, 0.01, 4, 2).state.angular_velocity
    assert np.all(np.isnan(found[1:]).any(axis=-1))
    none = adapter.run(start, name, 0.01, 0, 1)
    assert np.array_equal(none.time, [0.0])
    assert apart(none.state[0], start) <= FEW * EPS


@pytest.mark.parametrize("load", ["none", "gravity"])
def test_states_come_back_as_they_went_in(load: str) -> None:
    adapter, many = loaded(system(load=load)), states(20, seed=1)
    for row in range(20):
        given = at(many, row)
        adapter.set_state(given)
        found = adapter.get_state()
        spin, reach = norm(given.angular_velocity), norm(given.position) + norm(OFFSET)
        assert attitude_angle(found.orientation, given.orientation) <= FEW * EPS
        assert norm(found.angular_velocity - given.angular_velocity) <= FEW * EPS * spin
        assert norm(found.position - given.position) <= FEW * EPS * reach
        moved = norm(found.linear_velocity - given.linear_velocity)
        assert moved <= FEW * EPS * (norm(given.linear_velocity) + spin * reach)


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("inertia", sorted(INERTIAS))
def test_the_model_reads_back(inertia: str, single: bool) -> None:
    of, eps = system(inertia), SINGLE if single else EPS
    (found,) = loaded(of, single).model()
    assert abs(found.mass - of.body.mass) <= eps * of.body.mass
    assert norm(found.center_of_mass - OFFSET) <= eps * norm(OFFSET)
    assert np.all(np.abs(found.inertia - of.body.inertia) <= eps * np.abs(of.body.inertia))


def test_what_jaxsim_has_not_is_refused() -> None:
    adapter, body = loaded(system()), system().body
    for name in ("RungeKutta4Fast", "no-such"):
        with pytest.raises(UnsupportedError, match=f"jaxsim has no integrator '{name}'"):
            adapter.run(a_start(), name, STEP, 1, 1)
    with pytest.raises(UnsupportedError, match="ball joint"):
        adapter.load(system(load="pivot"))
    with pytest.raises(UnsupportedError, match="one body"):
        adapter.load(System((body, body), Load()))
    with pytest.raises(RuntimeError, match="no system"):
        adapter.forward_dynamics(states(1))


def test_the_integrator_that_is_left_out_fails_without_points_of_contact() -> None:
    own = loaded(system())._own()
    data, _ = own.begin(np.concatenate((np.zeros(3), NO_TURN, np.zeros(6))))
    programs, jaxsim = own._programs, engine()._engine
    model = programs._described
    with jaxsim.active(), model.editable(validate=False) as changed:
        changed.integrator = jaxsim.api.model.IntegratorType.RungeKutta4Fast
    with jaxsim.active(), pytest.raises(UnboundLocalError, match="W_f_L_terrain"):
        jaxsim.api.model.step(changed, data)


def test_it_describes_itself() -> None:
    double, single = (engine(s).description for s in (False, True))
    assert isinstance(engine(), Adapter)
    assert (double.name, double.precision) == ("jaxsim", "float64")
    assert (single.name, single.precision) == ("jaxsim-float32", "float32")
    assert "pivot" not in double.features
    assert double.switched_off
    assert not JaxsimAdapter("as-shipped").description.switched_off
    native = engine().native()
    assert native["conventions"]["Mixed: angular velocity frame"] == "world axes"
    assert native["conventions"]["Mixed: linear velocity point"] == "body origin"
    assert "world's origin" in native["conventions"]["Inertial: linear velocity point"]
    assert native["defaults"]["integrator"] == "SemiImplicitEuler"


def test_it_is_silent_and_leaves_settings_alone() -> None:
    """In a process of its own: the import of JaxSim sets how JAX computes and NumPy prints."""
    code = (
        "import jax, numpy as np, warnings; "
        "now = lambda: (jax.config.jax_enable_x64, np.get_printoptions(), warnings.showwarning, "
        "list(warnings.filters)); before = now(); "
        "from omegadot.adapters.jaxsim.adapter import JaxsimAdapter; "
        "from omegadot.reference_impl.system import Body, Load, System; "
        "JaxsimAdapter().load(System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())); "
        "assert now() == before"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
