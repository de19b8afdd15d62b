"""Bodies, systems and states that the tests of the equations share."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from omegadot.reference_impl.coordinates import Coordinates, from_coordinates, to_coordinates
from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import exp_quaternion, normalize, rotation_matrix
from omegadot.reference_impl.schemes import Motion, Scheme
from omegadot.reference_impl.system import Array, Body, Load, State, System

EPS = np.finfo(float).eps

numbers = st.floats(-3.0, 3.0, allow_nan=False, width=32)
vectors = st.tuples(numbers, numbers, numbers).map(lambda v: np.array(v, float))
quaternions = vectors.map(exp_quaternion)
positive = st.floats(0.1, 5.0)


@st.composite
def inertias(draw: st.DrawFn) -> Array:
    """Tensors of solids: ``tr(S) 1 - S`` with S positive definite, in any attitude."""
    squares = np.array([draw(positive) for _ in range(3)])
    axes = rotation_matrix(draw(quaternions))
    second_moment = (axes * squares) @ axes.T
    inertia = np.trace(second_moment) * np.eye(3) - second_moment
    return (inertia + inertia.T) / 2


@st.composite
def systems(draw: st.DrawFn, pivoted: bool | None = None) -> System:
    """Any body under all loads at once, free or pivoted."""
    pivoted = draw(st.booleans()) if pivoted is None else pivoted
    body = Body(np.array(draw(positive)), draw(vectors), draw(inertias()))
    load = Load(
        gravity=draw(vectors),
        pivot=draw(vectors) if pivoted else None,
        damping=np.array(draw(st.floats(0.0, 1.0))),
        torque_body=draw(vectors),
        torque_world=draw(vectors),
    )
    return System((body,), load)


@st.composite
def states(draw: st.DrawFn) -> State:
    """Any state of a free body."""
    return State(draw(quaternions), draw(vectors), draw(vectors), draw(vectors))


def system(
    inertia: object, mass: float = 1.0, center: object = (0, 0, 0), **load: object
) -> System:
    """A system from plain numbers."""
    tensor = np.array(inertia, float)
    body = Body(
        np.array(mass, float),
        np.array(center, float),
        np.diag(tensor) if tensor.ndim == 1 else tensor,
    )
    arrays = {name: np.array(value, float) for name, value in load.items()}
    return System((body,), Load(**arrays))


def start(
    w: object,
    orientation: object = (1, 0, 0, 0),
    position: object = (0, 0, 0),
    velocity: object = (0, 0, 0),
    on: System | None = None,
) -> State:
    """A state from plain numbers; `on` a pivoted system the body is placed on its pivot."""
    state = State(
        normalize(np.array(orientation, float)),
        np.array(w, float),
        np.array(position, float),
        np.array(velocity, float),
    )
    return state if on is None else place_on_pivot(on, state)


TURNED = rotation_matrix(normalize(np.array([4.0, 1.0, -2.0, 0.5])))


def turned(moments: object) -> Array:
    """A tensor with these principal moments, its axes along no axis of the body."""
    tensor = TURNED @ np.diag(np.array(moments, float)) @ TURNED.T
    return (tensor + tensor.T) / 2


FREE = system([1.0, 2.0, 2.5], mass=2.0, gravity=(0, 0, -9.81))
TOP = system(
    turned([0.4, 0.5, 0.7]), mass=1.5, center=(0.02, 0.01, 0.2), pivot=(0, 0, 0), gravity=(0, 1, -9)
)
DRIVEN = system(
    [1.0, 2.0, 2.5], gravity=(0, 0, -9.81), torque_world=(0.9, -0.6, 1.2), torque_body=(0.3, 0, 0.4)
)
DAMPED = system([1.0, 2.0, 2.5], gravity=(0, 0, -9.81), damping=0.4, torque_body=(0.3, 0.8, 0.4))


def rows(state: State, index: object) -> State:
    """The state at an index of the leading axes."""
    return State(
        state.orientation[index],
        state.angular_velocity[index],
        state.position[index],
        state.linear_velocity[index],
    )


def in_long_double(value: State | Body | Load) -> object:
    """The same arrays in long double, to step the schemes in: a double on some platforms."""
    arrays = {k: None if v is None else v.astype(np.longdouble) for k, v in vars(value).items()}
    return replace(value, **arrays)


COUNT = 10


def cloud(seed: int, pivot: Array | None) -> tuple[System, Array, Array]:
    """A body of point masses: the system, the masses, and their places from the centre of mass."""
    rng = np.random.default_rng(seed)
    masses, points = rng.uniform(0.2, 2.0, COUNT), rng.normal(size=(COUNT, 3))
    center = masses @ points / masses.sum()
    r = points - center
    r_x = skew(r)
    inertia = np.einsum("n,nji,njk->ik", masses, r_x, r_x)
    body = Body(masses.sum(), center, inertia)
    return System((body,), Load(gravity=rng.normal(size=3), pivot=pivot)), masses, r


pivots = st.one_of(st.none(), vectors)
seeds = st.integers(0, 1000)


def one_step(
    scheme: Scheme,
    on: System,
    state: State,
    dt: float | Array,
    coordinates: Coordinates = "com-world",
    motion: Motion | None = None,
) -> State:
    """The state after one step of the reference's body, or of another motion of it."""
    q, v = to_coordinates(on, state, coordinates)
    h = dt if isinstance(dt, float) else np.asarray(dt)[..., None]
    q, v = scheme.step(motion or body_motion(on, coordinates), q, v, h)
    return from_coordinates(on, q, v, coordinates)
