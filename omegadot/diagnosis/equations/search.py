"""Which wrong equations are an engine's on one scenario, those with the fewest numbers first."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations, form_of, stacked
from omegadot.diagnosis.equations.evidence import SCREENED, SLACK, Evidence
from omegadot.diagnosis.equations.families import (
    EXTRA,
    LEAST,
    ONE_NUMBER,
    SIX_NUMBERS,
    THREE_NUMBERS,
    Family,
    fit,
)
from omegadot.diagnosis.equations.hypotheses import Hypothesis, hypotheses, wrong_form
from omegadot.diagnosis.equations.operators import Changed, changed_vectors
from omegadot.diagnosis.equations.readings import READINGS, Reading
from omegadot.diagnosis.equations.terms import FEW, MORE, MOST, Terms
from omegadot.diagnosis.wording.digits import vector
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.system import Acceleration, Array, System

STEPS = "steps"  # evidence of what moves a body, of which nothing is reported by itself
MOST_PAIRS = 64
BY_MASS = re.compile("(divided|multiplied) by the mass|left out of the weight|a mass of 1 kg")
DISTINCT = 1e-14  # relative: of a fitted number no more can be known


@dataclass(frozen=True)
class Candidate:
    """Hypotheses without numbers, one family with its numbers, or both.

    Or another reading, or terms too many with their factors.
    """

    fixed: tuple[Hypothesis, ...] = ()
    family: Family | None = None
    numbers: Array | None = None
    reading: Reading | None = None
    terms: Terms | Changed | None = None

    @property
    def key(self) -> tuple[str, ...]:
        """What it is, whatever the numbers."""
        named = (one.text for one in self.fixed)
        other = self.reading.text if self.reading else self.terms.name if self.terms else ""
        return (*named, self.family.name if self.family else "", other)

    def fits(self, evidence: Evidence, made: Acceleration) -> bool:
        """Whether what it gives is the engine's, within the rounding of its numbers."""
        if self.family is None or self.numbers is None:
            return evidence.fits(made)
        return evidence.fits(made, self.family.slack(evidence.system, self.numbers))

    @property
    def by_mass(self) -> bool:
        """Whether it holds by a factor of the mass, which many a number is on one body."""
        return any(BY_MASS.search(one.text) for one in self.fixed)

    @property
    def parts(self) -> set[str]:
        """What it is about."""
        own = {one.part.partition(":")[0] for one in self.fixed}
        return own | ({self.family.part} if self.family else set())

    def text(self, system: System) -> str:
        """The cause as text, with the numbers of this system."""
        if self.reading is not None:
            return self.reading.text
        if self.terms is not None and self.numbers is not None:
            return self.terms.text(system, self.numbers)
        texts = [_with_gravity(one, system) for one in self.fixed]
        if self.family is not None and self.numbers is not None:
            texts.append(self.family.text(system, self.numbers))
        return ", and ".join(texts)

    def form(self, system: System) -> Form | None:
        """The equation of another system with the same things wrong, by the same numbers."""
        form = wrong_form(self.fixed, system)
        if form is None or self.family is None or self.numbers is None:
            return form
        if not self.family.starts(system):
            return form
        try:
            return self.family.form(form, system, self.numbers)
        except (ValueError, np.linalg.LinAlgError):
            return None

    def predicted(self, evidence: Evidence) -> Acceleration | None:
        """What it gives at the states of any scenario; None where it has no meaning there."""
        if self.reading is not None:
            return self.reading.accelerations(evidence)
        if self.terms is not None and self.numbers is not None:
            return self.terms.made(evidence, self.numbers)
        form = self.form(evidence.system)
        return None if form is None else accelerations(form, evidence.states)

    def refitted(self, evidence: Evidence) -> Candidate | None:
        """The same with the numbers of another scenario; None where none fit."""
        if self.terms is not None:
            found = self.terms.fit(evidence)
            return None if found is None else replace(self, numbers=found)
        if self.family is None:
            return None
        base = wrong_form(self.fixed, evidence.system)
        if base is None:
            return None
        found = fit(evidence, self.family, base if self.fixed else None)
        return None if found is None else replace(self, numbers=found)


def _with_gravity(one: Hypothesis, system: System) -> str:
    """A hypothesis as text; of another gravity also which one it comes to."""
    text, requested = one.text.strip(), system.load.gravity
    acting = one.system(system).load.gravity
    if one.part != "gravity" or np.array_equal(acting, requested) or "component" not in text:
        return text
    shown = f"{vector(acting, requested)} m/s^2, where {vector(requested, acting)} was requested"
    return f"gravity is {shown}: {text}"


def levels(evidence: Evidence, deep: bool = True) -> Iterator[list[Candidate]]:
    """What fits at every state: without numbers, with one, two at once, with three, with six.

    A level is worked out when it is needed. deep: also those that take long.
    """
    known = possible(evidence)
    forms = [wrong_form([one], evidence.system) for one in known]
    single = [Candidate((known[k],)) for k in evidence.fitting(forms)]
    likely = [one for one in single if not one.fixed[0].unlikely]
    yield likely + _readings(evidence)
    yield _fitted(evidence, ONE_NUMBER) + _with_terms(evidence, FEW)
    yield _fitted(evidence, LEAST) + _changed(evidence)
    unlikely = [one for one in single if one.fixed[0].unlikely]
    if deep:
        seen = _visible(evidence, known, forms)
        yield unlikely + _pairs(evidence, known, forms, seen)
        yield (_fitted(evidence, THREE_NUMBERS) if evidence.far else []) + _with_terms(
            evidence, MORE
        )
        yield _fitted(evidence, EXTRA)
        yield _mixed(evidence, known, seen)
        yield _with_terms(evidence, MOST)
        yield _fitted(evidence, SIX_NUMBERS) if evidence.far else []
    else:
        yield unlikely


def possible(evidence: Evidence) -> list[Hypothesis]:
    """All but what is no fault: single precision in an engine that declares it."""
    single = evidence.eps > EPS
    return [h for h in hypotheses(evidence.system) if not (single and h.part == "precision")]


def _with_terms(evidence: Evidence, kinds: Sequence[Terms]) -> list[Candidate]:
    steps = evidence.source == STEPS
    usable = [one for one in kinds if not (one.reported if steps else one.stepped)]
    found = [(terms, terms.fit(evidence)) for terms in usable]
    return [Candidate(terms=terms, numbers=p) for terms, p in found if p is not None]


def _readings(evidence: Evidence) -> list[Candidate]:
    """Those that fit, and of several that make no difference here the plainest."""
    made = [(one, one.accelerations(evidence)) for one in READINGS]
    fits = [(one, found) for one, found in made if evidence.fits(found)]
    return [Candidate(reading=one) for one, _ in fits[:1]]


def _fitted(evidence: Evidence, families: Sequence[Family]) -> list[Candidate]:
    found = [(family, fit(evidence, family)) for family in families]
    return [
        Candidate((), family, numbers)
        for family, numbers in found
        if numbers is not None and _differs(numbers, family.right(evidence.system))
    ]


def _differs(numbers: Array, right: Array) -> bool:
    size = max(float(np.max(np.abs(numbers))), float(np.max(np.abs(right))))
    return bool(np.max(np.abs(numbers - right)) > DISTINCT * size)


def _few(evidence: Evidence) -> Evidence:
    return evidence.few(SCREENED)


def _changed(evidence: Evidence) -> list[Candidate]:
    found = changed_vectors(evidence, steps=evidence.source == STEPS)
    return [Candidate(terms=one, numbers=p) for one, p in found]


def _visible(
    evidence: Evidence, known: Sequence[Hypothesis], forms: Sequence[Form | None]
) -> dict[int, Array]:
    """What each hypothesis changes at a few states, in bounds, of those that change anything."""
    few, found, kept = _few(evidence), dict[int, Array](), list[Array]()
    usable = [k for k, form in enumerate(forms) if form is not None]
    tried = accelerations(stacked([f for k in usable if (f := forms[k])]), few.states)
    for lane, k in enumerate(usable):
        change = few.weighted(replace(few.true, **_lane(tried, lane)), few.true)
        new = not any(np.max(np.abs(change - other)) <= SLACK for other in kept)
        if np.max(np.abs(change)) > SLACK and new:
            found[k] = change
            kept.append(change)
    return found


def _lane(tried: object, lane: int) -> dict[str, Array]:
    return {name: values[lane] for name, values in vars(tried).items()}


def _pairs(
    evidence: Evidence,
    known: Sequence[Hypothesis],
    forms: Sequence[Form | None],
    seen: dict[int, Array],
) -> list[Candidate]:
    """Two hypotheses at once. They are found by adding what each changes, then tried together."""
    few = _few(evidence)
    rest, numbers = few.weighted(few.found, few.true), list(seen)
    if not numbers:
        return []
    changes = np.stack([seen[k] for k in numbers])
    sizes, close = np.max(np.abs(changes), axis=-1), []
    for i, change in enumerate(changes):
        left = np.max(np.abs(rest - change - changes[i + 1 :]), axis=-1)
        # what is added up has rounding of its own
        allowed = 1e-9 * np.maximum(sizes[i], sizes[i + 1 :]) + 10 * SLACK
        close += [(i, i + 1 + int(j)) for j in np.flatnonzero(left <= allowed)]
    pairs = [(known[numbers[i]], known[numbers[j]]) for i, j in close[:MOST_PAIRS]]
    pairs = [(one, two) for one, two in pairs if one.part != two.part]
    pairs = [pair for pair in pairs if "precision" not in {one.part for one in pair}]
    made = [wrong_form(pair, evidence.system) for pair in pairs]
    return [Candidate(pairs[k]) for k in evidence.fitting(made)]


def _mixed(
    evidence: Evidence, known: Sequence[Hypothesis], seen: dict[int, Array]
) -> list[Candidate]:
    """One hypothesis without numbers and one with a number, found as pairs are."""
    few, found, right = _few(evidence), list[Candidate](), form_of(evidence.system)
    rest = few.weighted(few.found, few.true)
    for family in ONE_NUMBER:
        starts = family.starts(evidence.system)
        if not starts:
            continue
        moved = starts[0] + (np.abs(starts[0]) or 1.0)
        try:
            line = few.weighted(
                accelerations(family.form(right, evidence.system, moved), few.states), few.true
            )
        except (ValueError, np.linalg.LinAlgError):
            continue
        size = float(line @ line)
        for k, change in seen.items() if size > 0.0 else ():
            left = rest - change
            part = float(left @ line) / size
            left = left - part * line
            largest = max(float(np.max(np.abs(rest))), float(np.max(np.abs(change))))
            one = known[k]
            if np.max(np.abs(left)) > 1e-9 * largest + 10 * SLACK or one.part == "precision":
                continue
            if one.part == family.part or (
                one.part.startswith("inertia") and family.part == "spin"
            ):
                continue
            numbers = fit(evidence, family, wrong_form([one], evidence.system))
            if numbers is not None and _differs(numbers, family.right(evidence.system)):
                found.append(Candidate((one,), family, numbers))
    return found
