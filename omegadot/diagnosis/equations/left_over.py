"""What an engine keeps of a system that it was loaded with before: answers right for neither."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.all_kept import KEPT
from omegadot.diagnosis.equations.equation_form import accelerations
from omegadot.diagnosis.equations.evidence import INVERSE, INVERTED, Evidence
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.kept_parts import Kept
from omegadot.harness.loaded_before import LoadedBefore
from omegadot.reference_impl.system import Acceleration, Array

FEW = 6  # states at which everything is tried
MOST_NAMED = 3  # between which nothing decides
OTHER = 1e-6  # relative: values that are two


@dataclass(frozen=True)
class _Seen:
    """The answers of one scenario, and what had been loaded before it."""

    where: tuple[str, str]
    evidence: Evidence
    before: LoadedBefore

    def explained(self, one: Kept, few: bool = False) -> bool | None:
        """Whether something kept makes these answers; None where it changes nothing in them.

        False also of right answers that it would make wrong.
        """
        evidence = self.evidence.few(FEW) if few else self.evidence
        made = self.made(one, evidence)
        if made is None:
            return False if evidence.clear else None
        if evidence.fits(made):
            return True if evidence.clear else None
        return False if evidence.clear or evidence.visible(made) else None

    def made(self, one: Kept, evidence: Evidence) -> Acceleration | None:
        """What it gives; None where it keeps nothing that differs."""
        try:
            form = one.form(evidence.system, self.before)
        except (ValueError, np.linalg.LinAlgError):
            return None
        if form is None:
            return None
        found = accelerations(form, evidence.states)
        return found if evidence.visible(found) else None


class LeftOver:
    """Of one engine: the answers so far, and the one thing that it keeps, if that makes them all.

    What is kept must have two values, or the same system must be right after another: a wrong
    constant is no other system's.
    """

    def __init__(self) -> None:
        self._seen = dict[tuple[str, str], _Seen]()
        self._found: tuple[str, frozenset[tuple[str, str]]] | None = None

    def add(self, scene: Scene) -> None:
        """One more scenario; what was found before may not hold any more."""
        for source, evidence in scene.evidence.items():
            before = scene.loaded_before(source)
            if source not in (INVERSE, INVERTED) and before is not None and evidence.finite:
                where = (scene.name, source)
                self._seen[where] = _Seen(where, evidence, before)
        self._found = None

    def cause(self, name: str, source: str) -> str:
        """What is kept, if it makes the answers of this scenario; "" where nothing does."""
        if self._found is None:
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                self._found = _found(list(self._seen.values()))
        text, explained = self._found
        return text if (name, source) in explained else ""


def _found(seen: Sequence[_Seen]) -> tuple[str, frozenset[tuple[str, str]]]:
    """The text, and what it explains."""
    wrong = [one for one in seen if one.evidence.clear]
    after = [one for one in wrong if one.before.count]
    nothing = "", frozenset[tuple[str, str]]()
    if not wrong or len(after) < len(wrong):
        return nothing
    # a few states may show nothing of what is wrong at others
    likely = [k for k in KEPT if all(one.explained(k, few=True) is not False for one in wrong)]
    kept = [k for k in likely if _holds(k, seen, wrong)]
    text = worded_kept(kept)
    if not text:
        return nothing
    return text, frozenset(one.where for one in wrong)


def worded_kept(kept: Sequence[Kept]) -> str:
    """The plainest of these; "" where too many are left that nothing decides between."""
    least = min((len(k.part.attributes) for k in kept), default=0)
    every = {k.text for k in kept}
    kept = [k for k in kept if not every & {*k.plainer}]
    kept = [k for k in kept if len(k.part.attributes) == least]
    texts = list(dict.fromkeys(k.text for k in kept))
    if len({k.what for k in kept}) == 1 and len(texts) > 1:
        keys = {k.key for k in kept}
        texts = [kept[0].vague(keys.pop() if len(keys) == 1 else "")]
    if not 1 <= len(texts) <= MOST_NAMED:
        return ""
    return texts[0] if len(texts) == 1 else "either " + ", or ".join(texts)


def _holds(one: Kept, seen: Sequence[_Seen], wrong: Sequence[_Seen]) -> bool:
    """Whether it makes all that is wrong and nothing else, and no constant does."""
    if any(s.explained(one) is False for s in seen):
        return False
    right = [s.evidence.system for s in seen if np.all(s.evidence.sound)]
    if any(s.evidence.system is system for s in wrong for system in right):
        return True
    values = [one.value(s.evidence.system, s.before) for s in wrong]
    if one.lasting:  # the numbers of one system, of which no other constant has several
        return bool(np.count_nonzero(values[0]) > 1)
    return any(_differ(values[0], other) for other in values[1:])


def _differ(one: Array, other: Array) -> bool:
    size = max(float(np.max(np.abs(one))), float(np.max(np.abs(other))))
    return bool(np.max(np.abs(one - other)) > OTHER * size)
