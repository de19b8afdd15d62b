"""The iterates of an implicit midpoint step, from every sample of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import Coordinates, from_coordinates, to_coordinates
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian, solver_of_one_minus
from omegadot.reference_impl.schemes.motion import per_matrix
from omegadot.reference_impl.system import Array

BY_CAYLEY = "by Cayley's transform"
MOST = 40  # iterations
NEAR = 1e-3  # of what an iterate leaves, as a Jacobian by differences may change


@dataclass(frozen=True)
class Iterates:
    """Of m steps: whether iterate k is the next sample, and by how much it moved omega in rad/s.

    matches: (MOST + 1, m).  changes: (MOST + 1, m), inf for the guess.  rate: (m,), |omega|.
    """

    matches: NDArray[np.bool_]
    changes: Array
    rate: Array


def iterates(run: KeptRun, coordinates: Coordinates, way: str, kind: str) -> Iterates:
    """Guess by guess. way: by which the attitude turns.  kind: a name of `KINDS`, of its guess."""
    motion = body_motion(run.system, coordinates)
    if way != BY_CAYLEY:
        motion = replace(motion, cayley=lambda u: u)
    q, v = to_coordinates(run.system, run.state[:-1], coordinates)
    q, h = motion.normalize(q), run.sweep.timestep
    every, changes, last = list[dict[str, Array]](), [], np.full_like(v, np.inf)
    for mean in means_of(motion, q, v, h, kind):
        ends = motion.retract(q, motion.cayley(h * mean)), 2.0 * mean - v
        every.append(run.apart(from_coordinates(run.system, *ends, coordinates)))
        changes.append(norm(2.0 * (mean - last)[..., motion.spin]))
        last = mean
    near, solved = (0.0 if kind.startswith("fixed") else NEAR), every[-1]
    matches = [
        np.all(
            [
                norm(apart[c]) <= SLACK * run.bounds[c] + near * norm(solved[c] - apart[c])
                for c in CHANNELS
            ],
            axis=0,
        )
        for apart in every
    ]
    rate = norm(run.state.angular_velocity[1:])
    return Iterates(np.stack(matches), np.stack(changes), rate)


def means_of(motion: Motion, q: Array, v: Array, h: float | Array, kind: str) -> Iterator[Array]:
    """The mean velocities of a step, guess by guess."""

    def push(mean: Array) -> Array:
        place = motion.retract(q, 0.5 * motion.cayley(h * mean))
        return np.asarray(0.5 * h * motion.acceleration(place, mean))

    first, jacobian = acceleration_and_jacobian(motion, q, v)
    solve = solver_of_one_minus(per_matrix(0.5 * h) * jacobian)
    mean = v
    if kind.endswith(" "):
        mean = v + (solve(0.5 * h * first) if kind.startswith("simplified") else 0.5 * h * first)
    for _ in range(MOST + 1):
        yield mean
        if kind.startswith("fixed"):
            mean = v + push(mean)
        elif kind.startswith("simplified"):
            mean = mean + solve(v + push(mean) - mean)
        else:
            mean = mean + _newton(push, mean, v + push(mean) - mean)


def _newton(push: Callable[[Array], Array], mean: Array, residual: Array) -> Array:
    """The residual, solved by ``1 - d push / d mean``, by differences."""
    size = 1e-6 * (np.max(norm(mean)) or 1.0)
    count = mean.shape[-1]
    columns = [
        (push(mean + size * e) - push(mean - size * e)) / (2.0 * size) for e in np.eye(count)
    ]
    matrix = np.eye(count) - np.stack(columns, axis=-1)
    return np.asarray(np.linalg.solve(matrix, residual[..., None])[..., 0])
