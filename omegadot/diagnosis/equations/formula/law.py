"""How the factor of a vector may go with sizes: a product of powers, the same on every system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.formula.facts import MOMENTUM, SIZES, VECTORS, Facts, Unit
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array
from omegadot.written import written


@dataclass(frozen=True)
class Law:
    """Powers by the size that they are of; `signed`: a product of two vectors that keeps its sign.

    whole: whether the factor is one number on all systems; else it is another on each.
    """

    powers: tuple[tuple[str, float], ...] = ()
    signed: str = ""
    whole: bool = True

    @property
    def cost(self) -> float:
        """How far from plain it is."""
        per = sum(0.6 + 0.2 * abs(p) + 0.2 * (p % 1.0 != 0.0) for _, p in self.powers)
        return per + (1.0 if self.signed else 0.0) + (0.0 if self.whole else 4.0)

    def of(self, facts: Facts) -> Array:
        """The product at states, (n,)."""
        made = np.ones(len(facts.vectors["omega"]))
        for name, power in self.powers:
            values = np.abs(number_of(facts, name))
            if power < 0.0:  # of nothing there is nothing
                made = np.where(values > 0.0, made * np.where(values > 0, values, 1.0) ** power, 0)
            else:
                made = made * values**power
        return made * number_of(facts, self.signed) if self.signed else made

    @property
    def unit(self) -> Unit:
        """Of the product."""
        total = np.zeros(3)
        for name, power in (*self.powers, *(((self.signed, 1.0),) if self.signed else ())):
            total += power * np.array(_unit_of(name))
        return (float(total[0]), float(total[1]), float(total[2]))

    @property
    def text(self) -> str:
        """``d |omega|^2``, and what it is divided by: ``/ m``."""
        above = [_power(n, p) for n, p in self.powers if p > 0.0]
        above += [f"({self.signed})"] if self.signed else []
        below = [_power(n, -p) for n, p in self.powers if p < 0.0]
        under = " ".join(below)
        under = f"({under})" if len(below) > 1 else under
        return " ".join(above) + (f" / {under}" if below else "")


NO_LAW = Law()


def _power(name: str, power: float) -> str:
    shown = name if (name in SIZES and " " not in name) or name.startswith("|") else f"({name})"
    return shown if power == 1.0 else f"{shown}^{written(power)}"


def number_of(facts: Facts, name: str) -> Array:
    """A size at every state: of a system, of a vector ``|v|``, or of two ``omega . g``."""
    if name in SIZES:
        return facts.sizes[name]
    one, _, other = name.strip("|").partition(" . ")
    if other:
        return np.asarray(np.sum(facts.vectors[one] * facts.vectors[other], axis=-1))
    return norm(facts.vectors[one])


def _unit_of(name: str) -> Unit:
    if name in SIZES:
        return SIZES[name][0]
    one, _, other = name.strip("|").partition(" . ")
    known = {**{k: unit for k, (unit, _) in VECTORS.items()}, MOMENTUM: (1.0, 2.0, -1.0)}
    units = [np.array(known[k]) for k in (one, other) if k]
    total = np.sum(units, axis=0)
    return (float(total[0]), float(total[1]), float(total[2]))


def symbols_of(texts: Sequence[str]) -> set[str]:
    """The names that stand in formulas."""
    joined = " ".join(texts)
    for mark in "()|,/":
        joined = joined.replace(mark, " ")
    return {name.partition("^")[0] if name != "I^-1" else name for name in joined.split()}
