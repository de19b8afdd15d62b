"""One engine's wrong equation over all scenarios of a run: what holds on every one of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from omegadot.diagnosis.equations.at_states import where_of, where_wrong
from omegadot.diagnosis.equations.by_formula import ByFormula, by_formula
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import INVERSE, Evidence
from omegadot.diagnosis.equations.held import Held, Scene, Scenes
from omegadot.diagnosis.equations.known import known_over
from omegadot.diagnosis.equations.search import levels
from omegadot.diagnosis.equations.worded import conditional, worded

PLAIN = 2  # levels of one scenario without limits: they fit all states, or those that are wrong
QUICK = 5  # levels that are quick, and more basic than what another scenario has shown
MOST_DEEP = 5  # scenarios that are searched to the end; the rest have what these have


@dataclass(frozen=True)
class _Level:
    """What holds on every scenario; what does by other numbers on each; what holds on some."""

    strong: Sequence[Held] = ()
    weak: Sequence[Held] = ()
    partial: Sequence[Held] = ()


NONE = _Level()


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
        self._accepted: list[list[Candidate]] = []
        self._weak: dict[str, list[Held]] = {}
        self._formulas: dict[str, ByFormula] = {}
        self._before: dict[str, ByFormula] = {}  # of fewer scenarios
        self._known: dict[str, str] = {}
        self._quick: dict[tuple[str, str, int], _Level] = {}
        self._nested: dict[str, Across] = {}
        self._explains: dict[tuple[str, str], set[str]] = {}
        self._partly: dict[str, list[tuple[Held, str]]] = {}
        self._conditions: dict[tuple[tuple[str, ...], str], str] = {}
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

    def explained(self, name: str, source: str) -> set[str]:
        """The scenarios that `chosen` explains."""
        self.cause(name, source)
        return self._explains.get((name, source), set()) | {name}

    def add(self, scene: Scene) -> None:
        """One more scenario; what was found before may not hold any more."""
        self.scenes[scene.name] = scene
        self._accepted, self._texts, self._chosen = [], {}, {}
        self._weak, self._quick = {}, {}
        for source, nested in self._nested.items():
            _add_wrong(nested, scene, source)
        self._conditions, self._partly, self._explains = {}, {}, {}
        self._before |= self._formulas
        self._formulas, self._known = {}, {}

    def cause(self, name: str, source: str) -> str:
        """The cause on one scenario; "" where nothing fits, or nothing that holds elsewhere."""
        if (name, source) not in self._texts:
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                self._texts[name, source] = self._cause(name, source)
        return self._texts[name, source]

    def plain(self, name: str, source: str) -> str:
        """A cause on one scenario that is quickly found; "" where none fits that holds on all."""
        scene = self.scenes[name]
        with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
            return self._shared(scene, source, QUICK) if scene.evidence[source].clear else ""

    def known(self, name: str, source: str) -> str:
        """What is seen of the scenarios on which nothing fits; "" on one that is hardly off."""
        if not self.scenes[name].evidence[source].clear:
            return ""
        if source not in self._known:
            every = [s for s in self.scenes.values() if source in s.evidence]
            off = [s for s in every if s.evidence[source].clear and not self.cause(s.name, source)]
            right = [s.features for s in every if np.all(s.evidence[source].sound)]
            along = self._formulas[source].along if source in self._formulas else ""
            with np.errstate(all="ignore"):
                self._known[source] = known_over(off, right, source, along)
        return self._known[source]

    def _cause(self, name: str, source: str) -> str:
        scene = self.scenes[name]
        if not scene.evidence[source].clear:
            return ""
        text = self._shared(scene, source, PLAIN)
        text = text or conditional(self._quick_of(scene, source, PLAIN).partial)
        if text:
            return text
        text = self._at_some_states(scene, source) or self._shared(scene, source, QUICK)
        if text:
            return text
        text = self._by_formula(scene, source)
        if text:
            return text
        quick = self._quick_of(scene, source, QUICK)
        self._search_elsewhere(name, source)
        text = self._known_elsewhere(scene, source)
        known = (t for one, t in self._partly.get(source, ()) if scene.name in one.names)
        text = text or next(known, "")
        if text:
            return text
        weak, partial = quick.weak, list(quick.partial)
        for number, level in enumerate(self._search(scene, source)):
            if number < QUICK:
                continue
            found = self._held(level, scene, source)
            text = self._text_of(found.strong, source)
            if text:
                self._accepted.append([one.candidate for one in found.strong])
                self._chosen[name, source] = found.strong[0].candidate
                return text
            weak = weak or found.weak
            partial += found.partial
        many = weak and weak[0].candidate.numbers is not None and len(weak[0].candidate.numbers) > 1
        own = [one for one in self._formulas[source].own if scene.name in one.names]
        weak = own if own and (many or not weak) else weak
        text = self._weak_cause(scene, source, weak) or self._where_wrong(scene, source)
        if not text:
            text = conditional(partial, own=True)
            named = [one for one in partial if text and conditional([one], own=True) == text]
            self._partly.setdefault(source, []).extend((one, text) for one in named[:1])
        return text

    def _held(self, level: Sequence[Candidate], scene: Scene, source: str) -> _Level:
        """What fits one scenario, held against all others."""
        held = [self._all.held(one, scene, source) for one in _distinct(level)]
        whole = [one for one in held if one.holds]
        strong = [one for one in whole if one.strong]
        least = min((len(one.against) for one in strong), default=0)
        strong = [one for one in strong if len(one.against) == least]
        partial = [one for one in held if not one.contradicted]
        return _Level(strong, [] if strong else whole, partial)

    def _quick_of(self, scene: Scene, source: str, depth: int) -> _Level:
        """The first of the quick levels of a scenario on which something holds everywhere."""
        key = (scene.name, source, depth)
        if key not in self._quick:
            before = self._quick_of(scene, source, PLAIN) if depth > PLAIN else NONE
            weak, partial, strong = before.weak, [*before.partial], before.strong
            for level in islice(self._search(scene, source), PLAIN * (depth > PLAIN), depth):
                if strong or conditional(partial):
                    break
                found = self._held(level, scene, source)
                weak, partial, strong = weak or found.weak, [*partial, *found.partial], found.strong
            self._quick[key] = _Level(strong, weak, partial)
        return self._quick[key]

    def _shared(self, scene: Scene, source: str, depth: int) -> str:
        """Of all that holds everywhere, on whichever scenario it was found: what explains the most.

        Between two that fit one scenario those decide that distinguish them.
        """
        best = self.best(scene, source, depth)
        text = self._text_of(best, source)
        if text:
            self._chosen[scene.name, source] = best[0].candidate
            self._explains[scene.name, source] = best[0].names
        return text

    def best(self, scene: Scene, source: str, depth: int) -> list[Held]:
        """Of what holds everywhere and explains this scenario, what explains the most."""
        wrong = [s for s in self.scenes.values() if source in s.evidence]
        wrong = [s for s in wrong if s.evidence[source].clear]
        found = [one for s in wrong for one in self._quick_of(s, source, depth).strong]
        here = [one for one in found if scene.name in one.names]
        most = max((len(one.shown) for one in here), default=0)
        return list({o.candidate.key: o for o in here[::-1] if len(o.shown) == most}.values())[::-1]

    def of_inverse_dynamics(self, name: str) -> str:
        """The formula of a wrong torque; "" where none holds on the whole run."""
        scene = self.scenes[name]
        if INVERSE not in scene.evidence or not scene.evidence[INVERSE].clear:
            return ""
        with np.errstate(all="ignore"):
            text = self._by_formula(scene, INVERSE)
        return f"inverse dynamics are wrong: {text}" * bool(text)

    def _by_formula(self, scene: Scene, source: str) -> str:
        """A product of known vectors that explains the whole run."""
        if source not in self._formulas:
            self._formulas[source] = by_formula(self._all, source, self._before.get(source))
        found = self._formulas[source]
        here = [one for one in found.whole if scene.name in one.names]
        partly = [] if here else [one for one in found.partly if scene.name in one.names]
        text = self._text_of(here, source) or conditional(partly)
        if text:
            first = here[0] if here else next(one for one in partly if conditional([one]) == text)
            self._chosen[scene.name, source] = first.candidate
            self._explains[scene.name, source] = first.names
        return text

    def _weak_cause(self, scene: Scene, source: str, weak: Sequence[Held]) -> str:
        """What fits by numbers that are others on each scenario, with those of the first."""
        evidence = scene.evidence[source]
        for one in self._weak.setdefault(source, []):
            fitted = fitting(one.candidate, evidence)
            if fitted and scene.name in one.names:
                self._chosen[scene.name, source] = fitted
                return self._text_of([one], source)
        text = self._text_of(weak, source)
        if text:
            self._chosen[scene.name, source] = weak[0].candidate
            if weak[0].candidate.numbers is not None:
                self._weak[source].append(weak[0])
        return text

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
            fits = [one for one in (fitting(one, evidence) for one in group) if one]
            held = [self._all.held(one, scene, source) for one in fits]
            whole = [one for one in held if one.holds and one.strong]
            text = self._text_of(whole, source)
            if text:
                self._chosen[scene.name, source] = whole[0].candidate
                return text
        return ""

    def _search(self, scene: Scene, source: str) -> Iterator[list[Candidate]]:
        """The levels of one scenario, each worked out once; the deep ones of a few alone."""
        key = (scene.name, source)
        if key not in self._searches:
            deep = len(self._searches) < MOST_DEEP
            self._searches[key] = _Search(
                levels(scene.evidence[source], deep, self._all.tried(scene, source))
            )
        return self._searches[key].levels()

    def _at_some_states(self, scene: Scene, source: str) -> str:
        """A plain cause at the states at which the engine is wrong, where others are right.

        These are looked at of all scenarios together: few states of one fit much.
        """
        every = [s for s in self.scenes.values() if source in s.evidence]
        every = [s for s in every if s.evidence[source].finite]
        shown = [s for s in every if not np.all(s.evidence[source].sound)]
        if not any(np.any(s.evidence[source].sound) for s in shown):
            return ""
        if source not in self._nested:
            self._nested[source] = Across()
            for one in shown:
                _add_wrong(self._nested[source], one, source)
        best = self._nested[source].best(scene, source, PLAIN)
        where = {one.candidate.key: self._where_of(one.candidate, source) for one in best}
        sorted_ = [one for one in best if where[one.candidate.key]]
        text = self._text_of(sorted_ or best, source)
        if not text:
            return ""
        condition = where[sorted_[0].candidate.key] if sorted_ else ""
        return (
            f"{text}: it is wrong only where {condition}"
            if condition
            else f"{text}, but not always"
        )

    def _text_of(self, whole: Sequence[Held], source: str) -> str:
        pivoted = any(s.system.load.pivot is not None for s in self.scenes.values())
        return worded(whole, source, pivoted)

    def _evidence(self, source: str) -> list[Evidence]:
        return [e for one in self.scenes.values() if (e := one.evidence.get(source))]

    def _where_of(self, one: Candidate, source: str) -> str:
        if (one.key, source) not in self._conditions:
            self._conditions[one.key, source] = where_of(one, self._evidence(source))
        return self._conditions[one.key, source]

    def _where_wrong(self, scene: Scene, source: str) -> str:
        """Where the equation holds at some states: at which it does not."""
        where = where_wrong(scene.evidence[source], self._evidence(source))
        return f"the equation holds at some states, and is wrong only where {where}" * bool(where)


def _add_wrong(nested: Across, scene: Scene, source: str) -> None:
    """The states of a scenario at which the engine is wrong, as a scenario of their own."""
    evidence = scene.evidence.get(source)
    if evidence is None or not evidence.finite or np.all(evidence.sound):
        return
    wrong = evidence.at(np.flatnonzero(~evidence.sound))
    nested.add(replace(scene, evidence={source: wrong}))


def fitting(one: Candidate, evidence: Evidence) -> Candidate | None:
    """A candidate with its own numbers or with those of another scenario, where it fits there."""
    made = one.predicted(evidence)
    if made is not None and one.fits(evidence, made):
        return one
    return one.refitted(evidence)


def _distinct(level: Sequence[Candidate]) -> list[Candidate]:
    return list({one.key: one for one in level}.values())
