"""A cause that fits one scenario, held against all others of the run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families import THREE_NUMBERS, Family
from omegadot.diagnosis.equations.tried import Tried
from omegadot.diagnosis.wording.features import Features, in_common
from omegadot.diagnosis.wording.implied import only_where
from omegadot.diagnosis.wording.laws import law_of, power_laws
from omegadot.harness.loaded_before import LoadedBefore
from omegadot.reference_impl.system import Array, Body, State, System

PRECISE = 1e-5  # relative: what a number must be known to
VECTORS = {  # what a factor of one vector may be the trace of
    "gravity": THREE_NUMBERS[0],
    "torque in body axes": THREE_NUMBERS[1],
    "torque in world axes": THREE_NUMBERS[2],
}
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
    """What is kept of one scenario.

    evidence: by where it comes from.  held: the body read back.  scaled: of forward dynamics, by
    what was doubled.  opposites: by source, of systems in which one thing is the other way.
    before: what the engine had been loaded with, by source where that is another than of all else
    (""); nothing where it is unknown.  states: one that was set, and what read back of it.
    limits: from which states steps were taken, and where those of no length lead; of any scheme.
    """

    name: str
    system: System
    features: Features
    evidence: dict[str, Evidence]
    held: Body | None = None
    scaled: Mapping[str, Evidence] = field(default_factory=dict)
    before: Mapping[str, LoadedBefore] = field(default_factory=dict)
    states: tuple[State, State] | None = None
    opposites: dict[str, list[tuple[Features, Evidence]]] = field(default_factory=dict)
    limits: list[tuple[State, State]] = field(default_factory=list)

    def loaded_before(self, source: str) -> LoadedBefore | None:
        """What had been loaded before the answers of a source; None where it is unknown."""
        return self.before.get(source, self.before.get(""))


@dataclass
class Held:
    """A candidate held against the other scenarios.

    shown: those where it can be seen and fits.  against: where it could be seen, and the engine is
    right.  pairs: of a family's numbers, requested and acting.  numbers: by scenario, where they
    had to be others; with these the candidate fits no two of them.
    """

    candidate: Candidate
    source: str
    shown: list[Scene] = field(default_factory=list)
    against: list[Scene] = field(default_factory=list)
    contradicted: bool = False
    pairs: list[tuple[Array, Array]] = field(default_factory=list)
    numbers: list[tuple[Scene, Array]] = field(default_factory=list)
    law: str = ""

    @property
    def names(self) -> set[str]:
        """The scenarios on which it fits."""
        return {scene.name for scene in self.shown}

    @property
    def strong(self) -> bool:
        """Whether one rule gives its numbers on every scenario, and it is no chance of one mass."""
        if self.candidate.by_mass and len({float(s.system.body.mass) for s in self.shown}) < 2:
            return False
        return not self.numbers or bool(self.law)

    @property
    def holds(self) -> bool:
        """Whether no scenario is against it; numbers may be others, and right, elsewhere."""
        return not self.contradicted and (not self.against or self.candidate.family is not None)

    def condition(self) -> str:
        """What holds of all scenarios that show it and of none of the others; "" without any."""
        shown, against = ([one.features for one in group] for group in (self.shown, self.against))
        common = in_common(shown, against)
        if common:
            common = in_common(shown, against, [*self._opposites()])
        return " or where ".join(common) if len(common) <= 2 else ""

    def _opposites(self) -> Iterator[tuple[Features, bool]]:
        """Systems in which one thing is the other way, and whether it acts in them."""
        for features, evidence in (
            one for scene in self.shown for one in scene.opposites.get(self.source, ())
        ):
            tried = self.candidate.predicted(evidence) if evidence.finite else None
            if tried is None:
                continue
            own = self.numbers and evidence.clear and self.candidate.refitted(evidence) is not None
            if evidence.visible(tried) and (own or self.candidate.fits(evidence, tried)):
                yield features, True
            elif evidence.visible(tried) and np.all(evidence.sound):
                yield features, False

    def where(self, text: str) -> str:
        """Of numbers that act on some scenarios alone: on which. text: the cause so far."""
        if not self.against or self.pairs:
            return ""
        condition = self.condition()
        if condition:
            return only_where(text, condition)
        if self.numbers:
            return ""  # what is seen elsewhere is not by these
        others = "other" if len(self.against) == 1 else "others"
        return f", not on {len(self.against)} {others} that would show it"


class Scenes:
    """The scenarios of one engine so far, by name."""

    def __init__(self) -> None:
        self.by_name: dict[str, Scene] = {}
        self._with_another: dict[tuple[tuple[str, ...], str, str], frozenset[str]] = {}
        self._tried: dict[tuple[str, str], Tried] = {}

    @property
    def pivoted(self) -> bool:
        """Whether one of them is."""
        return any(scene.system.load.pivot is not None for scene in self.by_name.values())

    def evidence(self, source: str) -> list[Evidence]:
        """Of all scenarios that have it."""
        return [e for one in self.by_name.values() if (e := one.evidence.get(source))]

    def tried(self, scene: Scene, source: str) -> Tried:
        """The hypotheses on one scenario, worked out once."""
        key = (scene.name, source)
        if key not in self._tried:
            self._tried[key] = Tried(scene.evidence[source])
        return self._tried[key]

    def held(self, one: Candidate, scene: Scene, source: str) -> Held:
        """A candidate against every other scenario with evidence of the same source."""
        held = Held(one, source, [scene])
        besides: frozenset[str] | None = None  # each of which with this explains what is seen
        for other in self.by_name.values():
            evidence = other.evidence.get(source)
            if other is scene or evidence is None or not evidence.finite:
                continue
            if held.contradicted:
                break
            tried = held.candidate.predicted(evidence)
            if tried is None:
                continue
            if held.candidate.fits(evidence, tried):
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
                more = self._explained(one, other, source)
                besides = more if besides is None else besides & more
                held.contradicted |= not besides
        family = one.family if not one.fixed else None
        if family is not None and (held.numbers or held.against):
            family = VECTORS.get(family.name, family)
        if family is not None and family.name in LAWS and family.unit:  # a factor is its own law
            held.pairs = self._numbers(family, source)
            if held.pairs:
                held.law = law_of(held.pairs, LAWS[family.name], family.unit)
        single = one.numbers is not None and len(one.numbers) == 1 and not one.has_law
        if held.numbers and not held.law and single:
            known = [*held.numbers, (scene, np.asarray(one.numbers))]
            held.law = self._power_law(one, known, source)
        return held

    def _power_law(self, one: Candidate, known: Sequence[tuple[Scene, Array]], source: str) -> str:
        """How a candidate's one number goes with the sizes of the scenarios."""
        scenes, numbers = [scene for scene, _ in known], np.array([p[0] for _, p in known])
        largest = int(np.argmax(np.abs(numbers)))  # next to nothing a factor is worded otherwise
        shown = replace(one, numbers=known[largest][1])
        text, right = shown.text(scenes[largest].system), np.zeros(len(known))
        ways = [(text, right, np.ones(len(known)))]
        if one.family is not None:
            right = np.array([one.family.right(scene.system)[0] for scene in scenes])
            if one.family.name in LAWS:
                what = LAWS[one.family.name]
                ways = [(f"{1} {one.family.unit} is added to {what}", right, np.ones(len(known)))]
                if np.all(right):
                    ways.append((f"{what} is scaled by 1", 0.0 * right, right))
        for text, offset, unit in ways:
            values = (numbers - offset) / unit
            for law, due in power_laws(text, [one.features for one in scenes], values):
                tried = [replace(one, numbers=np.array([p])) for p in offset + unit * due]
                evidence = [scene.evidence[source] for scene in scenes]
                made = [(c, c.predicted(e), e) for c, e in zip(tried, evidence, strict=True)]
                if all(a is not None and c.fits(e, a) for c, a, e in made):
                    return law
        return ""

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
        if all(made is not None and there.fits(one, made) for one, made in tried):
            held.candidate = there
        elif there.numbers is not None:
            held.numbers.append((other, there.numbers))
        held.shown.append(other)

    def _explained(self, one: Candidate, other: Scene, source: str) -> frozenset[str]:
        """What one more thing that is wrong explains a scenario with this; worked out once."""
        key = (one.key, other.name, source)
        if key not in self._with_another:
            self._with_another[key] = self.tried(other, source).beside(one)
        return self._with_another[key]

    def _numbers(self, family: Family, source: str) -> list[tuple[Array, Array]]:
        """Requested and acting numbers of a family, on every scenario that has them."""
        found = list[tuple[Array, Array]]()
        for scene in self.by_name.values():
            evidence = scene.evidence.get(source)
            if evidence is None or not family.starts(evidence.system):
                continue
            right = family.right(evidence.system)
            more = Candidate((), family, right * (1.0 + PRECISE)).predicted(evidence)
            if evidence.fits(evidence.true) and (more is None or not evidence.visible(more)):
                continue  # it shows nothing of these numbers
            one = Candidate((), family, right).refitted(evidence)
            if one is not None and one.numbers is not None:
                found.append((right, one.numbers))
        return found
