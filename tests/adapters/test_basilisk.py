"""What Basilisk's integrators step, and what of Basilisk is not as a reader may expect."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, GRAVITY, INERTIAS, OFFSET, at, norm, states
from test_conformance import FEW, TENSORS, angular_bound, linear_bound

from omegadot.adapters.basilisk.adapter import BasiliskAdapter
from omegadot.adapters.basilisk.attitude import of_quaternion, quaternion_of
from omegadot.adapters.basilisk.hub import place
from omegadot.adapters.basilisk.hub import states as states_of
from omegadot.adapters.basilisk.integrators import PLANS
from omegadot.adapters.basilisk.model import BasiliskModel
from omegadot.adapters.basilisk.stepping import nanoseconds, run_directly, run_simulation
from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, exp_quaternion
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

pytest.importorskip("Basilisk")

STEP, STEPS = 0.01, 20
# A step of a dozen operations, of rates that a step may double: the runs last 0.2 s.
SAME = 64 * EPS * STEPS
FIXED = sorted(name for name, plan in PLANS.items() if plan.fixed)
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
LOADS = {
    "none": Load(),
    "gravity": Load(gravity=GRAVITY),
    "torque_body": Load(torque_body=np.array([1.0, 2.0, 3.0])),
    "both": Load(gravity=GRAVITY, torque_body=np.array([1.0, 2.0, 3.0])),
}
REFUSED = {
    "pivot": Load(pivot=OFFSET),
    "damping": Load(damping=np.array(0.5)),
    "world": Load(torque_world=np.array([1.0, 0.0, 0.0])),
}


def system(inertia: str = "full", load: str = "none", center: Array = OFFSET) -> System:
    return System((Body(np.array(2.0), center, INERTIAS[inertia]),), LOADS[load])


def basilisk(of: System, setup: Any = "physics") -> BasiliskAdapter:
    adapter = BasiliskAdapter(setup)
    adapter.load(of)
    return adapter


def accuracy_of(name: str) -> float | None:
    return None if PLANS[name].fixed else 1e-9


def a_start() -> State:
    return at(states(1, seed=0, far=1.0, fast=2.0), 0)


def spinning(*omega: float) -> State:
    return State(NO_TURN, np.array(omega), np.zeros(3), np.zeros(3))


def apart(one: State, other: State) -> float:
    """The largest distance between two states, of parts of the size of one."""
    pairs = [(one.position, other.position), (one.linear_velocity, other.linear_velocity)]
    pairs.append((one.angular_velocity, other.angular_velocity))
    sizes = [float(norm(a - b) / max(1.0, float(norm(b)))) for a, b in pairs]
    return max(float(attitude_angle(one.orientation, other.orientation)), *sizes)


def rate(of: System, y: Array) -> Array:
    """``y'`` of y = (sigma, omega, r, v), r and v of the body's origin."""
    sigma, w = y[:3], y[3:6]
    turning = (1 - sigma @ sigma) * w + 2 * np.cross(sigma, w) + 2 * sigma * (sigma @ w)
    center = of.body.center_of_mass
    state = at_point(State(quaternion_of(sigma), w, y[6:9], y[9:]), center)
    found = forward_dynamics(of, state)
    lifted = np.cross(found.angular, center) + np.cross(w, np.cross(w, center))
    at_origin = found.linear - turned(state.orientation, lifted)
    return np.concatenate((turning / 4, found.angular, y[9:], at_origin))


def turned(q: Array, v: Array) -> Array:
    w, axis = q[0], q[1:]
    found: Array = v + 2 * w * np.cross(axis, v) + 2 * np.cross(axis, np.cross(axis, v))
    return found


def butcher(rows: list[list[float]], weights: list[float]) -> Callable[[Any, Array, float], Array]:
    """A step of an explicit method by its tableau."""

    def step(of: System, y: Array, h: float) -> Array:
        slopes: list[Array] = []
        for row in [[], *rows]:
            there = y + h * sum((a * k for a, k in zip(row, slopes, strict=True)), np.zeros(12))
            slopes.append(rate(of, there))
        found: Array = y + h * sum((b * k for b, k in zip(weights, slopes, strict=True)))
        return found

    return step


FEHLBERG = [
    [1 / 4],
    [3 / 32, 9 / 32],
    [1932 / 2197, -7200 / 2197, 7296 / 2197],
    [439 / 216, -8, 3680 / 513, -845 / 4104],
    [-8 / 27, 2, -3544 / 2565, 1859 / 4104, -11 / 40],
]
METHODS = {
    "Euler": butcher([], [1.0]),
    "RK2": butcher([[1.0]], [0.5, 0.5]),
    "RK4": butcher([[0.5], [0.0, 0.5], [0.0, 0.0, 1.0]], [1 / 6, 1 / 3, 1 / 3, 1 / 6]),
    # The solution of order 4.
    "RKF45": butcher(FEHLBERG, [25 / 216, 0, 1408 / 2565, 2197 / 4104, -1 / 5, 0]),
}


def endless(of: System, name: str, start: State, h: float, steps: int) -> State:
    """The end of a run of an error-controlled integrator that tolerates every error."""
    model = BasiliskModel(BasiliskAdapter()._engine, of, PLANS[name].kind, 1e300, 1e300)
    place(model, start)
    return states_of(model, run_directly(model, h, [0, steps])[0])[-1]


@pytest.mark.parametrize("name", sorted(METHODS))
@pytest.mark.parametrize("load", ["none", "both"])
def test_steps_are_those_of_the_method_on_the_shorter_sigma(name: str, load: str) -> None:
    of, start = system("full", load), a_start()
    # Nearly half a turn, so that sigma is exchanged for its shadow on the way.
    along = start.angular_velocity / norm(start.angular_velocity)
    start = replace(start, orientation=exp_quaternion((np.pi - 0.1) * along))
    origin = at_point(start, -of.body.center_of_mass)
    y = np.concatenate(
        (
            of_quaternion(start.orientation),
            start.angular_velocity,
            origin.position,
            origin.linear_velocity,
        )
    )
    switched = False
    for _ in range(STEPS):
        y = METHODS[name](of, y, STEP)
        if norm(y[:3]) > 1:
            y[:3] /= -(y[:3] @ y[:3])
            switched = True
    assert switched
    expected = at_point(State(quaternion_of(y[:3]), y[3:6], y[6:9], y[9:]), of.body.center_of_mass)
    if PLANS[name].fixed:
        found = basilisk(of).run(start, name, STEP, STEPS, STEPS).state[-1]
    else:
        found = endless(of, name, start, STEP, STEPS)
    assert apart(found, expected) <= SAME


def test_rkf78_goes_on_with_the_solution_of_order_7() -> None:
    """Errors at steps of 0.1 and 0.05 s, far from rounding: their ratio is 2^7 or 2^8."""
    of, start = system("full"), spinning(1.0, 2.0, 3.0)
    truth = endless(of, "RKF78", start, 0.0125, 64).angular_velocity
    errors = [
        float(norm(endless(of, "RKF78", start, 0.8 / steps, steps).angular_velocity - truth))
        for steps in (8, 16)
    ]
    assert 6.5 < np.log2(errors[0] / errors[1]) < 7.5


@pytest.mark.parametrize("name", sorted(PLANS))
@pytest.mark.parametrize("load", ["none", "both"])
def test_a_simulation_takes_the_steps_of_direct_calls(name: str, load: str) -> None:
    of, kept = system("full", load), [0, 3, 6, 7]
    accuracy, engine = accuracy_of(name), basilisk(of)._engine
    models = [BasiliskModel(engine, of, PLANS[name].kind, accuracy, accuracy) for _ in range(2)]
    for model in models:
        place(model, a_start())
    rows, _ = run_simulation(engine, models[0], nanoseconds(STEP), kept)
    directly, _ = run_directly(models[1], STEP, kept)
    assert np.array_equal(rows, directly)


@pytest.mark.parametrize(
    ("step", "count"), [(0.01, 10_000_000), (1e-9, 1), (0.003, 3_000_000), (1 / 3, 0), (1e-10, 0)]
)
def test_whole_nanoseconds_are_known(step: float, count: int) -> None:
    assert nanoseconds(step) == count


def test_steps_between_nanoseconds_are_taken_as_they_are() -> None:
    of, h = system("full"), 0.01 / 3
    found = basilisk(of).run(a_start(), "RK4", h, 7, 3)
    assert np.array_equal(found.time, np.array([0, 3, 6, 7]) * h)
    longer = basilisk(of).run(a_start(), "RK4", 0.0033, 7, 7).state[-1]
    assert apart(found.state[-1], longer) > SAME


@pytest.mark.parametrize("inertia", TENSORS)
@pytest.mark.parametrize("load", sorted(LOADS))
@pytest.mark.parametrize("center", [np.zeros(3), OFFSET])
@pytest.mark.parametrize("fast", [0.0, 50.0])
def test_equations_of_motion_are_right(inertia: str, load: str, center: Array, fast: float) -> None:
    of, many = system(inertia, load, center), states(12, seed=2, fast=fast)
    found, expected = basilisk(of).forward_dynamics(many), forward_dynamics(of, many)
    assert np.all(norm(found.angular - expected.angular) <= angular_bound(of, many))
    assert np.all(norm(found.linear - expected.linear) <= linear_bound(of, many))


@pytest.mark.parametrize("inertia", sorted(INERTIAS))
def test_the_model_reads_back(inertia: str) -> None:
    of = system(inertia)
    (found,) = basilisk(of).model()
    assert found.mass == of.body.mass
    assert norm(found.center_of_mass - OFFSET) <= 4 * EPS * norm(OFFSET)
    size = np.max(np.abs(of.body.inertia)) + 2.0 * norm(OFFSET) ** 2
    assert np.max(np.abs(found.inertia - of.body.inertia)) <= FEW * EPS * size


def test_states_come_back_as_they_went_in() -> None:
    adapter, many = basilisk(system("full")), states(20, seed=1, fast=50.0)
    for row in range(20):
        given = at(many, row)
        adapter.set_state(given)
        found = adapter.get_state()
        assert attitude_angle(found.orientation, given.orientation) <= FEW * EPS
        assert np.array_equal(found.angular_velocity, given.angular_velocity)
        assert norm(found.position - given.position) <= FEW * EPS * norm(given.position)
        lift = norm(given.angular_velocity) * norm(OFFSET) + norm(given.linear_velocity)
        assert norm(found.linear_velocity - given.linear_velocity) <= FEW * EPS * lift


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-5, np.pi - 1e-6, np.pi, np.pi + 1e-6, 6.28])
def test_sigma_is_that_of_an_attitude_and_the_shorter_one(angle: float) -> None:
    axis = np.array([2.0, -1.0, 2.0]) / 3
    q = np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis)])
    sigma, turn = of_quaternion(q), angle if angle <= np.pi else angle - 2 * np.pi
    assert norm(sigma - np.tan(turn / 4) * axis) <= FEW * EPS
    assert attitude_angle(quaternion_of(sigma), q) <= FEW * EPS


def test_no_call_leaves_anything_for_the_next() -> None:
    of = system("full", "both")
    adapter, start = basilisk(of), a_start()
    before = adapter.run(start, "RK4", STEP, 5, 2)
    adapter.set_state(spinning(1.0, 2.0, 3.0))
    for name in PLANS:
        adapter.run(spinning(1.0, 2.0, 3.0), name, 0.003, 3, 1, accuracy_of(name))
    adapter.load(system("thin"))
    adapter.load(of)
    adapter.forward_dynamics(states(3, seed=3))
    after = adapter.run(start, "RK4", STEP, 5, 2)
    for first, second in zip(vars(before.state).values(), vars(after.state).values(), strict=True):
        assert np.array_equal(first, second)


@pytest.mark.parametrize("name", sorted(PLANS))
def test_a_run_goes_on_from_its_own_sample(name: str) -> None:
    """An error-controlled run too: it begins each sample with a trial of the whole of it."""
    adapter, start = basilisk(system("full", "both")), a_start()
    whole = adapter.run(start, name, STEP, 10, 5, accuracy_of(name)).state
    rest = adapter.run(whole[1], name, STEP, 5, 5, accuracy_of(name)).state[-1]
    assert apart(rest, whole[-1]) <= SAME


@pytest.mark.parametrize("lacking", sorted(REFUSED))
def test_what_a_spacecraft_has_not_is_refused(lacking: str) -> None:
    of = System((system().body,), REFUSED[lacking])
    with pytest.raises(UnsupportedError, match="Basilisk"):
        basilisk(of)


def test_other_things_are_refused() -> None:
    adapter, body = basilisk(system()), system().body
    with pytest.raises(UnsupportedError, match="no-such"):
        adapter.run(a_start(), "no-such", STEP, 1, 1)
    with pytest.raises(UnsupportedError, match="one body"):
        adapter.load(System((body, body), Load()))
    one = states(1)
    with pytest.raises(UnsupportedError, match="inverse dynamics"):
        adapter.inverse_dynamics(one, Acceleration(np.ones((1, 3)), np.ones((1, 3))))


def test_a_tensor_that_rounding_has_made_unsymmetric_is_taken() -> None:
    """Basilisk refuses what differs by 1e-9 kg m^2: at 1e8 less than the rounding of a product."""
    inertia = np.diag([1e8, 2e8, 2.8e8])
    inertia[0, 1] = np.spacing(1e8)
    of = System((Body(np.array(1e6), np.zeros(3), inertia),), Load())
    basilisk(of)
    model = BasiliskModel(BasiliskAdapter()._engine, of)
    model.craft.hub.IHubPntBc_B = inertia.tolist()
    with pytest.raises(UnsupportedError, match="inertia"):
        model.reset()


def omega_dots(h: float) -> tuple[Array, Array]:
    """omega-dot as published after a step of h, and by the equations at its end."""
    of = system("full")
    engine = basilisk(of)._engine
    model = BasiliskModel(engine, of)
    place(model, spinning(1.0, 2.0, 3.0))
    run_simulation(engine, model, nanoseconds(h), [0, 1])
    published = np.array(model.craft.scStateOutMsg.read().omegaDot_BN_B)
    end = basilisk(of).run(spinning(1.0, 2.0, 3.0), "RK4", h, 1, 1).state
    return published, forward_dynamics(of, end[-1]).angular


def test_the_published_omega_dot_is_a_difference_quotient() -> None:
    """So that it is omega-dot of half a step before, and off by ``h omega'' / 2``."""
    far, near = (float(norm(a - b)) for a, b in (omega_dots(0.01), omega_dots(0.001)))
    assert far > 1e-2
    assert 9 < far / near < 11


def test_a_force_by_ext_force_torque_acts_at_the_origin() -> None:
    """So that it is no gravity: it turns a body whose centre of mass is elsewhere."""
    of = system("full")
    engine = basilisk(of)._engine
    model, acting = BasiliskModel(engine, of), engine.ExtForceTorque()
    acting.extForce_N = (2.0 * GRAVITY).tolist()
    model.craft.addDynamicEffector(acting)
    place(model, spinning(0.0, 0.0, 0.0))
    model.reset()
    model.craft.equationsOfMotion(0.0, 1.0)
    found = np.array(model.craft.dynManager.getStateObject("hubOmega").getStateDeriv())[:, 0]
    torque = np.cross(-OFFSET, 2.0 * GRAVITY)
    assert norm(found - np.linalg.solve(of.body.inertia, torque)) <= FEW * EPS * norm(torque)
    assert norm(found) > 1.0


def test_a_trial_that_overflows_is_accepted_by_rkf78() -> None:
    """An error that is no number is not above its tolerance. Shorter samples are sound."""
    adapter, start = basilisk(system("full", center=np.zeros(3))), spinning(0.1, 10.0, 5.0)
    assert np.all(np.isnan(adapter.run(start, "RKF78", 10.0, 1, 1, 1e-9).state[-1].orientation))
    sound = adapter.run(start, "RKF78", 0.1, 100, 100, 1e-9).state[-1]
    assert np.all(np.isfinite(sound.orientation))


def test_the_absolute_tolerance_is_basilisks_own_as_shipped() -> None:
    """At 0.4 rad/s the accuracy is an absolute tolerance of several times the relative one's."""
    of, start = system("full", center=np.zeros(3)), spinning(0.1, 0.2, 0.3)
    setups = ("physics", "as-shipped")
    ends = [basilisk(of, setup).run(start, "RKF45", 8.0, 1, 1, 1e-3) for setup in setups]
    assert apart(ends[0].state[-1], ends[1].state[-1]) > 0.0


@pytest.mark.parametrize("name", sorted(PLANS))
@pytest.mark.parametrize("omega", [1e100, 1e200, np.nan])
def test_a_run_that_overflows_ends_in_nan(name: str, omega: float) -> None:
    start, adapter = spinning(omega, 2 * omega, 3 * omega), basilisk(system("full"))
    found = adapter.run(start, name, 1.0, 2, 1, accuracy_of(name)).state
    assert not np.all(np.isfinite(found.angular_velocity[-1]))
    assert len(adapter.run(a_start(), name, 1.0, 0, 1, accuracy_of(name)).time) == 1


def test_it_is_silent(capfd: pytest.CaptureFixture[str]) -> None:
    adapter = basilisk(system("full", "both"))
    adapter.set_state(a_start())
    adapter.forward_dynamics(states(2))
    for name in PLANS:
        adapter.run(a_start(), name, STEP, 2, 1, accuracy_of(name))
    assert capfd.readouterr() == ("", "")


def test_it_describes_itself() -> None:
    adapter = BasiliskAdapter()
    own = adapter.description
    assert isinstance(adapter, Adapter)
    assert {i.knob for i in own.integrators} == {"timestep", "accuracy"}
    assert all(i.note for i in own.integrators)
    assert own.licence == "ISC"
    assert own.switched_off
    assert not BasiliskAdapter("as-shipped").description.switched_off
    native = adapter.native()
    assert native["conventions"]["omega frame, sigma world-from-body"] == "body axes"
    assert native["conventions"]["linear velocity frame"] == "world axes"
    assert native["defaults"]["svIntegratorRKF45 absTol"] == "1e-8"
