"""A wrong equation that may be an engine's: hypotheses, a family with its numbers, or terms."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families import Family, fit
from omegadot.diagnosis.equations.formula import Formula, OtherInertia, Together
from omegadot.diagnosis.equations.hypotheses import Hypothesis, wrong_form
from omegadot.diagnosis.equations.operators import Apart, Changed
from omegadot.diagnosis.equations.readings import Reading
from omegadot.diagnosis.equations.terms import Terms
from omegadot.diagnosis.wording.digits import vector
from omegadot.reference_impl.system import Acceleration, Array, System

BY_MASS = re.compile("(divided|multiplied) by the mass|left out of the weight|a mass of 1 kg")

FORMULAS = (Formula, OtherInertia, Together)


@dataclass(frozen=True)
class Candidate:
    """Hypotheses without numbers, one family with its numbers, or both.

    Or another reading, or terms too many with their factors.
    """

    fixed: tuple[Hypothesis, ...] = ()
    family: Family | None = None
    numbers: Array | None = None
    reading: Reading | None = None
    terms: Terms | Changed | Apart | Formula | OtherInertia | Together | None = None

    @property
    def key(self) -> tuple[str, ...]:
        """What it is, whatever the numbers."""
        named = (one.text for one in self.fixed)
        other = self.reading.text if self.reading else self.terms.name if self.terms else ""
        return (*named, self.family.name if self.family else "", other)

    def fits(self, evidence: Evidence, made: Acceleration) -> bool:
        """Whether what it gives is the engine's, within the rounding of its numbers."""
        if isinstance(self.terms, FORMULAS) and self.numbers is not None:
            return evidence.fits(made, self.terms.slack(evidence, self.numbers))
        if self.family is None or self.numbers is None:
            form = self.form(evidence.system) if self.fixed and not evidence.fits(made) else None
            return evidence.fits(made) if form is None else evidence.is_of(form)
        return evidence.fits(made, self.family.slack(evidence.system, self.numbers))

    @property
    def has_law(self) -> bool:
        """Whether the law of its number is a part of it."""
        return isinstance(self.terms, FORMULAS)

    @property
    def is_limit(self) -> bool:
        """Whether it changes some states alone, as a run passes through them."""
        return isinstance(self.terms, Changed) and self.terms.operator.guess is not None

    @property
    def by_mass(self) -> bool:
        """Whether it holds by a factor of the mass, which many a number is on one body."""
        apart = isinstance(self.terms, Apart) and bool(BY_MASS.search(self.terms.name))
        return apart or any(BY_MASS.search(one.text) for one in self.fixed)

    @property
    def parts(self) -> set[str]:
        """What it is about."""
        own = {one.part.partition(":")[0] for one in self.fixed}
        return own | ({self.family.part} if self.family else set())

    def text(self, system: System, alone: bool = True) -> str:
        """The cause as text, with the numbers of this system.

        alone: whether it is of this system alone, where the gravity that it comes to is shown.
        """
        if self.reading is not None:
            return self.reading.text
        if self.terms is not None and self.numbers is not None:
            return self.terms.text(system, self.numbers)
        texts = [_with_gravity(one, system) if alone else one.text.strip() for one in self.fixed]
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

    def fitting(self, evidence: Evidence) -> Candidate | None:
        """The same with its own numbers, or else with those of another scenario, if it fits there.

        None where it fits by none.
        """
        made = self.predicted(evidence)
        return self if made is not None and self.fits(evidence, made) else self.refitted(evidence)

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
