"""The engines that run through Node: what they step, and what crosses their border.

They keep three kinds of numbers that the project has not: omega in world axes, principal moments,
and single precision. What a step does is written out here, by the engine's own formula.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from mujoco_cases import GRAVITY, at, norm, parts, states, system

from omegadot.adapters.node.packages import ENGINES, command_of, missing
from omegadot.adapters.protocol import UnsupportedError
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import attitude_angle, quaternion_product, rotate
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, Body, Load, State, System
from omegadot.workers.engine_end.command import CommandAdapter
from omegadot.workers.engine_end.described import description_of

STEP, STEPS = 0.01, 20
EPS = {"cannon-es": float(np.finfo(float).eps)}
SINGLE = float(np.finfo(np.float32).eps)
FEW = 64  # roundings in a row of about twenty operations on three components
SUBSTEPS = {"jolt-physics": 1, "physx-js-webidl": 1, "rapier3d-compat": 4}
PUSHED_FIRST = {"physx-js-webidl", "rapier3d-compat"}
WITHOUT_TORQUE = {"ammo", "physx-js-webidl"}  # their steps are a scheme there alone
TURNED = State(np.array([1.0, 0, 0, 0]), np.array([0.4, 2.0, -0.7]), np.zeros(3), np.zeros(3))


def built(name: str, setup: Any = "physics") -> CommandAdapter:
    if reason := missing(name):
        pytest.skip(reason)
    return started(name, setup)


@cache
def started(name: str, setup: Any) -> CommandAdapter:
    """One program serves every test, so that a test sees what an earlier load left behind."""
    return CommandAdapter(command_of(name), setup)


@pytest.fixture(scope="module", params=sorted(ENGINES))
def engine(request: pytest.FixtureRequest) -> CommandAdapter:
    return built(request.param)


def eps_of(adapter: CommandAdapter) -> float:
    return EPS.get(adapter.description.name, SINGLE)


def taken(adapter: CommandAdapter, load: str = "none") -> System:
    """The fullest system that an engine takes."""
    full = "full_inertia" in adapter.description.features
    found = system("full" if full else "diagonal", load)
    adapter.load(found)
    return found


def of(moments: list[float], **load: Array) -> System:
    return System((Body(np.array(1.0), np.zeros(3), np.diag(moments)),), Load(**load))


def exponential(vector: Array) -> Array:
    """The quaternion of a rotation vector."""
    half = float(norm(vector)) / 2
    return np.array([np.cos(half), *(np.sinc(half / np.pi) / 2 * vector)])


def test_it_describes_itself(engine: CommandAdapter) -> None:
    own = description_of(engine)
    assert own.name in ENGINES
    assert own.licence
    assert own.conventions
    assert own.switched_off
    assert own.precision == ("float64" if own.name in EPS else "float32")
    assert not built(own.name, "as-shipped").description.switched_off


def test_the_model_reads_back(engine: CommandAdapter) -> None:
    """Caught: principal axes that are those of the transposed rotation."""
    requested, eps = taken(engine), eps_of(engine)
    (found,) = engine.model()
    size = float(np.max(np.abs(requested.body.inertia)))
    far = float(norm(requested.body.center_of_mass))
    assert abs(found.mass - requested.body.mass) <= 4 * eps * requested.body.mass
    assert np.max(np.abs(found.center_of_mass - requested.body.center_of_mass)) <= 4 * eps * far
    assert np.max(np.abs(found.inertia - requested.body.inertia)) <= FEW * eps * size


def test_states_come_back_as_they_went_in(engine: CommandAdapter) -> None:
    requested, eps = taken(engine), eps_of(engine)
    many, far = states(10, seed=1, far=3.0, fast=5.0), norm(requested.body.center_of_mass)
    for row in range(10):
        given = at(many, row)
        engine.set_state(given)
        found = engine.get_state()
        assert attitude_angle(found.orientation, given.orientation) <= FEW * eps
        for one, other in zip(parts(found)[1:], parts(given)[1:], strict=True):
            assert norm(one - other) <= FEW * eps * (norm(other) + far)


def test_a_run_logs_the_start_each_kth_step_and_the_last(engine: CommandAdapter) -> None:
    taken(engine, "none")
    start = at(states(1, seed=8, far=1.0, fast=2.0), 0)
    assert np.array_equal(engine.run(start, "step", STEP, 0, 1).time, [0.0])
    every, third = (engine.run(start, "step", STEP, 7, n) for n in (1, 3))
    assert np.array_equal(third.time, np.array([0, 3, 6, 7]) * STEP)
    for first, second in zip(parts(every.state), parts(third.state), strict=True):
        assert np.array_equal(first[[0, 3, 6, 7]], second)


def test_a_run_does_not_depend_on_earlier_calls(engine: CommandAdapter) -> None:
    """Caught: a torque that Rapier goes on applying, forces that are left in a body."""
    many = states(2, seed=7, far=1.0, fast=2.0)
    pushed = of([1.0, 2.0, 2.5], torque_body=np.array([3.0, 2.0, 1.0]), gravity=GRAVITY)
    plain = of([1.0, 2.0, 2.5])
    engine.load(plain)
    before = engine.run(at(many, 0), "step", STEP, 5, 2)
    engine.load(pushed)
    engine.run(at(many, 1), "step", 0.003, 3, 1)
    engine.load(plain)
    engine.set_state(at(many, 1))
    after = engine.run(at(many, 0), "step", STEP, 5, 2)
    for first, second in zip(parts(before.state), parts(after.state), strict=True):
        assert np.array_equal(first, second)


def test_what_is_not_finite_comes_back_as_nan(engine: CommandAdapter) -> None:
    taken(engine)
    start = at(states(1, seed=9, far=1.0, fast=2.0), 0)
    broken = [np.array([1.0, np.nan, 0.0])]
    if engine.description.precision == "float32":
        broken.append(np.array([1.0, 1e39, 0.0]))
    for spin in broken:
        found = engine.run(replace(start, angular_velocity=spin), "step", STEP, 4, 2).state
        assert np.all(np.isnan(found.angular_velocity[1:]))
    sound = engine.run(start, "step", STEP, 4, 2).state
    assert np.all(np.isfinite(sound.angular_velocity))


def test_what_is_not_there_is_refused(engine: CommandAdapter) -> None:
    moments = [1.0, 2.0, 3.0]
    with pytest.raises(UnsupportedError, match="no pivoted bodies"):
        engine.load(of(moments, pivot=np.zeros(3)))
    with pytest.raises(UnsupportedError, match="no damping torque"):
        engine.load(of(moments, damping=np.array(0.1)))
    engine.load(of(moments))
    with pytest.raises(UnsupportedError, match="no integrator 'leap'"):
        engine.run(TURNED, "leap", STEP, 4, 2)
    with pytest.raises(UnsupportedError, match="no operation forward"):
        engine.forward_dynamics(TURNED)
    if "full_inertia" not in engine.description.features:
        with pytest.raises(UnsupportedError, match="no products"):
            engine.load(system("full"))


@pytest.mark.parametrize("name", SUBSTEPS)
@pytest.mark.parametrize("timestep", [STEP, 10 * STEP])
def test_three_engines_turn_the_angular_momentum_and_keep_its_length(
    name: str, timestep: float
) -> None:
    """``L1 = (L - h omega x L) |L| / |L - h omega x L|``, then torque, then Jolt's exponential.

    PhysX has torque first. Rapier does so in four substeps, after torque, and with a straight step
    of the quaternion. What torque adds to omega stays in world axes meanwhile. Caught: a torque in
    the wrong axes, a tensor that is not turned, an engine that steps something else than its note
    states, and at the longer step another engine's turn.
    """
    torque, own = np.array([0.3, -0.2, 0.5]), np.array([-0.4, 0.1, 0.2])
    requested = system("full")
    requested = replace(requested, load=Load(GRAVITY, torque_world=torque, torque_body=own))
    start, adapter = at(states(1, seed=3, far=1.0, fast=2.0), 0), built(name)
    adapter.load(requested)
    steps = STEPS if timestep == STEP else 2  # long ones soon magnify what rounding leaves
    found = adapter.run(start, "step", timestep, steps, steps).state[-1]
    q, w, p, v = parts(start)
    inertia, h = requested.body.inertia, timestep / SUBSTEPS[name]
    for _ in range(steps):
        felt = own + rotate(q * [1, -1, -1, -1], torque)
        push = rotate(q, np.linalg.solve(inertia, felt))
        for _ in range(SUBSTEPS[name]):
            pushed = h * rotate(q * [1, -1, -1, -1], push)
            first = pushed if name in PUSHED_FIRST else 0.0
            momentum = inertia @ (w + first)
            turned = momentum - h * cross(w + first, momentum)
            turned *= norm(momentum) / norm(turned)
            w = np.linalg.solve(inertia, turned) + pushed - first
            v = v + h * GRAVITY
            p = p + h * v
            straight = q + 0.5 * h * quaternion_product(q, np.array([0.0, *w]))
            turns = quaternion_product(q, exponential(h * w))
            q = turns if SUBSTEPS[name] == 1 else straight / norm(straight)
    # each substep rounds states of a few units, and a system without growth adds that up
    bound = FEW * SINGLE * steps * SUBSTEPS[name]
    assert norm(found.angular_velocity - w) <= bound * norm(w)
    assert attitude_angle(found.orientation, q) <= bound
    assert norm(found.position - p) <= bound * norm(p)
    assert norm(found.linear_velocity - v) <= bound * norm(v)


@pytest.mark.parametrize("name", ["ammo", *SUBSTEPS])
@pytest.mark.parametrize("h", [0.01, 0.001])
def test_they_step_the_schemes_they_declare(name: str, h: float) -> None:
    """Over 1000 steps, as far as single precision lets a run be followed.

    PhysX and Bullet declare none where a torque acts. Caught: one step in the place of four
    substeps, a push that turns with the body meanwhile.
    """
    loads = Load(GRAVITY, torque_world=np.array([0.1, 0, 0.1]), torque_body=np.array([0, 0.05, 0]))
    requested, adapter, steps = replace(system("full"), load=loads), built(name), 1000
    if name in WITHOUT_TORQUE:
        adapter.load(requested)
        assert adapter.description.integrators[0].scheme is None
        requested = replace(requested, load=Load(GRAVITY))
    start = at(states(1, seed=4, far=1.0, fast=2.0), 0)
    adapter.load(requested)
    (integrator,) = adapter.description.integrators
    found = adapter.run(start, "step", h, steps, 10).state
    scheme = SCHEMES[integrator.scheme or ""]
    times, own = step_body(scheme, requested, start, h, steps, 10)
    rate = float(np.max(norm(own.angular_velocity)))
    # each substep rounds the state, and what it leaves grows with the motion
    lost = FEW * SINGLE * SUBSTEPS.get(name, 1) * np.maximum(times / h, 1)
    grown = lost * growth_along(requested, times, own, rate)
    assert np.all(norm(found.angular_velocity - own.angular_velocity) <= grown * rate)
    assert np.all(attitude_angle(found.orientation, own.orientation) <= grown)
    assert np.all(norm(found.position - own.position) <= lost * np.max(norm(own.position)))
    speed = float(np.max(norm(own.linear_velocity)))
    assert np.all(norm(found.linear_velocity - own.linear_velocity) <= lost * speed)
    others = {one for one in SCHEMES if one.startswith("semi-implicit-euler")} - {scheme.name}
    for other in others if h == 0.01 else ():  # at shorter steps rounding may hide them
        away = step_body(SCHEMES[other], requested, start, h, steps, 10)[1]
        assert np.any(attitude_angle(found.orientation, away.orientation) > grown)


def test_what_they_declare() -> None:
    """Without torque. Jolt and PhysX as shipped have no gyroscopic force, and are damped."""
    declared: dict[tuple[str, str], str | None] = {}
    for name in ENGINES:
        for setup in ("physics", "as-shipped"):
            adapter = built(name, setup)
            adapter.load(of([1.0, 2.0, 2.5]))
            declared[name, setup] = adapter.description.integrators[0].scheme
    rescaled = "semi-implicit-euler-rescaled-momentum"
    substeps = f"{rescaled}-four-substeps"
    assert {key: scheme for key, scheme in declared.items() if scheme} == {
        ("ammo", "physics"): "linearly-implicit-euler",
        ("ammo", "as-shipped"): "linearly-implicit-euler",
        ("jolt-physics", "physics"): rescaled,
        ("physx-js-webidl", "physics"): rescaled,
        ("rapier3d-compat", "physics"): substeps,
        ("rapier3d-compat", "as-shipped"): substeps,
    }


def test_cannon_has_no_gyroscopic_term() -> None:
    """``w1 = w + h R I^-1 R^T t`` in world axes, and a straight step of the quaternion."""
    own, torque = np.array([0.3, -0.2, 0.5]), np.array([-0.4, 0.1, 0.2])
    moments = [1.0, 2.0, 2.5]
    adapter = built("cannon-es")
    adapter.load(of(moments, torque_body=own, torque_world=torque))
    start = at(states(1, seed=3, far=1.0, fast=2.0), 0)
    found = adapter.run(start, "step", STEP, STEPS, STEPS).state[-1]
    q, w = start.orientation, rotate(start.orientation, start.angular_velocity)
    for _ in range(STEPS):
        felt = own + rotate(q * [1, -1, -1, -1], torque)
        w = w + STEP * rotate(q, felt / moments)
        q = q + 0.5 * STEP * quaternion_product(np.array([0.0, *w]), q)
        q = q / norm(q)
    bound = FEW * EPS["cannon-es"] * STEPS
    assert attitude_angle(found.orientation, q) <= bound
    assert norm(rotate(found.orientation, found.angular_velocity) - w) <= bound * norm(w)


@pytest.mark.parametrize("timestep", [STEP, 10 * STEP])
def test_bullet_solves_for_the_gyroscopic_term_alone(timestep: float) -> None:
    """``w1 = w - (1 - h J)^-1 h I^-1 (w x I w) + h I^-1 t``, ``J = -I^-1 (w x I - (I w) x)``.

    Caught: a torque that is solved for as well, as the reference's scheme has it.
    """
    own, torque = np.array([0.3, -0.2, 0.5]), np.array([-0.4, 0.1, 0.2])
    requested, adapter = system("full"), built("ammo")
    requested = replace(requested, load=Load(GRAVITY, torque_world=torque, torque_body=own))
    adapter.load(requested)
    start = at(states(1, seed=3, far=1.0, fast=2.0), 0)
    found = adapter.run(start, "step", timestep, 1, 1).state[-1]
    inertia, (q, w, p, v) = requested.body.inertia, parts(start)
    momentum = inertia @ w
    slope = cross(w, inertia.T).T - cross(momentum, np.eye(3)).T  # columns are w x I e - (I w) x e
    solved = np.linalg.solve(inertia + timestep * slope, cross(w, momentum))
    push = np.linalg.solve(inertia, own + rotate(q * [1, -1, -1, -1], torque))
    w = w + timestep * (push - solved)
    assert norm(found.angular_velocity - w) <= FEW * SINGLE * norm(w)
    turned = quaternion_product(q, exponential(timestep * w))
    assert attitude_angle(found.orientation, turned) <= FEW * SINGLE
    v = v + timestep * GRAVITY
    assert norm(found.linear_velocity - v) <= FEW * SINGLE * norm(v)
    assert norm(found.position - p - timestep * v) <= FEW * SINGLE * norm(p)


def test_bullet_loses_the_gyroscopic_term_of_small_bodies() -> None:
    """Where the product of the moments is below single precision's rounding, in whatever unit."""
    adapter = built("ammo")
    for product, there in ((1.5, True), (0.9, False)):
        size = (product * SINGLE / 5) ** (1 / 3)
        moments = size * np.array([1.0, 2.0, 2.5])
        adapter.load(of(list(moments)))
        w = TURNED.angular_velocity
        found = adapter.run(TURNED, "step", 1e-3, 1, 1).state[-1].angular_velocity
        change = -1e-3 * cross(w, moments * w) / moments
        # a step of order 1, of some 2e-3 rad
        assert norm(found - w - (change if there else 0.0)) <= 1e-2 * norm(change)


def test_bullet_turns_a_body_too_little_beyond_an_eighth_of_a_turn_in_a_step() -> None:
    """By ``2 atan(4 r / pi tan(pi/8))`` in place of r: the setup physics refuses to go on there."""
    fast = replace(TURNED, angular_velocity=np.array([0.0, 0.0, 0.3 * np.pi / STEP]))
    shipped, adapter = built("ammo", "as-shipped"), built("ammo")
    shipped.load(of([2.0, 2.0, 2.0]))
    adapter.load(of([2.0, 2.0, 2.0]))
    found = shipped.run(fast, "step", STEP, 1, 1).state.orientation
    turn = 2 * np.arctan(1.2 * np.tan(np.pi / 8))
    assert abs(attitude_angle(found[1], found[0]) - turn) <= FEW * SINGLE
    assert adapter.run(fast, "step", STEP / 2, 1, 1).state.orientation.shape == (2, 4)
    with pytest.raises(UnsupportedError, match="beyond 45 degrees in a step"):
        adapter.run(fast, "step", STEP, 1, 1)


@pytest.mark.parametrize("timestep", [STEP, 10 * STEP])
def test_havok_has_no_gyroscopic_term(timestep: float) -> None:
    """``w1 = w + h R I^-1 R^T t`` in world axes, turn ``h w1``, ``x1 = x + h v + 5/8 h^2 g``.

    I^-1 has 8 bits: each principal moment's inverse is off by 2^-8 at most. Caught: moments that
    are not given for a mass of 1 kg.
    """
    own, torque = np.array([0.3, -0.2, 0.5]), np.array([-0.4, 0.1, 0.2])
    requested, adapter = system("full"), built("havok")
    requested = replace(requested, load=Load(GRAVITY, torque_world=torque, torque_body=own))
    adapter.load(requested)
    start = at(states(1, seed=3, far=1.0, fast=2.0), 0)
    found = adapter.run(start, "step", timestep, 1, 1).state[-1]
    q, w, p, v = parts(start)
    back = q * [1, -1, -1, -1]
    push = np.linalg.solve(requested.body.inertia, own + rotate(back, torque))
    turn = rotate(q, w + timestep * push)
    # some sixty roundings, and the push with its 8 bits
    lost = FEW * SINGLE * norm(turn) + timestep * norm(push) * 2**-8
    assert norm(rotate(found.orientation, found.angular_velocity) - turn) <= lost
    turned = quaternion_product(exponential(timestep * turn), q)
    assert attitude_angle(found.orientation, turned) <= FEW * SINGLE + timestep * lost
    assert norm(found.linear_velocity - v - timestep * GRAVITY) <= FEW * SINGLE * norm(v)
    fallen = p + timestep * v + 0.625 * timestep**2 * GRAVITY
    assert norm(found.position - fallen) <= FEW * SINGLE * (norm(p) + norm(v))


def test_havok_brakes_slow_bodies() -> None:
    """By 0.31 m/s^2 below 0.1 m/s, in either setup; faster ones go on."""
    for setup in ("physics", "as-shipped"):
        adapter = built("havok", setup)
        adapter.load(of([2.0, 2.0, 2.0]))
        for speed, kept in ((0.05, 0.0), (0.2, 0.2)):
            start = replace(TURNED, linear_velocity=np.array([speed, 0.0, 0.0]))
            found = adapter.run(start, "step", STEP, 20, 20).state[-1].linear_velocity
            assert abs(found[0] - kept) <= FEW * SINGLE


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("cannon-es", 0.99**STEP),
        ("havok", 1 - 0.1 * STEP),
        ("jolt-physics", 1 - 0.05 * STEP),
        ("physx-js-webidl", 1 - 0.05 * STEP),
    ],
)
def test_as_shipped_they_slow_a_body_down(name: str, factor: float) -> None:
    """None has a gyroscopic term there: omega keeps its direction in world axes."""
    for setup, kept in (("as-shipped", factor), ("physics", 1.0)):
        adapter = built(name, setup)
        adapter.load(of([1.0, 2.0, 2.5]) if setup == "as-shipped" else of([2.0, 2.0, 2.0]))
        end = adapter.run(TURNED, "step", STEP, 1, 1).state[-1]
        found = rotate(end.orientation, end.angular_velocity)
        assert norm(found - kept * TURNED.angular_velocity) <= FEW * SINGLE * norm(found)


@pytest.mark.parametrize(
    ("name", "setting"),
    [
        ("cannon-es", "angularDamping"),
        ("havok", "HP_Body_SetAngularDamping"),
        ("jolt-physics", "mAngularDamping"),
        ("physx-js-webidl", "angularDamping"),
    ],
)
def test_each_setting_is_mended_alone(name: str, setting: str) -> None:
    """One keeps omega, and no other does: a sphere has no gyroscopic term."""
    found = {}
    for own in built(name, "as-shipped").description.settings:
        adapter = CommandAdapter(command_of(name), f"as-shipped+{own}")
        assert not adapter.description.switched_off
        adapter.load(of([2.0, 2.0, 2.0]))
        end = adapter.run(TURNED, "step", STEP, 1, 1).state[-1].angular_velocity
        found[own] = bool(norm(end - TURNED.angular_velocity) <= FEW * SINGLE * norm(end))
    assert len(found) > 1
    assert found == {own: own == setting for own in found}


@pytest.mark.parametrize(
    ("name", "limit"),
    [
        ("havok", 100.0 * (1 - 0.1 * STEP)),
        ("jolt-physics", 0.25 * np.pi * 60 * (1 - 0.05 * STEP)),
        ("physx-js-webidl", 100.0),
    ],
)
def test_as_shipped_they_turn_no_faster_than_their_limit(name: str, limit: float) -> None:
    """Omega is limited when it is set, and slowed down afterwards; PhysX's in the step."""
    fast = replace(TURNED, angular_velocity=np.array([0.0, 0.0, 200.0]))
    for setup, most in (("as-shipped", limit), ("physics", 200.0)):
        adapter = built(name, setup)
        adapter.load(of([2.0, 2.0, 2.0]))
        found = adapter.run(fast, "step", STEP, 1, 1).state[-1].angular_velocity
        assert abs(found[2] - most) <= FEW * SINGLE * most


@pytest.mark.parametrize(
    ("name", "spin"),
    [("ammo", 0.04), ("havok", 1e-3), ("physx-js-webidl", 1e-3), ("rapier3d-compat", 0.04)],
)
def test_as_shipped_they_put_a_slow_body_to_sleep(name: str, spin: float) -> None:
    """Caught: a body that has its omega, and does not turn."""
    slow = replace(TURNED, angular_velocity=np.array([0.0, 0.0, spin]))
    for setup, moves in (("as-shipped", False), ("physics", True)):
        adapter = built(name, setup)
        adapter.load(of([2.0, 2.0, 2.0]))
        found = adapter.run(slow, "step", 0.02, 400, 200).state.orientation
        assert bool(np.any(found[1] != found[2])) is moves


def test_as_shipped_jolt_takes_no_small_moments() -> None:
    """It holds those of a sphere of radius 1 m in their place."""
    small = System((Body(np.array(1e-3), np.zeros(3), 1e-8 * system("full").body.inertia),))
    for setup, expected in (("as-shipped", 4e-4 * np.eye(3)), ("physics", small.body.inertia)):
        adapter = built("jolt-physics", setup)
        adapter.load(small)
        (found,) = adapter.model()
        assert np.max(np.abs(found.inertia - expected)) <= FEW * SINGLE * np.max(expected)


def test_as_shipped_jolt_puts_slow_bodies_to_sleep_and_no_others() -> None:
    """Caught: a shape without size, whose bounds do not move however fast it turns."""
    for spin, moves in ((2.0, True), (1e-3, False)):
        adapter = built("jolt-physics", "as-shipped")
        adapter.load(of([1.0, 2.0, 2.5]))
        start = replace(TURNED, angular_velocity=np.array([0.0, spin, 0.0]))
        found = adapter.run(start, "step", STEP, 100, 100).state[-1].angular_velocity
        assert bool(found.any()) is moves


def test_as_shipped_rapier_goes_no_faster_than_400_m_per_s() -> None:
    fast = replace(TURNED, linear_velocity=np.array([1e3, 0.0, 0.0]))
    for setup, most in (("as-shipped", 400.0), ("physics", 1e3)):
        adapter = built("rapier3d-compat", setup)
        adapter.load(of([1.0, 2.0, 2.5]))
        found = adapter.run(fast, "step", STEP, 1, 1).state[-1].linear_velocity
        assert abs(found[0] - most) <= FEW * SINGLE * most


def test_rapier_cuts_omega_down_to_an_eighth_of_a_turn_in_a_step() -> None:
    """No option changes that, so that the setup physics refuses to go on."""
    limit = np.pi / 4 / STEP
    for spin in (0.99 * limit, 1.2 * limit):
        start = replace(TURNED, angular_velocity=np.array([0.0, 0.0, spin]))
        shipped = built("rapier3d-compat", "as-shipped")
        shipped.load(of([2.0, 2.0, 2.0]))
        found = shipped.run(start, "step", STEP, 3, 3).state[-1].angular_velocity
        assert abs(found[2] - min(spin, limit)) <= FEW * SINGLE * limit
    adapter = built("rapier3d-compat")
    adapter.load(of([2.0, 2.0, 2.0]))
    assert adapter.run(start, "step", STEP / 2, 3, 3).state.orientation.shape == (2, 4)
    with pytest.raises(UnsupportedError, match="at most 45 degrees in a step"):
        adapter.run(start, "step", STEP, 3, 3)
