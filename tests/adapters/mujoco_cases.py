"""Systems and states on which the MuJoCo adapter is tried, and the origin's coordinates."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.system import Array, Body, Load, State, System

EPS = float(np.finfo(float).eps)
GRAVITY = np.array([1.0, 2.0, -9.81])
OFFSET = np.array([0.1, -0.2, 0.3])
PIVOT = np.array([-0.3, 0.1, 0.4])
BODY_TORQUE = np.array([1.0, 2.0, 3.0])
WORLD_TORQUE = np.array([-2.0, 1.0, 0.5])
DAMPING = np.array(0.5)

LOADS = {
    "none": Load(),
    "gravity": Load(gravity=GRAVITY),
    "damping": Load(damping=DAMPING),
    "torque_body": Load(torque_body=BODY_TORQUE),
    "torque_world": Load(torque_world=WORLD_TORQUE),
    "all": Load(GRAVITY, None, DAMPING, BODY_TORQUE, WORLD_TORQUE),
    "pivot": Load(pivot=PIVOT),
    "pivot_gravity": Load(GRAVITY, PIVOT),
    "pivot_damping": Load(GRAVITY, PIVOT, DAMPING),
    "pivot_all": Load(GRAVITY, PIVOT, DAMPING, BODY_TORQUE, WORLD_TORQUE),
}


def rotation(seed: int) -> Array:
    axes = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    turned: Array = axes * np.linalg.det(axes)
    return turned


def tensor(moments: tuple[float, float, float], seed: int = 7) -> Array:
    axes = rotation(seed)
    full: Array = axes @ np.diag(moments) @ axes.T
    return (full + full.T) / 2


INERTIAS = {
    "diagonal": np.diag([3.0, 1.0, 2.5]),
    "full": tensor((1.0, 2.0, 2.8)),
    "flat": np.diag([1.0, 2.0, 3.0]),
    "flat_turned": tensor((1.0, 2.0, 3.0)),
    "thin": np.diag([1e-6, 1.0, 1.0]),
    "thin_turned": tensor((1e-6, 1.0, 1.0)),
    "sphere": np.eye(3) * 0.4,
}


def system(
    inertia: str = "full", load: str = "none", center: Array = OFFSET, mass: float = 2.0
) -> System:
    return System((Body(np.array(mass), center, INERTIAS[inertia]),), LOADS[load])


def states(count: int, seed: int = 0, far: float = 80.0, fast: float = 50.0) -> State:
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(count, 4))
    return State(
        orientation=q / np.linalg.norm(q, axis=-1, keepdims=True),
        angular_velocity=3.0 * rng.normal(size=(count, 3)),
        position=rng.uniform(-far, far, size=(count, 3)),
        linear_velocity=rng.uniform(-fast, fast, size=(count, 3)),
    )


def at(many: State, row: int) -> State:
    return State(*(values[row] for values in parts(many)))


def parts(state: State) -> tuple[Array, Array, Array, Array]:
    return state.orientation, state.angular_velocity, state.position, state.linear_velocity


def norm(vectors: Array) -> Array:
    lengths: Array = np.linalg.norm(vectors, axis=-1)
    return lengths
