"""Another inertia as a formula: a known matrix, times one factor, added to the right one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.evidence import SLACK, Evidence
from omegadot.diagnosis.equations.formula.factored import Factored, legend_of, with_angular
from omegadot.diagnosis.equations.formula.facts import (
    INERTIA,
    SIZES,
    Facts,
    Unit,
    facts_of,
    product,
)
from omegadot.diagnosis.equations.formula.law import NO_LAW, Law
from omegadot.diagnosis.equations.formula.law_search import laws
from omegadot.diagnosis.equations.formula.rows import Rows, across, rows_of
from omegadot.diagnosis.equations.formula.wording import with_factor
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.system import Acceleration, Array, System

LENGTHS = ("r", "c", "p")
PARTS = ("", "products", "diagonal", "square")
WHERE = {
    ("solve", "spin"): "",
    ("solve",): ", where omega-dot is solved for",
    ("spin",): ", in the gyroscopic term",
}


@dataclass(frozen=True)
class Tensor:
    """One matrix as text, with its values at states (n, 3, 3)."""

    text: str
    unit: Unit
    cost: float


def _tensors() -> Iterator[Tensor]:
    for name in ("D_c", "P_c", "I_c", "D", "P", "I"):
        yield Tensor(name, INERTIA, 1.0)
    for name in LENGTHS:
        for part in PARTS:
            text = f"{part}({name} {name}^T)" if part else f"{name} {name}^T"
            text = f"|{name}|^2 1" if part == "square" else text
            yield Tensor(text, (0.0, 2.0, 0.0), 1.5 + 0.3 * (name != "r"))
    yield Tensor("1", (0.0, 0.0, 0.0), 1.2)
    for axis in "xyz":
        yield Tensor(f"e_{axis} e_{axis}^T", (0.0, 0.0, 0.0), 1.6)
    for one, other in (("c", "p"), ("c", "r"), ("r", "p")):
        yield Tensor(f"({one} {other}^T + {other} {one}^T)", (0.0, 2.0, 0.0), 2.2)


TENSORS = tuple(_tensors())


def values_of(one: Tensor, facts: Facts) -> Array:
    """(n, 3, 3)."""
    if one.text in facts.matrices:
        return facts.matrices[one.text]
    if one.text == "1":
        return np.eye(3) + 0.0 * facts.matrices["I"]
    if " + " in one.text:
        a, b = one.text[1], one.text.partition(" ")[2][0]
        outer = facts.vectors[a][:, :, None] * facts.vectors[b][:, None, :]
        return np.asarray(outer + np.swapaxes(outer, -1, -2))
    square = one.text.startswith("|")
    part, _, inner = one.text.rpartition("(")
    v = facts.vectors[one.text[1] if square else inner.partition(" ")[0]]
    outer = v[:, :, None] * v[:, None, :]
    diagonal = outer * np.eye(3)
    if square:
        return np.asarray(np.eye(3) * np.sum(v * v, axis=-1)[:, None, None])
    return {"": outer, "diagonal": diagonal, "products": outer - diagonal}[part]


@dataclass(frozen=True)
class OtherInertia(Factored):
    """``(I + k L E) omega-dot = tau - omega x (I + k L E) omega``, or one of the two alone."""

    tensor: Tensor
    parts: tuple[str, ...]
    law: Law = NO_LAW

    @property
    def cost(self) -> float:
        """How far from plain it is."""
        return self.tensor.cost + self.law.cost + 0.5 + 0.5 * (len(self.parts) < 2)

    @property
    def name(self) -> str:
        """What it is, whatever the factor."""
        return f"inertia {self.parts} {self.law.text} {self.tensor.text}"

    def rows(self, every: Sequence[Evidence]) -> Rows:
        """What is added to omega-dot."""
        return rows_of(every, linear=False)

    def line(self, rows: Rows) -> Array:
        """What a factor of one adds to omega-dot where omega-dot is what was found, (n, 3)."""
        facts, more = rows.facts, values_of(self.tensor, rows.facts)
        w, made = facts.vectors["omega"], 0.0 * rows.due
        if "solve" in self.parts:
            made = made + product(more, facts.vectors["omega-dot"] + rows.due)
        if "spin" in self.parts:
            made = made + cross(w, product(more, w))
        return self.law.of(facts)[:, None] * -product(facts.matrices["I^-1"], made)

    def made(self, evidence: Evidence, p: Array) -> Acceleration:
        """The accelerations with this factor."""
        facts, true = facts_of(evidence), evidence.true
        w, inertia = facts.vectors["omega"], facts.matrices["I"]
        more = (float(p[0]) * self.law.of(facts))[:, None, None] * values_of(self.tensor, facts)
        torque = product(inertia, true.angular)
        if "spin" in self.parts:
            torque = torque - cross(w, product(more, w))
        solved = inertia + more if "solve" in self.parts else inertia
        try:
            angular = product(np.linalg.inv(solved), torque)
        except np.linalg.LinAlgError:
            angular = np.full_like(w, np.nan)
        return with_angular(evidence, angular)

    def slack(self, evidence: Evidence, p: Array) -> Array:
        """(n,): in bounds."""
        return np.full_like(evidence.angular_bound, SLACK)

    def text(self, _: System, p: Array) -> str:
        """The cause, with its factor."""
        left = np.array(INERTIA) - np.array(self.tensor.unit) - np.array(self.law.unit)
        shown, factor = with_factor(float(p[0]), self.law.text, self.tensor.text, left)
        legend = [*factor, *legend_of([self.tensor.text, self.law.text])]
        held = f", with {', '.join(legend)}" if legend else ""
        return f"{shown} is added to the inertia{WHERE[self.parts]}{held}"


def other_inertias(rows: Rows) -> Iterator[OtherInertia]:
    """Those that are along what is added at all of these states."""
    for tensor in TENSORS:
        for parts in WHERE:
            one = OtherInertia(tensor, parts)
            values = one.line(rows)
            if np.any(values) and np.all(across(rows.due, values) <= SLACK * rows.bound):
                yield one


def with_law(one: OtherInertia, rows: Rows) -> Iterator[OtherInertia]:
    """The same with its size, which states do not change."""
    for law in laws(rows.seen(one.line(rows), rows.due, 0.0 * rows.bound)):
        if not law.signed and all(name in SIZES for name, _ in law.powers):
            yield OtherInertia(one.tensor, one.parts, law)
