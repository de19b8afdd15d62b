"""An implicit midpoint step that turns by another increment than the one inside its equation.

The step solves ``v_m = v0 + h/2 a(q_m, v_m)`` with q_m half the turn of its end from q0. Its energy
and momentum are kept where both are of Cayley's increment, ``q1 = q0 cay(h v_m)``. Every pair of a
middle and an end is stepped from every sample.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.system import Array

MIDPOINT = "implicit-midpoint"
MOST_STEPS = 16  # between two samples
LEAST = 3  # intervals that the scheme itself does not make
Increment = Callable[[Motion, Array], Array]  # of h v_m, the vector by which the attitude moves

# Of the middle it is twice the vector: the scheme moves by half of it.
MIDDLES: dict[str, Increment] = {
    "half of Cayley's turn": lambda motion, u: motion.cayley(u),
    "Cayley's transform of half the increment": lambda motion, u: 2.0 * motion.cayley(0.5 * u),
    "the exponential of half the increment": lambda motion, u: u,
}
ENDS: dict[str, Increment] = {
    "Cayley's transform": lambda motion, u: motion.cayley(u),
    "the exponential": lambda motion, u: u,
}
OWN = ("half of Cayley's turn", "Cayley's transform")
TEXT = (
    "in the steps of {}, the attitude turns by {} of the increment at the end of a step, and by {} "
    "inside its equation"
)


def mixed_turns(by: SchemeOf, runs: Sequence[KeptRun], declared: bool) -> list[str]:
    """The pair by which every interval of all runs is made; none where none is, or too many are.

    declared: whether the scheme is; else another turn is no mistake.
    """
    if by.scheme.name != MIDPOINT or not declared:
        return []
    near = sorted((r.short for r in runs if r.sweep.every <= MOST_STEPS), key=_steps)
    off = [run for run in near if run.fails and not np.all(run.sound(_own(by, run)))]
    if not off:
        return []
    left = [(middle, end) for middle in MIDDLES for end in ENDS if (middle, end) != OWN]
    seen = {id(run) for run in off}
    for run in (*off, *(run for run in near if id(run) not in seen)):
        left = [pair for pair in left if _makes(run, by, pair)]
        if not left:
            return []
    if sum(np.count_nonzero(~run.sound(_own(by, run))) for run in off) < LEAST:
        return []
    texts = [TEXT.format(MIDPOINT, end, middle) for middle, end in left]
    return either(texts) if len(texts) <= MOST_NAMED else []


def turned_otherwise(middle: str, end: str) -> Scheme:
    """The implicit midpoint rule with these turns, of `MIDDLES` and `ENDS`."""
    scheme = SCHEMES[MIDPOINT]

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        inside = replace(motion, cayley=lambda u: MIDDLES[middle](motion, u))
        _, after = scheme.step(inside, q, v, h)
        return motion.retract(q, ENDS[end](motion, 0.5 * h * (v + after))), after

    return replace(scheme, step=step)


def _steps(run: KeptRun) -> int:
    return run.sweep.every


def _own(by: SchemeOf, run: KeptRun) -> SchemeOf:
    return SchemeOf(by.scheme, canonical(run.system, by.coordinates))


def _makes(run: KeptRun, by: SchemeOf, pair: tuple[str, str]) -> bool:
    own = _own(by, run)
    return bool(np.all(run.sound(replace(own, scheme=turned_otherwise(*pair)))))
