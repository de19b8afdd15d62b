"""Formulas of one engine over all scenarios of a run: the plainest that holds on every one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product as pairs_of

import numpy as np

from omegadot.diagnosis.equations.candidate import FORMULAS, Candidate
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.formula import AnyFormula, Together, formulas
from omegadot.diagnosis.equations.held import Held, Scene, Scenes
from omegadot.diagnosis.equations.worded import conditional
from omegadot.reference_impl.system import Array

MOST_HELD, MOST_PAIRED = 16, 3
CONDITION = 1.5  # what a condition costs


@dataclass(frozen=True)
class ByFormula:
    """whole: hold everywhere.  partly: hold where they show, and other scenarios are sound.

    own: hold everywhere by a factor of its own on each.  along: what all that is added is along,
    whatever its size; "" where it is along nothing known.
    """

    whole: tuple[Held, ...] = ()
    partly: tuple[Held, ...] = ()
    own: tuple[Held, ...] = ()
    along: str = ""
    hopeless: bool = False  # nothing is along it, which more scenarios do not change


def by_formula(scenes: Scenes, source: str, before: ByFormula | None = None) -> ByFormula:
    """What may be named on the scenarios with evidence of this source.

    before: of some of these scenarios.
    """
    known = [s for s in scenes.by_name.values() if source in s.evidence]
    failing = [s for s in known if s.evidence[source].clear]
    if before is not None and before.hopeless:
        return before
    for one in before.whole if before is not None else ():
        held = scenes.held(one.candidate, one.shown[0], source)
        if not (held.contradicted or held.numbers or held.against):
            return ByFormula((held,), before.partly if before is not None else ())
    partly, own = list[Held](), list[Held]()
    every = [s.evidence[source] for s in failing]
    others = [e for s in failing for e in s.scaled.values()] if source == "forward" else []
    angular = formulas(every, others)
    linear = formulas(every, others, linear=True)
    for candidate, scene in _candidates(failing, source, angular.found, linear.found):
        held = scenes.held(candidate, scene, source)
        if held.contradicted:
            continue
        if held.numbers and not held.law:
            own += [] if held.against else [held]
        elif held.against:
            partly.append(held)
        elif not any(_plainer(one, held) and conditional([one]) for one in partly):
            return ByFormula((held,), tuple(partly))
    hopeless = angular.hopeless or linear.hopeless
    return ByFormula((), tuple(partly), tuple(own[:1]), angular.along, hopeless)


class Formulas:
    """By source of evidence, worked out when they are first needed; of fewer scenarios before."""

    def __init__(self, scenes: Scenes) -> None:
        self._scenes = scenes
        self._known: dict[str, ByFormula] = {}
        self._before: dict[str, ByFormula] = {}

    def add(self) -> None:
        """One more scenario; what was found before may not hold any more."""
        self._before |= self._known
        self._known = {}

    def of(self, source: str) -> ByFormula:
        """Those of all scenarios so far."""
        if source not in self._known:
            self._known[source] = by_formula(self._scenes, source, self._before.get(source))
        return self._known[source]

    def along(self, source: str) -> str:
        """What all that is added is along; "" where nothing is, or has not been looked for."""
        return self._known[source].along if source in self._known else ""


def _plainer(one: Held, other: Held) -> bool:
    """Whether one that holds under a condition is likelier than another that holds everywhere."""
    costs = [
        x.candidate.terms.cost for x in (one, other) if isinstance(x.candidate.terms, FORMULAS)
    ]
    return len(costs) == 2 and costs[0] + CONDITION < costs[1]


def _candidates(
    failing: Sequence[Scene],
    source: str,
    angular: Sequence[AnyFormula],
    linear: Sequence[AnyFormula],
) -> Iterator[tuple[Candidate, Scene]]:
    """Each with its factor, and a scenario that it fits."""
    singles = sorted([*angular[:MOST_HELD], *linear[:MOST_HELD]], key=lambda one: one.cost)
    both = [Together(a, b) for a, b in pairs_of(angular[:MOST_PAIRED], linear[:MOST_PAIRED])]
    for one in (*singles, *both):
        seen = [s for s in failing if _shows(one, s.evidence[source])]
        if not seen:
            continue
        p = one.factor([s.evidence[source] for s in seen])
        candidate = Candidate(terms=one, numbers=p)
        fits = next((s for s in seen if _fits(candidate, s.evidence[source])), None)
        if fits is not None:
            yield candidate, fits
            continue
        for scene in seen:
            own: Array | None = one.fit(scene.evidence[source])
            if own is not None:
                yield Candidate(terms=one, numbers=own), scene
                break


def _shows(one: AnyFormula | Together, evidence: Evidence) -> bool:
    line = one.made(evidence, one.ones)
    return bool(np.all(np.isfinite(line.angular))) and evidence.visible(line)


def _fits(one: Candidate, evidence: Evidence) -> bool:
    made = one.predicted(evidence)
    return made is not None and one.fits(evidence, made)
