"""How far an implicit scheme's equation is solved: after how many iterations, or to what change.

From every sample the step's equation is iterated, and the iterate that is the next sample is found.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical, from_coordinates, to_coordinates
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian, solver_of_one_minus
from omegadot.reference_impl.schemes.motion import per_matrix
from omegadot.reference_impl.system import Array

MOST = 40  # iterations
MOST_RUNS = 8
NEAR = 1e-3  # of what an iterate leaves, as a Jacobian by differences may change
LEAST = 3  # intervals that show it
KINDS = {
    "fixed-point": "from the velocities of its start",
    "fixed-point ": "from the explicit step",
    "Newton": "from the velocities of its start",
    "Newton ": "from the explicit step",
    "simplified Newton": "from the velocities of its start",
}


@dataclass(frozen=True)
class _Iterates:
    """Of m steps: whether iterate k is the next sample, and by how much it moved omega in rad/s.

    matches: (MOST + 1, m).  changes: (MOST + 1, m), inf for the guess.  rate: (m,), |omega|.
    """

    matches: NDArray[np.bool_]
    changes: Array
    rate: Array


def solved_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The iteration that stops too early, in every step; none where none is seen."""
    if by.scheme.name != "implicit-midpoint":
        return []
    single = [run.short for run in runs if run.sweep.every == 1]
    chosen = sorted(single, key=lambda run: not run.fails)[:MOST_RUNS]
    with np.errstate(all="ignore"):
        for kind, guess in KINDS.items():
            found = [_iterates(run, by, kind) for run in chosen]
            text = _text(found, f"{kind.strip()} iterations {guess}") if found else ""
            if text:
                return [text]
    return []


def _iterates(run: KeptRun, by: SchemeOf, kind: str) -> _Iterates:
    motion = body_motion(run.system, by.coordinates)
    q, v = to_coordinates(run.system, run.state[:-1], by.coordinates)
    q, h = motion.normalize(q), run.sweep.timestep
    matches, changes, last = [], [], np.full_like(v, np.inf)
    solved = run.apart(run.ends(SchemeOf(by.scheme, canonical(run.system, by.coordinates))))
    for mean in _means(motion, q, v, h, kind):
        ends = motion.retract(q, motion.cayley(h * mean)), 2.0 * mean - v
        apart = run.apart(from_coordinates(run.system, *ends, by.coordinates))
        good = [
            norm(apart[c]) <= SLACK * run.bounds[c] + NEAR * norm(solved[c] - apart[c])
            for c in CHANNELS
        ]
        matches.append(np.all(good, axis=0))
        changes.append(norm(2.0 * (mean - last)[..., motion.spin]))
        last = mean
    rate = norm(run.state.angular_velocity[1:])
    return _Iterates(np.stack(matches), np.stack(changes), rate)


def _means(motion: Motion, q: Array, v: Array, h: float, kind: str) -> Iterator[Array]:
    """The mean velocities of a step, guess by guess."""

    def push(mean: Array) -> Array:
        place = motion.retract(q, 0.5 * motion.cayley(h * mean))
        return np.asarray(0.5 * h * motion.acceleration(place, mean))

    first, jacobian = acceleration_and_jacobian(motion, q, v)
    solve = solver_of_one_minus(per_matrix(0.5 * h) * jacobian)
    mean = v + 0.5 * h * first if kind.endswith(" ") else v
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


def _text(found: Sequence[_Iterates], how: str) -> str:
    matches = np.concatenate([one.matches for one in found], axis=1)
    changes = np.concatenate([one.changes for one in found], axis=1)
    rate = np.concatenate([one.rate for one in found])
    if not np.all(np.any(matches, axis=0)):
        return ""
    count = matches.shape[1]
    first = np.argmax(matches, axis=0)  # the first that is the sample; later ones may be as well
    alone = ~matches[np.minimum(first + 1, MOST), np.arange(count)]
    if np.count_nonzero(alone & (first > 0)) < LEAST:
        return ""
    for k in range(1, MOST):
        if np.all(matches[k]):
            kind, _, guess = how.partition(" iterations ")
            times = f"one {kind} iteration" if k == 1 else f"{k} {kind} iterations"
            return f"the scheme's equation is solved by {times} alone, {guess}"
    kind, _, guess = how.partition(" iterations ")
    for size, unit in ((1.0, " rad/s"), (rate, " of omega")):
        moved = changes / size
        low = float(np.max(moved[first, np.arange(count)][alone]))
        before = moved[np.maximum(first - 1, 0), np.arange(count)][first > 1]
        high = float(np.min(before, initial=np.inf))
        if low < high < np.inf:
            few, more = (number(float(f"{end:.1g}")) for end in (low, high))
            limit = few if few == more else f"a limit that lies at some {few} to {more}"
            return (
                f"the scheme's equation is solved by {kind} iterations {guess}, which end once "
                f"omega changes by less than {limit}{unit}"
            )
    return ""
