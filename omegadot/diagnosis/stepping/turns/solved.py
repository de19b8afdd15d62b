"""How far an implicit scheme's equation is solved: after how many iterations, or to what change.

From every sample the step's equation is iterated, and the iterate that is the next sample is found.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.turns.iterates import BY_CAYLEY, MOST, Iterates, iterates
from omegadot.diagnosis.wording.digits import limits, number
from omegadot.reference_impl.coordinates import Coordinates, canonical
from omegadot.written import written

MIDPOINT = "implicit-midpoint"
TURNS = (BY_CAYLEY, "by the exponential")
MOST_RUNS = 8
LEAST = 3  # intervals that show it
KINDS = {
    "fixed-point": "from the velocities of its start",
    "fixed-point ": "from the explicit step",
    "Newton": "from the velocities of its start",
    "Newton ": "from the explicit step",
    "simplified Newton": "from the velocities of its start",
    "simplified Newton ": "from the linearised step",
}


def solved_causes(by: SchemeOf | None, runs: Sequence[KeptRun], declared: bool) -> list[str]:
    """The iteration that stops too early, in every step; none where none is seen.

    Of a scheme that is not declared the midpoint rule is tried with both its turns.
    """
    known = by is not None and by.scheme.name == MIDPOINT
    ways = [way for way in TURNS if not declared or (known and way == BY_CAYLEY)]
    coordinates = by.coordinates if by is not None and known else "com-world"
    single = [run.short for run in runs if run.sweep.every == 1]
    chosen = sorted(single, key=lambda run: not run.fails)[:MOST_RUNS]
    if not any(run.fails for run in chosen):
        return []
    with np.errstate(all="ignore"):
        for way in ways:
            named = known and way == BY_CAYLEY
            for kind, guess in KINDS.items():
                found = _of_runs(chosen, coordinates, way, kind)
                text = _text(found, f"{kind.strip()} iterations {guess}", named) if found else ""
                if text:
                    whose = (
                        "the scheme's"
                        if named
                        else f"it is stepped by the implicit midpoint rule, which turns {way}; its"
                    )
                    return [f"{whose} equation is solved by {text}"]
    return []


def _of_runs(
    chosen: Sequence[KeptRun], coordinates: Coordinates, way: str, kind: str
) -> list[Iterates]:
    """None where an interval of a run is no iterate."""
    found = list[Iterates]()
    for run in chosen:
        own = canonical(run.system, coordinates)
        one = iterates(run, own, way, kind)
        if not np.all(np.any(one.matches, axis=0)):
            return []
        found.append(one)
    return found


def _text(found: Sequence[Iterates], how: str, named: bool) -> str:
    matches = np.concatenate([one.matches for one in found], axis=1)
    changes = np.concatenate([one.changes for one in found], axis=1)
    rate = np.concatenate([one.rate for one in found])
    count = matches.shape[1]
    first = np.argmax(matches, axis=0)  # the first that is the sample; later ones may be as well
    alone = ~matches[np.minimum(first + 1, MOST), np.arange(count)]
    if np.count_nonzero(alone & (first > 0)) < LEAST:
        return ""
    # one iteration from the start is an explicit scheme, which need not be meant as this one
    kind, _, guess = how.partition(" iterations ")
    for k in range(1 if named else 2, MOST):
        if np.all(matches[k]):
            times = f"one {kind} iteration" if k == 1 else f"{k} {kind} iterations"
            return f"{times} alone, {guess}"
    for size, unit in ((1.0, " rad/s"), (rate, " of omega")):
        moved = changes / size
        low = float(np.max(moved[first, np.arange(count)][alone]))
        before = moved[np.maximum(first - 1, 0), np.arange(count)][first > 1]
        high = float(np.min(before, initial=np.inf))
        if low < high < np.inf:
            plain = float(f"{high:.1g}")
            between = f"a limit between {limits(low, high, '')}"
            limit = number(plain) if low < plain <= high else between
            return (
                f"{kind} iterations {guess}, which end once omega changes by less than "
                f"{limit}{unit}"
            )
    fewest, most = int(np.min(first)), int(np.max(first))
    if fewest == most or np.count_nonzero(alone & (first > 1)) < LEAST:
        return ""
    left = changes[np.minimum(first + 1, MOST), np.arange(count)][alone]
    much = f"up to {written(float(np.max(left)), 2)} rad/s of omega is left"
    return f"{fewest} to {most} {kind} iterations {guess}, another number in some steps: {much}"
