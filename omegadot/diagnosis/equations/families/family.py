"""What a family of wrong equations is, and how its numbers are fitted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations, form_of, stacked
from omegadot.diagnosis.equations.evidence import SLACK, Evidence
from omegadot.diagnosis.wording.digits import factor
from omegadot.reference_impl.system import Array, System

MOST_TRIES, WILD, NEARER = 8, 3, 0.5  # steps; those that may lead away; what one must leave
DELTA = 1e-6
NOTHING = 1e-7  # a part that cannot be kept apart from none in the limit of vanishing steps
OF_THE_BODY = ("inertia", "lever", "pivot", "mass")  # a larger one makes no term larger
AXES = "xyz"


@dataclass(frozen=True)
class Family:
    """One thing that is wrong by a number or a few.

    starts: where the search begins, each (k,); none where the family does not apply.  form: the
    equation with these numbers.  text: the cause as text.  right: the numbers of the right
    equation, (k,), against which those found are held over several scenarios.  guess: one more
    start, from the evidence.  alike: what the numbers of all scenarios have in common, if anything.
    """

    name: str
    part: str
    starts: Callable[[System], list[Array]]
    form: Callable[[Form, System, Array], Form]
    text: Callable[[System, Array], str]
    right: Callable[[System], Array]
    unit: str = ""
    guess: Callable[[Evidence], Array | None] | None = None
    alike: Callable[[Sequence[tuple[System, Array]]], str] = lambda pairs: ""

    def slack(self, system: System, p: Array) -> float:
        """In bounds, what is allowed: a term that is larger than the right one rounds more."""
        if self.part in OF_THE_BODY:
            return SLACK
        right = float(np.max(np.abs(self.right(system))))
        size = float(np.max(np.abs(p)))
        return SLACK * max(1.0, size / right) if right > 0.0 else SLACK


def fit(evidence: Evidence, family: Family, base: Form | None = None) -> Array | None:
    """The numbers with which a family is the engine's equation, by Gauss-Newton; None if none is.

    base: another equation than the right one, in which the numbers are put.
    """
    right = base or form_of(evidence.system)
    guessed = family.guess(evidence) if family.guess and base is None else None
    starts = [*family.starts(evidence.system), *([] if guessed is None else [guessed])]
    for start in starts:
        found = _from(evidence, family, right, np.asarray(start, dtype=float))
        if found is not None:
            return found
    return None


def _from(evidence: Evidence, family: Family, right: Form, p: Array) -> Array | None:
    def form(numbers: Array) -> Form:
        return family.form(right, evidence.system, numbers)

    size = float(np.max(np.abs(p)))
    if size == 0.0:
        size = float(np.trace(right.spin)) if family.unit == "kg m^2" else 1.0
    scale = np.full(len(p), DELTA * (abs(size) or 1.0))
    before = np.inf
    for tried in range(MOST_TRIES):
        try:
            here = accelerations(form(p), evidence.states)
            if evidence.fits(here, family.slack(evidence.system, p)):
                return p
            moved = [form(p + d * one) for d, one in zip(scale, np.eye(len(p)), strict=True)]
            there = accelerations(stacked(moved), evidence.states)
        except (ValueError, np.linalg.LinAlgError):
            return None
        rest = evidence.weighted(evidence.found, here)
        left = float(np.sqrt(rest @ rest))
        if tried >= WILD and not left < NEARER * before:
            return None  # it has come as near as it comes
        before = left
        lines = [
            evidence.weighted(type(here)(there.angular[k], there.linear[k]), here) / d
            for k, d in enumerate(scale)
        ]
        matrix = np.stack(lines, axis=-1)
        if not np.any(matrix) or not np.all(np.isfinite(matrix)):
            return None
        step = np.linalg.lstsq(matrix, rest, rcond=None)[0]
        if not np.all(np.isfinite(step)):
            return None
        p = p + step
    return None


def scalar(
    name: str,
    part: str,
    right: float,
    applies: Callable[[System], bool],
    form: Callable[[Form, System, float], Form],
    text: Callable[[System, float], str],
    unit: str = "",
) -> Family:
    """A family of one number, whose right one is the same for every system."""
    return Family(
        name,
        part,
        lambda s: [np.array([right])] if applies(s) else [],
        lambda f, s, p: form(f, s, float(p[0])),
        lambda s, p: text(s, float(p[0])),
        lambda s: np.array([right]),
        unit,
    )


def driven(system: System) -> bool:
    """Whether a torque is applied."""
    return bool(np.any(system.load.torque_body) or np.any(system.load.torque_world))


def always(_: System) -> bool:
    """Of a family that applies to every system."""
    return True


def scaled(what: str) -> Callable[[System, float], str]:
    """Of a factor: how it is worded."""

    def text(_: System, k: float) -> str:
        return f"{what} is missing" if abs(k) < NOTHING else f"{what} is scaled by {factor(k)}"

    return text


def with_body(system: System, **parts: Array) -> System:
    """A system with other numbers of its body."""
    return replace(system, bodies=(replace(system.body, **parts),))
