"""A load that acts in some of a step's substeps alone, which runs distinguish from a smaller one.

In steps that vanish both are the same: omega-dot has a part of the load. In longer steps they are
not, since what acts in the first substep turns the body for longer than what acts in the last.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.loads.acting import TERMS, with_factors
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import COMMON, Motion, Scheme
from omegadot.reference_impl.system import Array

MOST_SUBSTEPS = 8
SAME = 5e-6  # relative, of a part of a load, written in six digits
MOST_RUNS = 12  # runs that must fit
LOADS = ("the applied torque", "the damping", "the torque of gravity", "gravity")
PARTS = {2: "half", 3: "a third", 4: "a quarter"}
WHICH = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")
NUMBERS = ("", "", "two", "three", "four", "five", "six", "seven", "eight")


def part_of(k: float) -> Fraction | None:
    """The part of a step, m of n equal ones, n at most eight; None where the factor is no such."""
    if not SAME < k < 1.0:
        return None
    part = Fraction(k).limit_denominator(MOST_SUBSTEPS)
    return part if abs(float(part) / k - 1.0) < SAME else None


def part_named(part: Fraction) -> str:
    """``a third``, ``3/8``."""
    return PARTS.get(part.denominator, str(part)) if part.numerator == 1 else str(part)


def substep_cause(named: str, part: Fraction, runs: Sequence[KeptRun]) -> str:
    """The substeps in which a load of which this part acts does so; "" where runs do not show it.

    Each run, and every one that does not fail, must be stepped so from every sample to the next;
    and not by substeps in each of which the load has this part.  named: the load, as steps that
    vanish name it.
    """
    failing, sound = ([run for run in runs if run.fails is fails] for fails in (True, False))
    close = sorted(failing, key=lambda run: run.sweep.every)
    shown = [run.short for run in (*close[:MOST_RUNS], *sound[: MOST_RUNS // 2])]
    if not close:
        return ""
    n, m = part.denominator, part.numerator
    loads = [load for load in LOADS_OF if load.startswith(named) or named.startswith(load)]
    places = [tuple(range(k, k + m)) for k in range(n - m + 1)]
    with np.errstate(all="ignore"):
        for scheme in (*COMMON.values(), *EXPLICIT.values()):
            if "com-world" not in scheme.coordinates:
                continue
            lanes = [(load, where) for load in loads for where in (*places, ())]
            for run in shown:
                lanes = _made(run, scheme, n, lanes, float(part))
                if not lanes:
                    break
            alone = {where for _, where in lanes}
            if lanes and len(alone) == 1 and alone != {()}:
                where = next(iter(alone))
                return f"{named} acts in {_which(where, n)} of {NUMBERS[n]} substeps alone"
    return ""


def _which(where: tuple[int, ...], n: int) -> str:
    m = len(where)
    if m == 1:
        return f"the {'last' if where[0] == n - 1 and n > 1 else WHICH[where[0]]}"
    if where[0] == 0:
        return f"the first {NUMBERS[m]}"
    return f"the last {NUMBERS[m]}" if where[-1] == n - 1 else f"the {WHICH[where[0]]} and next"


Lane = tuple[str, tuple[int, ...]]
LOADS_OF = tuple(name for name in TERMS if name.startswith(LOADS))


def _made(run: KeptRun, scheme: Scheme, n: int, lanes: Sequence[Lane], part: float) -> list[Lane]:
    """Those by which every interval of a run leads from its sample to the next."""
    own = SchemeOf(scheme, "com-world")
    motions = [_motion(run, own, lanes, k, part) for k in range(n)]

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        for one in motions:
            q, v = scheme.step(one, q, v, h / n)
        return q, v

    by = SchemeOf(replace(scheme, step=step), "com-world")
    good = np.all(run.reached(run.ends(by, body_motion(run.system), len(lanes))), axis=-1)
    return [lane for lane, fits in zip(lanes, good, strict=True) if fits]


def _motion(
    run: KeptRun, own: SchemeOf, lanes: Sequence[Lane], substep: int, part: float
) -> Motion:
    """With the share of each load in one substep, by lanes."""
    names = dict.fromkeys(name for load in LOADS_OF for name in TERMS[load][0])
    factors: dict[str, Array] = {
        name: np.array([_share(name, lane, substep, part) for lane in lanes])[:, None, None]
        for name in names
    }
    return with_factors(run.system, own, _whole(factors))


def _share(name: str, lane: Lane, substep: int, part: float) -> float:
    load, where = lane
    if name not in TERMS[load][0]:
        return 1.0
    return part if not where else float(substep in where)


def _whole(factors: Mapping[str, Array]) -> dict[str, Array]:
    one = np.ones((1, 1, 1))
    return {**dict.fromkeys(("gyroscopic", "force", "turn", "move"), one), **factors}
