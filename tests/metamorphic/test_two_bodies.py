"""A second body in the same world, which touches nothing, changes no digit that matters.

The adapters' protocol loads one body a world, so two are built through the engines themselves.
Catches a solver whose tolerance couples what is not coupled, and a mass matrix that is not block
diagonal. Pinocchio has no worlds: its trees of bodies are one mechanism.
"""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from random_motions import ROUNDINGS, Motion, Wanted, random_motion

from omegadot.gates.bounds.scales import EPS, body_scale, norm, torque_size
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, State

FREE = Wanted(pivoted=False, damped=False)
BODY = """
<body pos="{p}" quat="{q}">
  <freejoint/>{geom}<inertial pos="{c}" mass="{m}" fullinertia="{i}"/>
</body>"""
TOUCHING = '<geom type="sphere" size="10" mass="0"/>'


def numbers(values: Array) -> str:
    return " ".join(f"{value:.17g}" for value in values)


def mujoco_body(motion: Motion, geom: str) -> str:
    body, state = motion.system.body, motion.first
    i = body.inertia
    full = np.array([i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]])
    return BODY.format(
        p=numbers(state.position),
        q=numbers(state.orientation),
        c=numbers(body.center_of_mass),
        m=f"{float(body.mass):.17g}",
        i=numbers(full),
        geom=geom,
    )


def mujoco_omega_dot(motions: list[Motion], geom: str = "") -> Array:
    """MuJoCo's omega-dot of the first of some free bodies in one world."""
    import mujoco

    world = "".join(mujoco_body(motion, geom) for motion in motions)
    text = '<mujoco><compiler balanceinertia="false" boundmass="0" boundinertia="0"/>'
    text += f'<option gravity="0 0 0"/><worldbody>{world}</worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for place, motion in enumerate(motions):
        data.qvel[6 * place + 3 : 6 * place + 6] = motion.first.angular_velocity
    mujoco.mj_forward(model, data)
    return np.array(data.qacc[3:6])


def dart_omega_after(motions: list[Motion], timestep: float) -> Array:
    """DART's omega, in body axes, of the first of some free bodies after one step."""
    import dartpy as dart

    world = dart.simulation.World()
    world.setGravity(np.zeros(3))
    world.setTimeStep(timestep)
    nodes = []
    for motion in motions:
        skeleton = dart.dynamics.Skeleton()
        joint, node = skeleton.createFreeJointAndBodyNodePair()
        body = motion.system.body
        node.setInertia(dart.dynamics.Inertia(float(body.mass), body.center_of_mass, body.inertia))
        joint.setAngularVelocity(motion.first.angular_velocity)
        world.addSkeleton(skeleton)
        nodes.append(node)
    world.step()
    return np.array(nodes[0].getAngularVelocity(dart.dynamics.Frame.World(), nodes[0]))


def allowed(motion: Motion) -> float:
    """rad/s^2: what rounding may do to omega-dot, as in the equation gate."""
    system, first = motion.system, motion.first
    size = torque_size(system, first, forward_dynamics(system, first))
    return ROUNDINGS * EPS * float(size / body_scale(system).smallest)


def unloaded(seed: int) -> Motion:
    motion = random_motion(seed, FREE)
    still = np.zeros_like(motion.states.linear_velocity)
    states = State(
        motion.states.orientation, motion.states.angular_velocity, motion.states.position, still
    )
    system = type(motion.system)(motion.system.bodies)
    return Motion(system, states)


@given(st.integers(0, 2**31), st.integers(0, 2**31))
def test_two_bodies_in_mujoco(one: int, other: int) -> None:
    first, second = unloaded(one), unloaded(other)
    gap = norm(mujoco_omega_dot([first, second]) - mujoco_omega_dot([first]))
    assert gap <= allowed(first)


def test_bodies_that_touch_in_mujoco_do_affect_each_other() -> None:
    first, second = unloaded(1), unloaded(2)
    alone = mujoco_omega_dot([first], TOUCHING)
    assert norm(mujoco_omega_dot([first, second], TOUCHING) - alone) > allowed(first)


@given(st.integers(0, 2**31), st.integers(0, 2**31))
def test_two_bodies_in_dart(one: int, other: int) -> None:
    first, second = unloaded(one), unloaded(other)
    step = 0.05 / float(norm(first.first.angular_velocity))
    gap = norm(dart_omega_after([first, second], step) - dart_omega_after([first], step))
    assert gap <= step * allowed(first) + ROUNDINGS * EPS * norm(first.first.angular_velocity)


def test_a_shared_step_of_another_length_would_show() -> None:
    first = unloaded(1)
    step = 0.05 / float(norm(first.first.angular_velocity))
    gap = norm(dart_omega_after([first], step) - dart_omega_after([first], 1.000001 * step))
    assert gap > step * allowed(first) + ROUNDINGS * EPS * norm(first.first.angular_velocity)
