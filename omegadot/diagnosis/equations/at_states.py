"""At which states an equation is wrong, over the scenarios of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import ALONG, FAR_FROM_ROUNDING, FORWARD, SLACK, Evidence
from omegadot.diagnosis.equations.held import Scene, Scenes
from omegadot.diagnosis.equations.searched import PLAIN, Searched
from omegadot.diagnosis.equations.worded import worded
from omegadot.diagnosis.wording.conditions import Part, only_where

APART, FEW = 2.0, 8  # times the widest gap between neighbours on a scale of powers; of so many
OF_STATES = (FORWARD, ALONG)  # answers at states, of one equation


class AtSomeStates:
    """Plain causes at the states at which an engine is wrong, where others are right.

    These are looked at of all scenarios together: few states of one fit much.
    """

    def __init__(self, scenes: Scenes) -> None:
        self._scenes = scenes
        self._wrong: dict[str, Searched] = {}  # by source: scenarios of the wrong states alone
        self._conditions: dict[tuple[tuple[str, ...], str], str] = {}
        self.acting: dict[tuple[str, str], Candidate] = {}  # by scenario and source: what is named

    def add(self, scene: Scene) -> None:
        """One more scenario."""
        for source, searched in self._wrong.items():
            _add_wrong(searched, scene, source)
        self._conditions = {}

    def cause(self, scene: Scene, source: str) -> str:
        """What acts at the wrong states, and which these are; "" where nothing plain does."""
        every = [s for s in self._scenes.by_name.values() if source in s.evidence]
        every = [s for s in every if s.evidence[source].finite]
        shown = [s for s in every if not np.all(s.evidence[source].sound)]
        if not any(np.any(s.evidence[source].sound) for s in shown):
            return ""
        if source not in self._wrong:
            self._wrong[source] = Searched(Scenes())
            for one in shown:
                _add_wrong(self._wrong[source], one, source)
        best = self._wrong[source].best(scene, source, PLAIN)
        where = {one.candidate.key: self._where(one.candidate, source) for one in best}
        sorted_ = [one for one in best if where[one.candidate.key]]
        text = worded(sorted_ or best, source, self._scenes)
        if not text:
            return ""
        self.acting[scene.name, source] = (sorted_ or best)[0].candidate
        if not sorted_:
            return f"{text}, but not always"
        return f"{text}, but only where {where[sorted_[0].candidate.key]}"

    def _where(self, one: Candidate, source: str) -> str:
        if (one.key, source) not in self._conditions:
            found = where_of(one, self._scenes.evidence(source))
            if not found and source in OF_STATES:  # few of one kind may show it
                every = [e for kind in OF_STATES for e in self._scenes.evidence(kind)]
                found = where_of(one, every)
            self._conditions[one.key, source] = found
        return self._conditions[one.key, source]


def _add_wrong(searched: Searched, scene: Scene, source: str) -> None:
    """The states of a scenario at which the engine is wrong, as a scenario of their own."""
    evidence = scene.evidence.get(source)
    if evidence is None or not evidence.finite or np.all(evidence.sound):
        return
    wrong = evidence.at(np.flatnonzero(~evidence.sound))
    searched.add(replace(scene, evidence={source: wrong}))


def where_of(one: Candidate, every: Sequence[Evidence]) -> str:
    """At which of the states that would show it a cause acts; "" where nothing sorts them."""
    parts, places = list[Part](), list[NDArray[np.intp]]()
    for evidence in every:
        made = one.predicted(evidence)
        if made is None:
            continue
        shows = np.flatnonzero(evidence.shares_between(made, evidence.true) > SLACK)
        parts.append((evidence.system, evidence.states[shows], evidence.sound[shows]))
        places.append(shows)
    return only_where(parts, places)


def where_wrong(evidence: Evidence, every: Sequence[Evidence]) -> str:
    """At which states the engine is wrong, whatever it is; of one scenario where few show it."""
    parts = [(e.system, e.states, e.sound) for e in every]
    places = [np.arange(len(e.sound)) for e in every]
    # where nothing of the kind acts, every state is right, and shows nothing
    shown = [part for part in parts if not np.all(part[2])]
    mixed = sum(bool(np.any(right)) for _, _, right in shown)
    if np.all(evidence.sound) or not mixed or any(map(_fades, every)):
        return ""
    alone = [(evidence.system, evidence.states, evidence.sound)]
    where = only_where(parts, places) or (only_where(shown) if mixed > 1 else "")
    return where or (only_where(alone) if len(shown) < 2 else "")


def _fades(evidence: Evidence) -> bool:
    """Whether what is wrong sinks into rounding: the states where it does are those of no limit.

    It does not where the least of it is so far from rounding that others would lie in between.
    """
    shares = evidence.shares(evidence.true)
    off = np.sort(np.log(shares[shares > 1.0]))
    if not len(off) or off[0] >= np.log(FAR_FROM_ROUNDING):
        return False
    return len(off) < FEW or bool(off[0] <= APART * np.max(np.diff(off)))
