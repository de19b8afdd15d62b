"""Steps that take an old number on the scenarios of one kind alone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.slips.old_operands import (
    EXPLAINS,
    LEAST_RUNS,
    Lane,
    acting_on,
    lanes_of,
    made_of,
    shown_by,
    texts_of,
)
from omegadot.diagnosis.wording.features import features_of, in_common

SCENARIOS = 2  # at least, whose runs show it
MOST_NAMED = 2  # conditions, of which nothing decides


def old_operands_where(
    by: SchemeOf, chosen: Sequence[KeptRun], runs: Sequence[KeptRun]
) -> list[str]:
    """The old operand that makes nearly every run that fails, with where alone it acts.

    chosen: of these runs those that fail are stepped.  runs: all.  None without a condition, which
    sorts the scenarios that fail from those that are sound and would show it.
    """
    shows, lanes = shown_by(by, chosen), lanes_of(by)
    failing = {run.name: run for run in shows}
    if len(shows) < LEAST_RUNS or len(failing) < SCENARIOS or not lanes:
        return []
    made = Counter[Lane]()
    for run in shows:
        acting = acting_on(run.system)
        made.update(made_of(run, by, [lane for lane in lanes if lane[0] in acting]))
        if run is shows[LEAST_RUNS - 1] and not made:
            return []
    most = max(made.values(), default=0)
    best = [lane for lane in lanes if made[lane] == most]
    if most < EXPLAINS * len(shows) or len(texts_of(best)) != 1:
        return []
    names = {run.name for run in runs if run.fails}
    sound = {run.name: run.short for run in runs if run.name not in names}
    lane = best[0]
    there = [run for run in sound.values() if lane[0] in acting_on(run.system)]
    against = [run for run in there if not made_of(run, by, [lane])]
    wrong, right = (
        [features_of(run.system, run.state[0]) for run in group]
        for group in (failing.values(), against)
    )
    common = in_common(wrong, right)
    if not 0 < len(common) <= MOST_NAMED:
        return []
    return [f"{texts_of([lane])[0]}, but only where {' or where '.join(common)}"]
