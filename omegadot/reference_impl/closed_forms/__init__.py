"""Motions known in closed form, the truth that engines are held against.

``closed_form_of(system, initial)`` gives the motion as a function of time, or None where no closed
form is known; ``floor(system, initial, times)`` is how far a perfect answer in double precision
may be off. Inputs are taken as exact (the orientation after normalisation); times may be negative.

A symmetric body that friction slows down is left to the series: its ω is elementary, but its
Cayley-Klein parameters obey a biconfluent Heun equation where it is a flat disc (DLMF 31.12.3),
and in general an equation that no standard function solves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.closed_forms.digits import EPSILON, many_digits
from omegadot.reference_impl.closed_forms.fixed_axis import fixed_axis_of
from omegadot.reference_impl.closed_forms.free_rotation import free_rotation_of
from omegadot.reference_impl.closed_forms.given import Given
from omegadot.reference_impl.closed_forms.lagrange_top import lagrange_top_of
from omegadot.reference_impl.closed_forms.problem import Motion, Problem
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import Array, State, System

__all__ = ["Floor", "closed_form_of", "floor", "problem_of"]

_FORMS = (free_rotation_of, fixed_axis_of, lagrange_top_of)


def problem_of(system: System, initial: State) -> Problem | None:
    """Which closed form the motion has, with its numbers; None where none is known.

    Raises ValueError where the arrays hold more than one body or state.
    """
    for name, array, shape in (
        ("inertia", system.body.inertia, (3, 3)),
        ("angular velocity", initial.angular_velocity, (3,)),
        ("orientation", initial.orientation, (4,)),
    ):
        if np.shape(array) != shape:
            raise ValueError(
                f"a closed form is for one body and one initial state: the {name} has the shape "
                f"{np.shape(array)}, {shape} was expected"
            )
    with many_digits():
        given = Given.of(system, initial)
        found = (form(given) for form in _FORMS)
        return next((problem for problem in found if problem is not None), None)


def closed_form_of(system: System, initial: State) -> Callable[[Array], State] | None:
    """The exact motion as a function of times (n,) s, or None where no closed form is known.

    The state's arrays have the times as their leading axis. A free body's centre of mass falls,
    ``x = x0 + v0 t + g t²/2``; a pivoted one's follows from the attitude.
    """
    problem = problem_of(system, initial)
    if problem is None:
        return None
    motion = problem.solve(problem.numbers)

    def states(times: Array) -> State:
        times = np.atleast_1d(np.asarray(times, float))
        orientation, angular_velocity = motion(times)
        position, velocity = _fall(system, initial, times)
        fallen = State(orientation, angular_velocity, position, velocity)
        return place_on_pivot(system, fallen)

    return states


def _fall(system: System, initial: State, times: Array) -> tuple[Array, Array]:
    """Position and velocity of a free centre of mass; one at rest costs no memory."""
    gravity = np.asarray(system.load.gravity, float)
    start, speed = np.asarray(initial.position), np.asarray(initial.linear_velocity)
    if system.load.pivot is not None or not (np.any(start) or np.any(speed) or np.any(gravity)):
        nothing = np.broadcast_to(np.zeros(3), (times.size, 3))
        return nothing, nothing
    t = times[:, None]
    return start + t * (speed + 0.5 * gravity * t), speed + gravity * t


@dataclass(frozen=True)
class Floor:
    """The resolvable floor at each time.

    angular_velocity: (n,) rad/s, norm of the error.  attitude: (n,) rad, angle of the error.
    """

    angular_velocity: Array
    attitude: Array


def floor(system: System, initial: State, times: Array) -> Floor:
    """The resolvable floor of angular velocity and attitude at times (n,) s.

    A double stands for all numbers that round to it. Each number of the problem is moved by one
    relative eps up and down, the form is evaluated again, the greater of the two distances is
    taken and the distances of all numbers are added. The answer's own rounding is added once: a
    component is an amplitude times a function of time, so that three values are rounded, each by
    half an eps. Nothing is linearised: where one rounding of an input takes the body across the
    separatrix the floor is as large as the motion, as it should be. Zeros are exact.
    Raises ValueError where the motion has no closed form.
    """
    problem, times = problem_of(system, initial), np.atleast_1d(np.asarray(times, float))
    if problem is None:
        raise ValueError("the motion has no closed form, so its floor is not known")
    exactly = problem.solve(problem.numbers)
    q, w = exactly(times)
    rounded = 3 * 0.5 * np.finfo(float).eps
    angular_velocity = rounded * np.linalg.norm(w, axis=-1)
    attitude = np.full(times.shape, 2 * rounded)
    for index, number in enumerate(problem.numbers):
        if number == 0:
            continue
        distances = [_distances(_moved(problem, index, s), times, q, w) for s in (1, -1)]
        angle, speed = np.maximum(*distances)
        attitude += angle
        angular_velocity += speed
    return Floor(angular_velocity, attitude)


def _moved(problem: Problem, index: int, sign: int) -> Motion:
    with many_digits():
        numbers = list(problem.numbers)
        numbers[index] *= 1 + sign * EPSILON
        return problem.solve(numbers)


def _distances(motion: Motion, times: Array, q: Array, w: Array) -> Array:
    """(2, n): the angle between the attitudes, the norm of the difference of ω."""
    other_q, other_w = motion(times)
    chord = np.minimum(np.linalg.norm(other_q - q, axis=-1), np.linalg.norm(other_q + q, axis=-1))
    angle = 4 * np.arcsin(np.minimum(0.5 * chord, 1.0))
    return np.array([angle, np.linalg.norm(other_w - w, axis=-1)])
