"""A formula with one factor, as a wrong equation: what it gives at states, and its text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from omegadot.diagnosis.equations.evidence import SLACK, Evidence
from omegadot.diagnosis.equations.formula.factored import Factored, legend_of, with_angular
from omegadot.diagnosis.equations.formula.facts import (
    DAMPING,
    TORQUE,
    WEIGHT,
    Facts,
    Unit,
    facts_of,
    product,
    rates_of,
    terms_of,
)
from omegadot.diagnosis.equations.formula.law import NO_LAW, Law
from omegadot.diagnosis.equations.formula.rows import ROUNDINGS, Rows, rows_of
from omegadot.diagnosis.equations.formula.vectors import Vector
from omegadot.diagnosis.equations.formula.wording import with_factor
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Acceleration, Array, System

Kind = Literal["torque", "rate", "linear"]
Where = Literal["free", "pivoted", "any"]
UNITS: dict[Kind, Unit] = {"torque": TORQUE, "rate": (0, 0, -2), "linear": (0, 1, -2)}


@dataclass(frozen=True)
class Formula(Factored):
    """``found = right + k law(sizes) vector``, or this in place of one of the right terms.

    kind: a torque, through the inertia; a rate; or a linear acceleration, of a free body, a
    pivoted one or any.
    """

    kind: Kind
    vector: Vector
    law: Law = NO_LAW
    instead: str = ""
    where: Where = "free"

    @property
    def cost(self) -> float:
        """How far from plain it is."""
        return (
            self.vector.cost
            + self.law.cost
            + (1.5 if self.instead else 0.0)
            + (0.3 if self.kind == "rate" else 0.0)
        )

    @property
    def name(self) -> str:
        """What it is, whatever the factor."""
        return f"{self.kind} {self.instead} {self.law.text} {self.vector.text}"

    def accelerations(self, facts: Facts) -> Array:
        """What a factor of one adds, (n, 3) in body axes, and whatever it stands in place of."""
        more = self.law.of(facts)[:, None] * self.vector.of(facts)
        return product(facts.matrices["I^-1"], more) if self.kind == "torque" else more

    def sizes(self, facts: Facts) -> Array:
        """(n,): what the parts of `accelerations` multiply to."""
        size = np.abs(self.law.of(facts)) * self.vector.size(facts)
        if self.kind == "torque":
            size = size * np.sqrt(np.sum(facts.matrices["I^-1"] ** 2, axis=(-1, -2)))
        return np.asarray(size)

    def replaced(self, facts: Facts) -> Array:
        """What it stands in place of, as an acceleration; nothing where it is added."""
        if not self.instead:
            return 0.0 * facts.vectors["omega"]
        if self.kind == "linear":
            return rates_of(facts, self.where == "pivoted")[self.instead]
        return product(facts.matrices["I^-1"], terms_of(facts)[self.instead])

    def rows(self, every: Sequence[Evidence]) -> Rows:
        """What is added, with what it stands in place of."""
        rows = rows_of(every, self.kind == "linear")
        return replace(rows, due=rows.due + self.replaced(rows.facts))

    def line(self, rows: Rows) -> Array:
        """What a factor of one adds, (n, 3)."""
        return self.accelerations(rows.facts)

    def made(self, evidence: Evidence, p: Array) -> Acceleration:
        """The accelerations with this factor."""
        facts, true = facts_of(evidence), evidence.true
        more = float(p[0]) * self.accelerations(facts) - self.replaced(facts)
        if self.kind == "linear":
            here = "free" if evidence.system.load.pivot is None else "pivoted"
            turned = rotate(evidence.states.orientation, more)
            acts = self.where in (here, "any")
            return Acceleration(true.angular, true.linear + (turned if acts else 0.0 * turned))
        if self.instead == WEIGHT and evidence.system.load.pivot is None:
            return true  # where no such torque is worked out
        return with_angular(evidence, true.angular + more)

    def slack(self, evidence: Evidence, p: Array) -> Array:
        """(n,): in bounds, what the rounding of its own products may be off by."""
        facts = facts_of(evidence)
        size = np.abs(float(p[0])) * self.sizes(facts)
        bound = evidence.linear_bound if self.kind == "linear" else evidence.angular_bound
        own = ROUNDINGS * evidence.eps * size
        return SLACK + np.where(own > 0.0, own / np.where(bound > 0.0, bound, own), 0.0)

    def text(self, _: System, p: Array) -> str:
        """The cause, with its factor."""
        left = np.array(UNITS[self.kind], dtype=float) - np.array(self.vector.unit)
        left = left - np.array(self.law.unit)
        shown, factor = with_factor(float(p[0]), self.law.text, self.vector.text, left)
        legend = ", ".join([*factor, *self._legend()])
        held = f", with {legend}" if legend else ""
        of = " of a pivoted body" if self.where == "pivoted" else ""
        linear = f"the linear acceleration{of}, in body axes,"
        if self.instead:
            return f"{self._in_place(shown, linear)}{held}"
        if self.kind == "torque":
            return f"a torque {shown} is added{held}"
        what = "omega-dot" if self.kind == "rate" else linear
        return f"{what} has {shown} in it{held}"

    def _in_place(self, shown: str, linear: str) -> str:
        if self.kind == "linear":
            return f"{linear} has {shown} in place of {self.instead}"
        if self.kind == "torque":
            return f"in place of {self.instead} stands {shown}"
        if self.instead == DAMPING:
            return f"the damping is {shown}, where -I^-1 d omega is right"
        return f"omega-dot has {shown} in place of I^-1 times {self.instead}"

    @property
    def direction(self) -> str:
        """``a torque along r x omega``, and what these are."""
        legend = ", ".join(self._legend())
        kind = {"torque": "a torque", "rate": "a rate", "linear": "an acceleration"}[self.kind]
        return f"{kind} along {self.vector.text}{f' ({legend})' if legend else ''}"

    def _legend(self) -> list[str]:
        """What the symbols are."""
        extra = ["o component by component"] if " o " in self.vector.text else []
        return legend_of([self.vector.text, self.law.text]) + extra
