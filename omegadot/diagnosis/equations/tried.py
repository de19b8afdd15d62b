"""The hypotheses without numbers on one scenario: each by itself, and beside another cause."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

import numpy as np

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.equation_form import Form, accelerations, form_of, stacked
from omegadot.diagnosis.equations.evidence import SCREENED, SLACK, Evidence
from omegadot.diagnosis.equations.families import ONE_NUMBER, Family, fit
from omegadot.diagnosis.equations.hypotheses import Hypothesis, hypotheses, wrong_form
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.system import Array

MOST_PAIRS = 64
DISTINCT = 1e-14  # relative: of a fitted number no more can be known
ADDED = 1e-9  # relative: the rounding of what is added up and taken off again


def differs(numbers: Array, right: Array) -> bool:
    """Whether numbers are others than the right ones, beyond their own rounding."""
    size = max(float(np.max(np.abs(numbers))), float(np.max(np.abs(right))))
    return bool(np.max(np.abs(numbers - right)) > DISTINCT * size)


class Tried:
    """What every hypothesis makes of a scenario, each worked out once."""

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._right = form_of(evidence.system)

    @cached_property
    def _known(self) -> list[Hypothesis]:
        """All but what is no fault: single precision in an engine that declares it."""
        single = self._evidence.eps > EPS
        every = hypotheses(self._evidence.system)
        return [h for h in every if not (single and h.part == "precision")]

    @cached_property
    def _forms(self) -> list[Form | None]:
        return [self._with(one) for one in self._known]

    def _with(self, *several: Hypothesis) -> Form | None:
        return wrong_form(several, self._evidence.system, self._right)

    def fitting(self) -> list[Candidate]:
        """Those that fit by themselves."""
        return [Candidate((self._known[k],)) for k in self._evidence.fitting(self._forms)]

    def beside(self, one: Candidate) -> frozenset[str]:
        """Each that fits together with another cause."""
        if one.reading is not None or one.terms is not None:
            return frozenset()
        known = [h for h in self._known if h.part not in one.parts]
        made = [self._with(*one.fixed, h) for h in known]
        return frozenset(known[k].text for k in self._evidence.fitting(made))

    @cached_property
    def _few(self) -> Evidence:
        return self._evidence.few(SCREENED)

    @cached_property
    def _changes(self) -> dict[int, Array]:
        """What each changes at a few states, in bounds, of those that change anything."""
        few, found = self._few, dict[int, Array]()
        usable = [k for k, form in enumerate(self._forms) if form is not None]
        tried = accelerations(stacked([f for k in usable if (f := self._forms[k])]), few.states)
        kept = np.empty((len(usable), 6 * len(few.angular_bound)))
        for lane, k in enumerate(usable):
            made = replace(few.true, **{name: one[lane] for name, one in vars(tried).items()})
            change = few.weighted(made, few.true)
            apart = np.max(np.abs(change - kept[: len(found)]), axis=-1)
            if np.max(np.abs(change)) > SLACK and np.all(apart > SLACK):
                kept[len(found)] = found[k] = change
        return found

    def pairs(self) -> list[Candidate]:
        """Two at once. They are found by adding what each changes, then tried together."""
        few, seen = self._few, self._changes
        rest, numbers = few.weighted(few.found, few.true), list(seen)
        if not numbers:
            return []
        changes = np.stack([seen[k] for k in numbers])
        sizes, close = np.max(np.abs(changes), axis=-1), []
        for i, change in enumerate(changes):
            left = np.max(np.abs(rest - change - changes[i + 1 :]), axis=-1)
            allowed = ADDED * np.maximum(sizes[i], sizes[i + 1 :]) + 10 * SLACK
            close += [(i, i + 1 + int(j)) for j in np.flatnonzero(left <= allowed)]
        known = self._known
        pairs = [(known[numbers[i]], known[numbers[j]]) for i, j in close[:MOST_PAIRS]]
        pairs = [(one, two) for one, two in pairs if one.part != two.part]
        pairs = [pair for pair in pairs if "precision" not in {one.part for one in pair}]
        made = [self._with(*pair) for pair in pairs]
        return [Candidate(pairs[k]) for k in self._evidence.fitting(made)]

    def mixed(self) -> list[Candidate]:
        """One hypothesis without numbers and one with a number, found as pairs are."""
        found = list[Candidate]()
        for family in ONE_NUMBER:
            line = self._line(family)
            for one in self._near(line) if line is not None else ():
                same = one.part == family.part
                if same or (one.part.startswith("inertia") and family.part == "spin"):
                    continue
                numbers = fit(self._evidence, family, self._with(one))
                if numbers is not None and differs(numbers, family.right(self._evidence.system)):
                    found.append(Candidate((one,), family, numbers))
        return found

    def _line(self, family: Family) -> Array | None:
        """What a change of a family's number changes; None where it changes nothing."""
        few, starts = self._few, family.starts(self._evidence.system)
        if not starts:
            return None
        moved = starts[0] + (np.abs(starts[0]) or 1.0)
        try:
            form = family.form(self._right, self._evidence.system, moved)
        except (ValueError, np.linalg.LinAlgError):
            return None
        line = few.weighted(accelerations(form, few.states), few.true)
        return line if float(line @ line) > 0.0 else None

    def _near(self, line: Array) -> Iterator[Hypothesis]:
        """Those that leave a multiple of the line of what is seen."""
        rest = self._few.weighted(self._few.found, self._few.true)
        for k, change in self._changes.items():
            left = rest - change
            left = left - float(left @ line) / float(line @ line) * line
            largest = max(float(np.max(np.abs(rest))), float(np.max(np.abs(change))))
            near = np.max(np.abs(left)) <= ADDED * largest + 10 * SLACK
            if near and self._known[k].part != "precision":
                yield self._known[k]
