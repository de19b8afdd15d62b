"""The inertia about the pivot, made of the body's own and the lever in another way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from omegadot.diagnosis.equations.equation_form import form_of
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families.inertias import tensor_of_balance
from omegadot.diagnosis.wording.digits import number
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.system import Array
from omegadot.written import written

POWERS = (1.0, 0.0, 2.0, 0.5, -1.0)  # of the mass
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
SQUARES = ("x^2", "y^2", "z^2", "x y", "x z", "y z")
# Of |r|^2 1 - r r^T, a row for each of the six numbers, by the products of two of the lever's.
RIGHT = np.diag([0.0, 0.0, 0.0, -1.0, -1.0, -1.0])
RIGHT[:3, :3] = 1.0 - np.eye(3)
WHOLE = np.array(list(product(range(-2, 3), repeat=6)), dtype=float)
PLAIN, ROUNDED = 1e-6, 1e-9  # relative: how well what is added is known, of itself and of the whole
LEAST = 3  # scenarios: of as many, whole numbers that fit to six digits are no chance
WHERE = {("solve", "spin"): "", ("solve",): ", where omega-dot is solved for"}
LEGEND = "with I the body's own and r the lever from the pivot to the centre of mass"


@dataclass(frozen=True)
class _Added:
    """What is added to the body's own inertia: ``m^p C``, C (6, 6) by products of the lever."""

    power: float
    products: Array

    def tensor(self, evidence: Evidence) -> Array:
        """The whole inertia about the pivot."""
        body, (i, j) = evidence.system.body, np.transpose(PAIRS)
        six = float(body.mass) ** self.power * self.products @ _products(evidence)
        added = np.zeros((3, 3))
        added[i, j] = added[j, i] = six
        return np.asarray(body.inertia + added)


def pivot_inertia(every: Sequence[Evidence]) -> str:
    """What explains all that is wrong, of pivoted bodies alone; "" where nothing does."""
    used = [e for e in every if e.finite]
    wrong = [e for e in used if e.clear]
    if len(wrong) < LEAST or any(e.system.load.pivot is None for e in wrong):
        return ""
    for parts, where in WHERE.items():
        known = [(e, tensor_of_balance(e, parts)) for e in wrong]
        for one in _fitting([(e, t) for e, t in known if t is not None]):
            if all(_explains(one, e, parts) for e in used):
                return f"{_text(one)}{where}, {LEGEND}"
    return ""


def _products(evidence: Evidence) -> Array:
    """Of two of the lever's components, (6,)."""
    arm = np.asarray(lever(evidence.system), dtype=float)
    return np.array([arm[i] * arm[j] for i, j in PAIRS])


def _fitting(known: Sequence[tuple[Evidence, Array]]) -> Iterator[_Added]:
    """What gives the inertias found, (3, 3) each, by small whole numbers."""
    if len(known) < LEAST:
        return
    size = np.array([np.linalg.norm(tensor) for _, tensor in known])[:, None]
    i, j = np.transpose(PAIRS)
    added = np.stack([(t - e.system.body.inertia)[i, j] for e, t in known]) / size
    products = np.stack([_products(e) for e, _ in known]) / size
    mass = np.array([float(e.system.body.mass) for e, _ in known])[:, None]
    allowed = PLAIN * np.linalg.norm(added, axis=-1) + ROUNDED
    for power in POWERS:
        made = mass**power * products
        rows = [_whole(made, added[:, k], allowed, RIGHT[k]) for k in range(6)]
        if all(row is not None for row in rows):
            yield _Added(power, np.stack([row for row in rows if row is not None]))


def _whole(made: Array, added: Array, allowed: Array, right: Array) -> Array | None:
    """The numbers of one row: the right ones, or else the least that give what is added."""
    order = np.argsort(np.sum(np.abs(WHOLE), axis=-1), kind="stable")
    tried = np.concatenate([right[None], WHOLE[order]])
    fits = np.all(np.abs(made @ tried.T - added[:, None]) <= allowed[:, None], axis=0)
    return tried[int(np.argmax(fits))] if fits.any() else None


def _explains(one: _Added, evidence: Evidence, parts: tuple[str, ...]) -> bool:
    """Of a scenario that is hardly off: whether it changes nothing there."""
    if evidence.system.load.pivot is None:
        return True
    tensor = one.tensor(evidence)
    try:
        made = {"solve": np.linalg.inv(tensor), "spin": tensor}
    except np.linalg.LinAlgError:
        return False
    right = form_of(evidence.system)
    form = replace(right, **{name: made[name] for name in parts})
    return evidence.is_of(form)


def _text(one: _Added) -> str:
    mass = {1.0: "m ", 0.0: ""}.get(one.power, f"m^{written(one.power)} ")
    differing = [k for k in range(6) if one.power != 1.0 or np.any(one.products[k] != RIGHT[k])]
    texts = list[str]()
    for k in differing:
        own = "I_" + "xyz"[PAIRS[k][0]] + "xyz"[PAIRS[k][1]]
        made, due = _sum(own, mass, one.products[k]), _sum(own, "m ", RIGHT[k])
        texts.append(f"{made} stands in place of {due}")
    return f"in the inertia about the pivot, {', and '.join(texts)}"


def _sum(own: str, mass: str, row: Array) -> str:
    """``I_xx + m (y^2 + z^2)``, ``I_xy - m x y``, ``I_xy`` of nothing more."""
    parts = list[str]()
    for factor, square in zip(row, SQUARES, strict=True):
        if factor:
            sign = "- " if factor < 0.0 else "+ " if parts else ""
            size = "" if abs(factor) == 1.0 else f"{number(abs(float(factor)))} "
            parts.append(f"{sign}{size}{square}")
    if not parts:
        return own
    first = parts[0].removeprefix("- ")
    if len(parts) == 1:
        return f"{own} {'-' if first != parts[0] else '+'} {mass}{first}"
    return f"{own} + {mass}({' '.join(parts).replace('- ', '-', 1 if first != parts[0] else 0)})"
