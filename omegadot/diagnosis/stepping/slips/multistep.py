"""Steps by the rates of several samples: ``y_(n+1) = y_n + h sum b_k f_(n-k)``, fitted to runs.

In runs that keep every step the increments of omega are a linear combination of the equation's own
omega-dot at samples before. The fewest terms that make all of them, within what rounding leaves,
are its formula; attitude, velocity and position must follow it too. The first steps, for which
there are no rates yet, are left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from omegadot.diagnosis.stepping.kept_run import SLACK, KeptRun
from omegadot.diagnosis.stepping.simple_numbers import plain
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
    rotation_between,
)
from omegadot.reference_impl.system import Array

MOST_BACK = 4  # steps
SURE = 0.01  # of a coefficient, that is not settled by the runs if it may be off by more
FREEDOM = 3  # intervals a term, at least
ON_QUATERNION, IN_EXPONENTIAL = "on the quaternion", "in the exponential"
ALIGNED = "on the quaternion, reported with either sign"
BY_END, PLACE_BY_END = "by the omega of the step's end", "by the velocity of the step's end"
Coefficients = tuple[float, ...]  # of f_n, f_(n-1), ...


@dataclass(frozen=True)
class Steps:
    """The m steps of one run that have MOST_BACK before them: in each channel what moves it.

    changes: (m, 3).  rates: (m, MOST_BACK + 1, 3), h f_(n-k).  bound: (m,), of what a formula
    leaves, ``changes - sum b_k rates_k``.
    """

    changes: Array
    rates: Array
    bound: Array

    def made(self, b: Coefficients) -> bool:
        """Whether the formula makes all of these steps."""
        left = self.changes - np.einsum("nkj,k->nj", self.rates, np.array(b))
        return bool(np.all(norm(left) <= self.bound))

    @property
    def weighted(self) -> tuple[Array, Array]:
        """(3 m, MOST_BACK + 1) and (3 m,), in parts of the bound."""
        weight = SLACK / self.bound[:, None]
        rates = np.moveaxis(self.rates, 1, -1) * weight[..., None]
        return rates.reshape(-1, MOST_BACK + 1), np.ravel(self.changes * weight)


def steps_of(run: KeptRun) -> dict[str, Steps]:
    """By channel and way: see `Steps`. A pivoted body has no place.

    By the end of the step, rates are of n + 1 - k.
    """
    state, found = run.state, forward_dynamics(run.system, run.state)
    w, v = state.angular_velocity, state.linear_velocity
    every = {
        "omega": _steps(run, "omega", w, found.angular),
        IN_EXPONENTIAL: _in_exponential(run),
        BY_END: _in_exponential(run, end=1),
        ON_QUATERNION: _on_quaternion(run, aligned=False),
        ALIGNED: _on_quaternion(run, aligned=True),
    }
    if run.system.load.pivot is None:
        every["velocity"] = _steps(run, "velocity", v, found.linear)
        every["position"] = _steps(run, "position", state.position, v)
        every[PLACE_BY_END] = _steps(run, "position", state.position, v, end=1)
    return every


def _steps(run: KeptRun, channel: str, values: Array, rates: Array, end: int = 0) -> Steps:
    changes = values[MOST_BACK + 1 :] - values[MOST_BACK:-1]
    return Steps(changes, run.sweep.timestep * _before(rates, end), _bound(run, channel))


def _bound(run: KeptRun, channel: str) -> Array:
    return SLACK * run.bounds[channel][MOST_BACK:]


def _before(values: Array, end: int = 0) -> Array:
    """(m, MOST_BACK + 1, ...): those at n, n - 1, ..., of each n that has so many; or one later."""
    first, last = MOST_BACK + end, len(values) - 1 + end
    return np.stack([values[first - k : last - k] for k in range(MOST_BACK + 1)], axis=1)


def _in_exponential(run: KeptRun, end: int = 0) -> Steps:
    """``q_(n+1) = q_n exp(h sum b_k omega_(n-k))``."""
    q, w = normalize(run.state.orientation), run.state.angular_velocity
    turned = rotation_between(q[MOST_BACK:-1], q[MOST_BACK + 1 :])
    return Steps(turned, run.sweep.timestep * _before(w, end), _bound(run, "attitude"))


def _on_quaternion(run: KeptRun, aligned: bool) -> Steps:
    """``q_n + h sum b_k q'_(n-k)`` along q_(n+1): of whatever length, it has no part across."""
    q, w = normalize(run.state.orientation), run.state.angular_velocity
    if aligned:
        signs = np.sign(np.sum(q[1:] * q[:-1], axis=-1))
        q = q * np.concatenate(([1.0], np.cumprod(signs)))[:, None]
    rate = quaternion_product(q, np.concatenate((0.0 * w[:, :1], w), axis=-1))
    back = conjugate(q[MOST_BACK + 1 :])
    changes = -2.0 * quaternion_product(back, q[MOST_BACK:-1])[..., 1:]
    moved = quaternion_product(back[:, None], _before(rate))[..., 1:]
    return Steps(changes, run.sweep.timestep * moved, _bound(run, "attitude"))


def formula_of(every: Sequence[Steps]) -> Coefficients | None:
    """The formula of the fewest terms that makes the steps of all runs; None where none does."""
    both = [one.weighted for one in every]
    line, right = (np.concatenate(parts) for parts in zip(*both, strict=True))
    good = np.isfinite(right) & np.isfinite(line).all(axis=-1)
    for chosen in _supports():
        found = _fitted(line[good][:, chosen], right[good])
        if found is None:
            continue
        values, known_to = found
        near = [plain(float(v), float(e)) for v, e in zip(values, known_to, strict=True)]
        for numbers in (near, values.tolist()):
            at = dict(zip(chosen, numbers, strict=True))
            b = tuple(at.get(k, 0.0) for k in range(MOST_BACK + 1))
            if all(one.made(b) for one in every):
                return b
    return None


def _supports() -> Iterator[list[int]]:
    """Places of the terms, of fewer terms and of later rates first."""
    for count in range(1, MOST_BACK + 2):
        yield from (list(one) for one in combinations(range(MOST_BACK + 1), count))


def _fitted(line: Array, right: Array) -> tuple[Array, Array] | None:
    """Least squares, and what each number is known to; None where it is not settled."""
    if len(right) < 3 * FREEDOM * line.shape[1]:
        return None
    values, _, rank, _ = np.linalg.lstsq(line, right)
    if rank < line.shape[1]:
        return None
    _, sizes, axes = np.linalg.svd(line, full_matrices=False)
    # the product of a matrix of nearly equal columns with itself has no inverse
    known_to = SLACK * norm((axes / sizes[:, None]).T)
    return (values, known_to) if np.all(known_to < SURE) else None
