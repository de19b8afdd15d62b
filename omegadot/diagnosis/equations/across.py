"""One engine's wrong equation over all scenarios of a run: what holds on every one of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, same_form
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.held import Held, Scene, Scenes
from omegadot.diagnosis.equations.search import Candidate, levels
from omegadot.diagnosis.wording.conditions import LEAST, only_where
from omegadot.diagnosis.wording.features import in_common

QUICK = 3  # levels of one scenario that are quick, and more basic than what another has shown
MOST_DEEP = 5  # scenarios that are searched to the end; the rest have what these have
MOST_NAMED = 3  # causes between which a scenario does not decide


class _Search:
    """Levels that are worked out when they are first needed, and kept."""

    def __init__(self, source: Iterator[list[Candidate]]) -> None:
        self._source, self._known = source, list[list[Candidate]]()

    def levels(self) -> Iterator[list[Candidate]]:
        """All of them, from the first."""
        yield from self._known
        for level in self._source:
            self._known.append(level)
            yield level


class Across:
    """The scenarios of one engine so far, and the causes found among them."""

    def __init__(self) -> None:
        self._all = Scenes()
        # by integrator and scenario: each cause alone explains the runs; whether they are decisive
        self.of_runs: dict[str, dict[str, tuple[tuple[str, ...], bool]]] = {}
        # by integrator and scenario, whether a run fails
        self.fails: dict[str, dict[str, bool]] = {}
        # by integrator, what shows where two answers to one request differ
        self.again: dict[str, str] = {}
        self._accepted: list[list[Candidate]] = []
        self._weak: list[Candidate] = []
        self._texts: dict[tuple[str, str], str] = {}
        self._chosen: dict[tuple[str, str], Candidate] = {}
        self._searches: dict[tuple[str, str], _Search] = {}

    @property
    def scenes(self) -> dict[str, Scene]:
        """By name."""
        return self._all.by_name

    def chosen(self, name: str, source: str) -> Candidate | None:
        """The first of the candidates that `cause` names; None where it names none."""
        self.cause(name, source)
        return self._chosen.get((name, source))

    def add(self, scene: Scene) -> None:
        """One more scenario; what was found before may not hold any more."""
        self.scenes[scene.name] = scene
        self._accepted, self._weak, self._texts, self._chosen = [], [], {}, {}

    def cause(self, name: str, source: str) -> str:
        """The cause on one scenario; "" where nothing fits, or nothing that holds elsewhere."""
        if (name, source) not in self._texts:
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                self._texts[name, source] = self._cause(name, source)
        return self._texts[name, source]

    def _cause(self, name: str, source: str) -> str:
        scene = self.scenes[name]
        if not scene.evidence[source].clear:
            return ""
        conditional, weak = list[Held](), ""
        weakest: Candidate | None = None
        for number, level in enumerate(self._search(scene, source)):
            if number == QUICK:
                self._search_elsewhere(name, source)
                text = self._known_elsewhere(scene, source)
                if text:
                    return text
            held = [self._all.held(one, scene, source) for one in _distinct(level)]
            whole = [one for one in held if one.holds]
            strong = [one for one in whole if one.strong]
            least = min((len(one.against) for one in strong), default=0)
            strong = [one for one in strong if len(one.against) == least]
            text = self._worded(strong, source)
            if text:
                self._accepted.append([one.candidate for one in strong])
                self._chosen[name, source] = strong[0].candidate
                return text
            if whole and not weak:
                weak = self._worded(whole, source)
                weakest = whole[0].candidate
            conditional += [one for one in held if not one.contradicted]
            if number == 0:
                text = self._conditional(conditional)
                if text:
                    return text
        if not weak:
            weakest, weak = self._weak_elsewhere(scene, source)
        elif weakest is not None and weakest.numbers is not None:
            self._weak.append(weakest)
        if weak and weakest is not None:
            self._chosen[name, source] = weakest
            return weak
        return self._at_some_states(scene, source) or self._conditional(conditional)

    def _weak_elsewhere(self, scene: Scene, source: str) -> tuple[Candidate | None, str]:
        """What was found on another scenario by numbers that are others on each."""
        evidence = scene.evidence[source]
        for one in self._weak:
            fitted = _fitting(one, evidence)
            held = self._all.held(fitted, scene, source) if fitted else None
            text = self._worded([held], source) if held and held.holds else ""
            if text:
                return fitted, text
        return None, ""

    def _search_elsewhere(self, name: str, source: str) -> None:
        """For a scenario that is not searched to the end: the causes of those that are."""
        searched = list(self._searches)
        if (name, source) not in searched[:MOST_DEEP]:
            for other, same in searched[:MOST_DEEP]:
                if same == source and (other, same) not in self._texts and other != name:
                    self.cause(other, source)

    def _known_elsewhere(self, scene: Scene, source: str) -> str:
        """What was found on another scenario, if it fits this one and holds on all."""
        evidence = scene.evidence[source]
        for group in self._accepted:
            fits = [one for one in (_fitting(one, evidence) for one in group) if one]
            held = [self._all.held(one, scene, source) for one in fits]
            whole = [one for one in held if one.holds and one.strong]
            text = self._worded(whole, source)
            if text:
                self._chosen[scene.name, source] = whole[0].candidate
                return text
        return ""

    def _search(self, scene: Scene, source: str) -> Iterator[list[Candidate]]:
        """The levels of one scenario, each worked out once; the deep ones of a few alone."""
        key = (scene.name, source)
        if key not in self._searches:
            deep = len(self._searches) < MOST_DEEP
            self._searches[key] = _Search(levels(scene.evidence[source], deep))
        return self._searches[key].levels()

    def _at_some_states(self, scene: Scene, source: str) -> str:
        """Where the equation holds at some states: what fits the others, and which these are."""
        evidence = scene.evidence[source]
        wrong = np.flatnonzero(~evidence.sound)
        every = [e for one in self.scenes.values() if (e := one.evidence.get(source))]
        parts = [(e.system, e.states, e.sound) for e in every]
        # where nothing of the kind acts, every state is right, and shows nothing
        shown = [part for part in parts if not np.all(part[2])]
        mixed = sum(bool(np.any(right)) for _, _, right in shown)
        if not len(wrong) or not mixed:
            return ""
        alone = [(evidence.system, evidence.states, evidence.sound)]
        few = sum(not np.all(right) for _, _, right in parts) < 2
        where = only_where(parts) or (only_where(shown) if mixed > 1 else "")
        where = where or (only_where(alone) if few else "")
        if not where:
            return ""
        text = f"the equation holds at some states, and is wrong only where {where}"
        if len(wrong) >= LEAST:
            there = evidence.at(wrong)
            for level in islice(levels(there, deep=False), 2):
                texts = list(dict.fromkeys(one.text(evidence.system) for one in level))
                if 0 < len(texts) <= MOST_NAMED:
                    return f"{text}; there, {' or '.join(texts)}"
        return text

    def _worded(self, whole: Sequence[Held], source: str) -> str:
        """Causes that hold everywhere; several where no scenario decides between them."""
        texts, forms = list[str](), list[tuple[set[str], Form]]()
        for held in whole:
            one = held.candidate
            system = held.shown[0].evidence[source].system
            plain = one.reading is None and one.terms is None
            form = one.form(system) if plain else None
            if form is not None and any(
                same_form(form, other) and one.parts == parts for parts, other in forms
            ):
                continue
            forms += [(one.parts, form)] if form is not None else []
            texts.append(held.law or one.text(system) + held.where())
        texts = list(dict.fromkeys(texts))
        if not texts or len(texts) > MOST_NAMED:
            return ""
        return texts[0] if len(texts) == 1 else "either " + ", or ".join(texts)

    def _conditional(self, held: Sequence[Held]) -> str:
        """The first cause that holds on the scenarios of one kind alone."""
        for one in held:
            shown, against = (
                [scene.features for scene in group] for group in (one.shown, one.against)
            )
            common = in_common(shown, against)
            if common and len(common) <= 2:
                evidence = next(iter(one.shown[0].evidence.values()))
                text = one.candidate.text(evidence.system)
                return f"{text}, but only where {' or where '.join(common)}"
        return ""


def _fitting(one: Candidate, evidence: Evidence) -> Candidate | None:
    """A candidate with its own numbers or with those of another scenario, where it fits there."""
    made = one.predicted(evidence)
    if made is not None and one.fits(evidence, made):
        return one
    return one.refitted(evidence)


def _distinct(level: Sequence[Candidate]) -> list[Candidate]:
    return list({one.key: one for one in level}.values())
