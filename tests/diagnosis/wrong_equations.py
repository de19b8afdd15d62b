"""Equations that are wrong on purpose, over several systems, and what their causes state."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import damping_torque, gravity_torque, torque
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
)
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System
from omegadot.scenarios import scenario

TENSOR = [[1.0, 0.1, 0.2], [0.1, 1.6, -0.15], [0.2, -0.15, 2.1]]
RUN = {"duration": 2.0, "timesteps": [0.02, 0.01], "sample": 0.1}


def case(name: str, load: dict[str, Any], mass: float = 2.0, tensor: Any = TENSOR) -> Case:
    initial: dict[str, Any] = {"orientation": [0.5, 0.1, -0.7, 0.4]}
    initial["angular_velocity"] = [0.8, 2.0, -0.5]
    if "pivot" not in load:
        initial |= {"position": [0.4, -1.0, 2.0], "linear_velocity": [1.0, -0.5, 3.0]}
    body = {"mass": mass, "inertia": tensor, "center_of_mass": [0.05, -0.2, 0.1]}
    data = {"name": name, "body": body, "initial": initial, "load": load, "run": RUN}
    return case_of(scenario(data), [])


GRAVITY, PIVOT = [1.0, -2.0, -9.0], [0.3, 0.1, -0.2]
BODY_TORQUE = {"frame": "body", "value": [0.4, -0.9, 0.6]}
WORLD_TORQUE = {"frame": "world", "value": [-0.7, 0.2, 0.5]}
CASES = (
    case("free", {}),
    case("falling", {"gravity": GRAVITY}, 3.1),
    case("damped", {"damping": 0.3}),
    case("damped-more", {"damping": 1.7, "torque": BODY_TORQUE}, 0.7),
    case("damped-most", {"damping": 2.9, "gravity": GRAVITY}),
    case("driven", {"torque": BODY_TORQUE}, 1.3),
    case("driven-in-world", {"torque": WORLD_TORQUE}),
    case("top", {"gravity": GRAVITY, "pivot": PIVOT}),
    case("falling-slowly", {"gravity": [0.3, 0.1, 1.1]}),
    case("falling-fast", {"gravity": [-31.0, 17.0, 5.0]}),
    case("top-damped", {"gravity": GRAVITY, "pivot": PIVOT, "damping": 0.4}, 1.7),
    case("top-driven", {"pivot": PIVOT, "torque": WORLD_TORQUE}, 0.9),
    case("top-driven-damped", {"pivot": PIVOT, "torque": BODY_TORQUE, "damping": 0.2}),
)


def with_torque(system: System, states: State, torque: Array) -> Acceleration:
    """The right accelerations with one more torque."""
    true = forward_dynamics(system, states)
    angular = true.angular + apply(inverse(moving_inertia(system)), torque)
    if system.load.pivot is None:
        return Acceleration(angular, true.linear)
    return Acceleration(angular, center_of_mass_acceleration(system, states, angular))


def largest(vector: Array, size: float) -> Array:
    """A vector of this size along the axis of the largest component."""
    one = np.zeros(3)
    k = int(np.argmax(np.abs(vector)))
    one[k] = np.copysign(size, vector[k])
    return one


def gyroscopic(system: System, states: State) -> Array:
    w = states.angular_velocity
    return cross(w, apply(moving_inertia(system), w))


def damping_as_rate(system: System, states: State) -> Acceleration:
    w, d = states.angular_velocity, system.load.damping
    return with_torque(system, states, d * w - apply(moving_inertia(system), d * w))


def rate_and_no_gyroscopic_term(system: System, states: State) -> Acceleration:
    w, d = states.angular_velocity, system.load.damping
    more = d * w - apply(moving_inertia(system), d * w)
    return with_torque(system, states, more + gyroscopic(system, states))


def mirrored_center(system: System, states: State) -> Acceleration:
    return with_torque(system, states, -2.0 * gravity_torque(system, states))


def center_with_another_sign_of_x(system: System, states: State) -> Acceleration:
    center = system.body.center_of_mass * [-1.0, 1.0, 1.0]
    body = replace(system.body, center_of_mass=center)
    return forward_dynamics(replace(system, bodies=(body,)), states)


def armature(system: System, states: State) -> Acceleration:
    true = forward_dynamics(system, states)
    inertia = moving_inertia(system)
    angular = np.linalg.solve(inertia + 1e-6 * np.eye(3), (inertia @ true.angular.T)).T
    if system.load.pivot is None:
        return Acceleration(angular, true.linear)
    return Acceleration(angular, center_of_mass_acceleration(system, states, angular))


def under(**change: Any) -> Any:
    def found(system: System, states: State) -> Acceleration:
        made = {name: of(system) for name, of in change.items()}
        return forward_dynamics(replace(system, load=replace(system.load, **made)), states)

    return found


def products_in_another_order(system: System, states: State) -> Acceleration:
    tensor = np.array(system.body.inertia)
    tensor[0, 1] = tensor[1, 0] = system.body.inertia[0, 2]
    tensor[0, 2] = tensor[2, 0] = system.body.inertia[0, 1]
    body = replace(system.body, inertia=tensor)
    return forward_dynamics(replace(system, bodies=(body,)), states)


def tensor_about_other_axes(system: System, states: State) -> Acceleration:
    """As where the principal axes are read off a matrix that is no rotation."""
    turn = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0
    tensor = turn @ np.asarray(system.body.inertia) @ turn.T
    body = replace(system.body, inertia=tensor)
    return forward_dynamics(replace(system, bodies=(body,)), states)


def mass_in_single_precision(system: System, states: State) -> Acceleration:
    mass = np.asarray(float(np.float32(system.body.mass)))
    body = replace(system.body, mass=mass)
    return forward_dynamics(replace(system, bodies=(body,)), states)


def spatial(system: System, states: State) -> Acceleration:
    true = forward_dynamics(system, states)
    turning = rotate(states.orientation, states.angular_velocity)
    return Acceleration(true.angular, true.linear - cross(turning, states.linear_velocity))


def no_gyroscopic_term_when_fast(system: System, states: State) -> Acceleration:
    fast = np.sum(states.angular_velocity**2, axis=-1, keepdims=True) > 9.0
    return with_torque(system, states, np.where(fast, gyroscopic(system, states), 0.0))


def cubic_damping(system: System, states: State) -> Acceleration:
    w = states.angular_velocity
    return with_torque(system, states, -0.01 * np.sum(w * w, axis=-1, keepdims=True) * w)


def gyroscopic_without_x(system: System, states: State) -> Acceleration:
    return with_torque(system, states, gyroscopic(system, states) * np.array([1.0, 0.0, 0.0]))


def weight_partly_balanced(system: System, states: State) -> Acceleration:
    """A tenth of the torque of gravity about the body's z axis is compensated."""
    part = np.array([0.0, 0.0, -0.1])
    return with_torque(system, states, part * gravity_torque(system, states))


def weight_partly_balanced_in_world(system: System, states: State) -> Acceleration:
    """Half of its torque about the world's x axis is."""
    q, torque = states.orientation, gravity_torque(system, states)
    part = np.array([-0.5, 0.0, 0.0])
    return with_torque(system, states, rotate_inverse(q, part * rotate(q, torque)))


def loads_by_an_attitude_without_its_sign(system: System, states: State) -> Acceleration:
    q = states.orientation.copy()
    q[:, 0] = np.abs(q[:, 0])
    wrong, right = (torque(system, one) for one in (replace(states, orientation=q), states))
    return with_torque(system, states, wrong - right)


def damping_of_a_copied_line(system: System, states: State) -> Acceleration:
    """The third component is by the rate about the second axis."""
    more = states.angular_velocity[:, 2] - states.angular_velocity[:, 1]
    torque_z = float(system.load.damping) * more[:, None] * np.array([0.0, 0.0, 1.0])
    return with_torque(system, states, torque_z)


def world_torque_by_angles_in_another_order(system: System, states: State) -> Acceleration:
    angles = Rotation.from_quat(np.roll(states.orientation, -1, axis=-1)).as_euler("ZYX")
    turned = Rotation.from_euler("XYZ", angles[:, ::-1])
    world = np.asarray(system.load.torque_world)
    right = rotate_inverse(states.orientation, world)
    return with_torque(system, states, turned.inv().apply(world) - right)


def gyroscopic_of_world_omega(system: System, states: State) -> Acceleration:
    turned = rotate(states.orientation, states.angular_velocity)
    wrong = cross(turned, apply(moving_inertia(system), turned))
    return with_torque(system, states, gyroscopic(system, states) - wrong)


def constant_rate(system: System, states: State) -> Acceleration:
    rate = np.array([0.0, 0.0, 2e-3]) + 0.0 * states.angular_velocity
    return with_torque(system, states, apply(moving_inertia(system), rate))


def turning_world(system: System, states: State) -> Acceleration:
    turn = rotate_inverse(states.orientation, np.array([0.0, 0.0, 7.292e-5]))
    rate = cross(states.angular_velocity, turn)
    return with_torque(system, states, apply(moving_inertia(system), rate))


def torque_turned_back(system: System, states: State) -> Acceleration:
    world = system.load.torque_world
    wrong, right = (turn(states.orientation, world) for turn in (rotate, rotate_inverse))
    return with_torque(system, states, wrong - right)


def scaled_moment(system: System, states: State) -> Acceleration:
    tensor = np.array(system.body.inertia) + np.diag([0.0, 0.0, 0.03 * system.body.inertia[2, 2]])
    body = replace(system.body, inertia=tensor)
    return forward_dynamics(replace(system, bodies=(body,)), states)


def accelerometer(system: System, states: State) -> Acceleration:
    true = forward_dynamics(system, states)
    return Acceleration(true.angular, true.linear - system.load.gravity)


def air_drag(system: System, states: State) -> Acceleration:
    true, v = forward_dynamics(system, states), states.linear_velocity
    if system.load.pivot is not None:
        return true
    speed = np.linalg.norm(v, axis=-1, keepdims=True)
    return Acceleration(true.angular, true.linear - 0.03 * speed * v)


def weaker_with_height(system: System, states: State) -> Acceleration:
    true, g = forward_dynamics(system, states), system.load.gravity
    if system.load.pivot is not None:
        return true
    return Acceleration(true.angular, true.linear - 3e-7 * g * states.position[:, 2:])


def of_a_planet(system: System, states: State) -> Acceleration:
    """Of a small one: the law of squares, which no line through a few places is."""
    true, g = forward_dynamics(system, states), system.load.gravity
    if system.load.pivot is not None or not np.any(g):
        return true
    height = -(states.position @ g) / np.linalg.norm(g)
    part = (5000.0 / (5000.0 + height)) ** 2
    return Acceleration(true.angular, true.linear + (part - 1.0)[:, None] * g)


def quartic_damping(system: System, states: State) -> Acceleration:
    w = states.angular_velocity
    return with_torque(system, states, -0.01 * np.sum(w * w, axis=-1, keepdims=True) ** 1.5 * w)


def gyroscopic_swapped(system: System, states: State) -> Acceleration:
    term = gyroscopic(system, states)
    return with_torque(system, states, term - term[:, [1, 0, 2]])


def damping_by_a_power(system: System, states: State) -> Acceleration:
    size = np.linalg.norm(states.angular_velocity, axis=-1, keepdims=True)
    return with_torque(system, states, damping_torque(system, states) * (np.sqrt(size) - 1.0))


def damping_about_world_z(system: System, states: State) -> Acceleration:
    q, torque = states.orientation, damping_torque(system, states)
    level = rotate(q, torque) * np.array([1.0, 1.0, 0.0])
    return with_torque(system, states, -rotate_inverse(q, level))


def spring(system: System, states: State) -> Acceleration:
    q = states.orientation
    return with_torque(system, states, -0.2 * np.sign(q[:, :1]) * q[:, 1:])


def torque_of_first_attitude(system: System, states: State) -> Acceleration:
    first = np.broadcast_to(states.orientation[:1], states.orientation.shape)
    world = system.load.torque_world
    wrong, right = (rotate_inverse(q, world) for q in (first, states.orientation))
    return with_torque(system, states, wrong - right)


EQUATIONS: dict[str, tuple[Any, str]] = {
    "tensor about other axes": (
        tensor_about_other_axes,
        "its moments about the centre of mass are the requested ones, about other axes",
    ),
    "rate": (damping_as_rate, "the damping acts as a rate"),
    "rate-no-gyro": (rate_and_no_gyroscopic_term, "the gyroscopic term is missing"),
    "mirrored": (mirrored_center, "the centre of mass is mirrored"),
    "mirrored in x": (
        center_with_another_sign_of_x,
        "the x component of the centre of mass has the wrong sign",
    ),
    "armature": (armature, "1e-6 kg m^2 is added to the inertia's diagonal"),
    "clamp": (
        under(damping=lambda s: np.minimum(s.load.damping, 1.0)),
        "the damping is limited to 1 N m s/rad",
    ),
    "elif": (
        under(torque_body=lambda s: s.load.torque_body * (s.load.damping == 0.0)),
        "is missing",
    ),
    "pivot-no-damping": (
        under(damping=lambda s: s.load.damping * (s.load.pivot is None)),
        "the damping is missing, but only where the body is pivoted",
    ),
    "gravity-down": (
        under(gravity=lambda s: np.array([0.0, 0.0, -np.linalg.norm(s.load.gravity)])),
        "gravity points along -z, whatever direction was requested",
    ),
    "gravity-snapped": (
        under(gravity=lambda s: largest(s.load.gravity, float(np.linalg.norm(s.load.gravity)))),
        "gravity acts along the axis of its largest component, with its whole magnitude",
    ),
    "gravity-largest": (
        under(gravity=lambda s: largest(s.load.gravity, float(np.max(np.abs(s.load.gravity))))),
        "only the largest component of gravity acts",
    ),
    "products": (products_in_another_order, "the products of inertia are in another order"),
    "mass-float32": (mass_in_single_precision, "the mass is kept in single precision"),
    "spatial": (spatial, "the linear acceleration is the spatial one"),
    "fast": (
        no_gyroscopic_term_when_fast,
        "the gyroscopic term is missing, but only where |omega| is above",
    ),
    "row": (gyroscopic_without_x, "of the gyroscopic term the x component is missing"),
    "weight-row": (
        weight_partly_balanced,
        "of the torque of gravity the z component is scaled by 0.9",
    ),
    "weight-world-row": (
        weight_partly_balanced_in_world,
        "of the torque of gravity in world axes the x component is scaled by 0.5",
    ),
    "unsigned": (
        loads_by_an_attitude_without_its_sign,
        "in the torques of the loads, the quaternion's scalar is rebuilt from its vector part, "
        "without its sign",
    ),
    "copied-line": (
        damping_of_a_copied_line,
        "the damping torque is multiplied by the matrix ((1, 0, 0); (0, 1, 0); (0, 1, 0))",
    ),
    "angles": (
        world_torque_by_angles_in_another_order,
        "in the torque in world axes, the angles a, b, c of R_z(a) R_y(b) R_x(c) are put together "
        "as R_x(c) R_y(b) R_z(a)",
    ),
    "world-omega": (gyroscopic_of_world_omega, "formed with omega in world axes"),
    "constant": (constant_rate, "omega-dot has a constant (0, 0, 0.002) rad/s^2 in body axes"),
    "turning": (
        turning_world,
        "omega x c in it with c = (0, 0, 7.292e-5) rad/s, constant in world",
    ),
    "torque-back": (torque_turned_back, "turned into the body by the transposed rotation"),
    "moment": (scaled_moment, "the moment of inertia zz is scaled by 1.03"),
    "accelerometer": (accelerometer, "the linear acceleration leaves gravity out"),
    "drag": (air_drag, "the acceleration has -0.03 |v| v in it"),
    "height": (
        weaker_with_height,
        "gravity changes with the place: by -3e-7 of it a metre along z",
    ),
    "planet": (
        of_a_planet,
        "gravity falls with the height z of the centre of mass above the world's origin, as "
        "(E / (E + z))^2 with E = 5000 m",
    ),
    "gravity-up": (
        under(gravity=lambda s: s.load.gravity[[0, 2, 1]] * np.array([1.0, 1.0, -1.0])),
        "gravity has other axes: x, y, z hold x, z, -y of what was requested",
    ),
    "gravity-size": (
        under(gravity=lambda s: s.load.gravity / (np.linalg.norm(s.load.gravity) or 1.0) * 9.81),
        "the size of gravity is 9.81 m/s^2, whatever was requested",
    ),
    "cubic": (cubic_damping, "a torque of -0.01 |omega|^2 omega N m acts"),
    "quartic": (quartic_damping, "a torque k |omega|^3 omega is added, with k = -0.01 kg m^2 s^2"),
    "swapped": (
        gyroscopic_swapped,
        "the components of the gyroscopic term are others: x, y, z hold y, x, z",
    ),
    "power": (damping_by_a_power, "the damping torque is multiplied by |omega|^0.5"),
    "world-z": (damping_about_world_z, "damping in world axes the x and y components are missing"),
    "spring": (spring, "a torque of -0.1 N m a radian acts that depends on the attitude"),
    "first": (torque_of_first_attitude, "by the attitude of a batch's first state"),
    "world-torque": (
        under(torque_world=lambda s: 0.5 * s.load.torque_world),
        "the torque in world axes is scaled by 0.5",
    ),
}
