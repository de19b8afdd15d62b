"""At which states an equation is wrong, over the scenarios of a run."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import FAR_FROM_ROUNDING, SLACK, Evidence
from omegadot.diagnosis.wording.conditions import only_where
from omegadot.reference_impl.system import State, System


def where_of(one: Candidate, every: Sequence[Evidence]) -> str:
    """At which of the states that would show it a cause acts; "" where nothing sorts them."""
    parts = list[tuple[System, State, NDArray[np.bool_]]]()
    for evidence in every:
        made = one.predicted(evidence)
        if made is None:
            continue
        shows = np.flatnonzero(evidence.shares_between(made, evidence.true) > SLACK)
        parts.append((evidence.system, evidence.states[shows], evidence.sound[shows]))
    return only_where(parts)


def where_wrong(evidence: Evidence, every: Sequence[Evidence]) -> str:
    """At which states the engine is wrong, whatever it is; of one scenario where few show it."""
    parts = [(e.system, e.states, e.sound) for e in every]
    # where nothing of the kind acts, every state is right, and shows nothing
    shown = [part for part in parts if not np.all(part[2])]
    mixed = sum(bool(np.any(right)) for _, _, right in shown)
    if np.all(evidence.sound) or not mixed or any(map(_fades, every)):
        return ""
    alone = [(evidence.system, evidence.states, evidence.sound)]
    where = only_where(parts) or (only_where(shown) if mixed > 1 else "")
    return where or (only_where(alone) if len(shown) < 2 else "")


def _fades(evidence: Evidence) -> bool:
    """Whether what is wrong sinks into rounding: the states where it does are those of no limit."""
    shares = evidence.shares(evidence.true)
    return bool(np.any((shares > 1.0) & (shares < FAR_FROM_ROUNDING)))
