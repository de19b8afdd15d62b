"""Causes that were found on some scenarios, tried on the next before it is searched to the end."""

from __future__ import annotations

from collections.abc import Sequence

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.held import Held, Scene, Scenes
from omegadot.diagnosis.equations.worded import Named, conditional, worded


class Carried:
    """What was found so far by searching to the end, by source of evidence."""

    def __init__(self, scenes: Scenes) -> None:
        self._scenes = scenes
        self._strong: list[list[Candidate]] = []
        self._weak: dict[str, list[Held]] = {}
        self._partly: dict[str, list[tuple[Held, str]]] = {}

    def keep(self, strong: Sequence[Held]) -> None:
        """Candidates that hold on all scenarios, and explain one."""
        self._strong.append([one.candidate for one in strong])

    def strong(self, scene: Scene, source: str) -> Named:
        """What was found on another scenario, if it fits this one and holds on all."""
        evidence = scene.evidence[source]
        for group in self._strong:
            fits = [one for one in (one.fitting(evidence) for one in group) if one]
            held = [self._scenes.held(one, scene, source) for one in fits]
            whole = [one for one in held if one.holds and one.strong]
            text = worded(whole, source, self._scenes)
            if text:
                return Named(text, whole[0].candidate)
        return Named()

    def partly(self, scene: Scene, source: str) -> str:
        """What was found to hold on scenarios of one kind alone, this one among them."""
        known = (text for one, text in self._partly.get(source, ()) if scene.name in one.names)
        return next(known, "")

    def weak(self, scene: Scene, source: str, found: Sequence[Held]) -> Named:
        """What fits by numbers that are others on each scenario, with those of the first.

        found: of this scenario; the first to be found is named on all that it fits.
        """
        known = self._weak.setdefault(source, [])
        for one in known:
            fitted = one.candidate.fitting(scene.evidence[source])
            if fitted and scene.name in one.names:
                return Named(worded([one], source, self._scenes), fitted)
        text = worded(found, source, self._scenes)
        if not text:
            return Named()
        if found[0].candidate.numbers is not None:
            known.append(found[0])
        return Named(text, found[0].candidate)

    def conditional(self, source: str, partial: Sequence[Held]) -> Named:
        """The first that holds on the scenarios of one kind alone, by other numbers maybe."""
        text = conditional(partial, own=True)
        first = [one for one in partial if text and conditional([one], own=True) == text]
        self._partly.setdefault(source, []).extend((one, text) for one in first[:1])
        return Named(text)
