"""One engine's wrong equation over all scenarios of a run: what holds on every one of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, same_form
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families import Family
from omegadot.diagnosis.equations.hypotheses import wrong_form
from omegadot.diagnosis.equations.search import Candidate, levels, possible
from omegadot.diagnosis.wording.conditions import LEAST, only_where
from omegadot.diagnosis.wording.features import Features, in_common
from omegadot.diagnosis.wording.laws import law_of
from omegadot.reference_impl.system import Array, Body, System

QUICK = 3  # levels of one scenario that are quick, and more basic than what another has shown
MOST_DEEP = 5  # scenarios that are searched to the end; the rest have what these have
MOST_NAMED = 3  # causes between which a scenario does not decide
TELLING = 1e-5  # relative: what a number must be known to
LAWS = {
    "damping": "the damping",
    "gravity": "gravity",
    "torque_body": "the torque in body axes",
    "torque_world": "the torque in world axes",
    "pivot": "the pivot",
    "mass": "the mass in the dynamics",
}


@dataclass(frozen=True)
class Scene:
    """What is kept of one scenario. evidence: by where it comes from.  held: the body read
    back.
    """

    name: str
    system: System
    features: Features
    evidence: dict[str, Evidence]
    held: Body | None = None


@dataclass
class Held:
    """A candidate held against the other scenarios.

    shown: those where it can be seen and fits.  against: where it could be seen, and the engine is
    right.  pairs: of a family's numbers, requested and acting.  numbers: by scenario, where they
    had to be others; with these the candidate fits no two of them.
    """

    candidate: Candidate
    shown: list[Scene] = field(default_factory=list)
    against: list[Scene] = field(default_factory=list)
    contradicted: bool = False
    pairs: list[tuple[Array, Array]] = field(default_factory=list)
    numbers: list[tuple[Scene, Array]] = field(default_factory=list)
    law: str = ""

    @property
    def strong(self) -> bool:
        """Whether one rule gives its numbers on every scenario."""
        return not self.numbers or bool(self.law)

    @property
    def holds(self) -> bool:
        """Whether no scenario is against it; numbers may be others, and right, elsewhere."""
        return not self.contradicted and (not self.against or self.candidate.family is not None)

    def where(self) -> str:
        """Of numbers that act on some scenarios alone: on which."""
        if not self.against or self.pairs:
            return ""
        shown, against = ([one.features for one in group] for group in (self.shown, self.against))
        common = in_common(shown, against)
        if common and len(common) <= 2:
            return f", but only where {' or where '.join(common)}"
        if self.numbers:
            return ""  # what is seen elsewhere is not by these
        return f", on {len(shown)} of the {len(shown) + len(against)} scenarios that would show it"


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
        self.scenes: dict[str, Scene] = {}
        self.of_runs: dict[str, dict[str, str]] = {}  # by integrator and scenario
        self._accepted: list[list[Candidate]] = []
        self._weak: list[Candidate] = []
        self._texts: dict[tuple[str, str], str] = {}
        self._chosen: dict[tuple[str, str], Candidate] = {}
        self._with_another: dict[tuple[tuple[str, ...], str, str], bool] = {}
        self._searches: dict[tuple[str, str], _Search] = {}

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
            held = [self._held(one, scene, source) for one in _distinct(level)]
            whole = [one for one in held if one.holds]
            strong = [one for one in whole if one.strong]
            strong = [one for one in strong if not one.against] or strong
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
        elif weakest is not None and weakest.family is not None:
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
            held = self._held(fitted, scene, source) if fitted else None
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
            held = [self._held(one, scene, source) for one in fits]
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
        if not 0 < len(wrong) < len(evidence.sound):
            return ""
        every = [e for one in self.scenes.values() if (e := one.evidence.get(source))]
        parts = [(e.system, e.states, e.sound) for e in every]
        alone = [(evidence.system, evidence.states, evidence.sound)]
        few = sum(not np.all(right) for _, _, right in parts) < 2
        where = only_where(parts) or (only_where(alone) if few else "")
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

    def _held(self, one: Candidate, scene: Scene, source: str) -> Held:
        """A candidate against every other scenario with evidence of the same source."""
        held = Held(one, [scene])
        for other in self.scenes.values():
            evidence = other.evidence.get(source)
            if other is scene or evidence is None or not evidence.finite:
                continue
            if held.contradicted:
                break
            tried = held.candidate.predicted(evidence)
            if tried is None:
                continue
            if evidence.fits(tried):
                if evidence.visible(tried):
                    held.shown.append(other)
                continue
            if one.numbers is not None and evidence.clear:
                self._with_own_numbers(held, other, source)
            elif not evidence.visible(tried):
                continue
            elif bool(np.all(evidence.sound)):
                held.against.append(other)
            elif evidence.clear:
                held.contradicted |= not self._explained(one, other, source)
        if one.family is not None and one.family.name in LAWS and not one.fixed:
            held.pairs = self._numbers(one.family, source)
            if held.pairs:
                law = law_of(held.pairs, LAWS[one.family.name], one.family.unit)
                held.law = law
        own = one.numbers
        if held.numbers and not held.law and one.family is not None and own is not None:
            known = [(s.features, s.evidence[source].system, p) for s, p in held.numbers]
            known.append((scene.features, scene.evidence[source].system, own))
            held.law = one.family.law(known) if one.family.law else ""
        return held

    def _with_own_numbers(self, held: Held, other: Scene, source: str) -> None:
        """Numbers of another scenario: the same where these fit here too, and known better there.

        What is known of them is what fits, on either side.
        """
        there = held.candidate.refitted(other.evidence[source])
        if there is None:
            held.contradicted = True
            return
        back = [one.evidence[source] for one in held.shown]
        tried = [(one, there.predicted(one)) for one in back]
        if all(made is not None and one.fits(made) for one, made in tried):
            held.candidate = there
        elif there.numbers is not None:
            held.numbers.append((other, there.numbers))
        held.shown.append(other)

    def _explained(self, one: Candidate, other: Scene, source: str) -> bool:
        """Whether a scenario shows this and one more thing that is wrong; worked out once."""
        key = (one.key, other.name, source)
        if key not in self._with_another:
            self._with_another[key] = _with_another(one, other.evidence[source])
        return self._with_another[key]

    def _numbers(self, family: Family, source: str) -> list[tuple[Array, Array]]:
        """Requested and acting numbers of a family, on every scenario that has them."""
        found = list[tuple[Array, Array]]()
        for scene in self.scenes.values():
            evidence = scene.evidence.get(source)
            if evidence is None or not family.starts(evidence.system):
                continue
            right = family.right(evidence.system)
            more = Candidate((), family, right * (1.0 + TELLING)).predicted(evidence)
            if evidence.fits(evidence.true) and (more is None or not evidence.visible(more)):
                continue  # it shows nothing of these numbers
            one = Candidate((), family, right).refitted(evidence)
            if one is not None and one.numbers is not None:
                found.append((right, one.numbers))
        return found

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
    if made is not None and evidence.fits(made):
        return one
    return one.refitted(evidence)


def _with_another(one: Candidate, evidence: Evidence) -> bool:
    """Whether a scenario shows this and one more thing that is wrong."""
    if one.reading is not None or one.terms is not None:
        return False
    known = [h for h in possible(evidence) if h.part not in one.parts]
    made = [wrong_form((*one.fixed, h), evidence.system) for h in known]
    return bool(evidence.fitting(made))


def _distinct(level: Sequence[Candidate]) -> list[Candidate]:
    return list({one.key: one for one in level}.values())
