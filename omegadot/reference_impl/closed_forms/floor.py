"""How far a perfect double-precision answer may be off, given the rounding of its inputs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.closed_forms.digits import EPSILON, many_digits
from omegadot.reference_impl.closed_forms.problem import Motion, Problem
from omegadot.reference_impl.system import Array


@dataclass(frozen=True)
class Floor:
    """The resolvable floor at each time.

    angular_velocity: (n,) rad/s, norm of the error.  attitude: (n,) rad, angle of the error.
    """

    angular_velocity: Array
    attitude: Array


def floor_of(problem: Problem, times: Array) -> Floor:
    """The floor at times (n,) s.

    A double stands for all numbers that round to it. Each number of the problem is moved by one
    relative eps up and down, the form is evaluated again, the greater of the two distances is
    taken and the distances of all numbers are added. The answer's own rounding is added once: a
    component is an amplitude times a function of time, so that three values are rounded, each by
    half an eps. Nothing is linearised: where one rounding of an input takes the body across the
    separatrix the floor is as large as the motion, as it should be. Zeros are exact.
    """
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
