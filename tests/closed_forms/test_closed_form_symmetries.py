"""What must not change: scales, restarts, reversal and the axes in which a body is described."""

from __future__ import annotations

import numpy as np
from closed_form_errors import EPS
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.reference_impl.closed_forms import closed_form_of, floor
from omegadot.reference_impl.rotations import attitude_angle, rotation_matrix
from omegadot.reference_impl.system import Array, Body, State, System

TIMES = np.linspace(-4.0, 7.0, 12)
_component = st.floats(-2.0, 2.0).map(lambda x: round(x, 6))
_vectors = st.tuples(_component, _component, _component).map(np.array)
_shapes = st.tuples(*[st.floats(0.05, 2.0)] * 3).map(
    lambda g: np.diag([g[1] + g[2], g[2] + g[0], g[0] + g[1]])
)
_quick = settings(max_examples=25, derandomize=True, deadline=None)


def _system(inertia: Array) -> System:
    return System((Body(np.array(1.0), np.zeros(3), inertia),))


def _state(w: Array, q: Array | None = None) -> State:
    q = np.array([0.5, 0.5, -0.5, 0.5]) if q is None else q
    return State(q, w, np.zeros(3), np.zeros(3))


def _distance(a: State, b: State) -> tuple[Array, Array]:
    gap = np.linalg.norm(a.angular_velocity - b.angular_velocity, axis=-1)
    return attitude_angle(a.orientation, b.orientation), gap


@_quick
@given(_shapes, _vectors)
def test_time_scales_out(inertia: Array, w: Array) -> None:
    """Twice as fast is the same motion in half the time; the unit of mass does not matter."""
    slow = closed_form_of(_system(inertia), _state(w))(TIMES)
    fast = closed_form_of(_system(4.0 * inertia), _state(2.0 * w))(0.5 * TIMES)
    angle, gap = _distance(
        slow,
        State(fast.orientation, 0.5 * fast.angular_velocity, fast.position, fast.linear_velocity),
    )
    assert np.all(angle <= 32 * EPS)
    assert np.all(gap <= 16 * EPS * np.linalg.norm(slow.angular_velocity, axis=-1))


@_quick
@given(_shapes, _vectors)
def test_restart(inertia: Array, w: Array) -> None:
    """The motion from a later state is the later motion, within the floors of the two."""
    system = _system(inertia)
    motion = closed_form_of(system, _state(w))
    middle = motion(np.array([1.5]))
    again = _state(middle.angular_velocity[0], middle.orientation[0])
    later = closed_form_of(system, again)(TIMES)
    angle, gap = _distance(motion(TIMES + 1.5), later)
    # the later state carries errors of a few eps: eight times what its rounding does
    resolvable = floor(system, again, TIMES)
    assert np.all(angle <= 8 * (resolvable.attitude + 4 * EPS))
    size = np.linalg.norm(later.angular_velocity, axis=-1)
    assert np.all(gap <= 8 * (resolvable.angular_velocity + 4 * EPS * size))


@_quick
@given(_shapes, _vectors)
def test_reversal(inertia: Array, w: Array) -> None:
    """With ω reversed the body goes back through the same attitudes."""
    system = _system(inertia)
    forth = closed_form_of(system, _state(w))(TIMES)
    back = closed_form_of(system, _state(-w))(-TIMES)
    angle, gap = _distance(
        forth, State(back.orientation, -back.angular_velocity, back.position, back.linear_velocity)
    )
    assert np.all(angle <= 32 * EPS)
    assert np.all(gap <= 16 * EPS * np.linalg.norm(forth.angular_velocity, axis=-1))


@_quick
@given(_shapes, _vectors, st.permutations([0, 1, 2]))
def test_order_of_the_axes(inertia: Array, w: Array, order: list[int]) -> None:
    """Other names of the body's axes give the same motion in those names."""
    p = np.eye(3)[order]
    if np.linalg.det(p) < 0:
        p = -p
    plain = closed_form_of(_system(inertia), _state(w, np.array([1.0, 0, 0, 0])))(TIMES)
    moved = closed_form_of(_system(p @ inertia @ p.T), _state(p @ w, np.array([1.0, 0, 0, 0])))(
        TIMES
    )
    gap = np.linalg.norm(moved.angular_velocity @ p - plain.angular_velocity, axis=-1)
    assert np.all(gap <= 16 * EPS * np.linalg.norm(plain.angular_velocity, axis=-1))
    turned = p @ rotation_matrix(plain.orientation) @ p.T
    assert np.abs(turned - rotation_matrix(moved.orientation)).max() <= 64 * EPS
