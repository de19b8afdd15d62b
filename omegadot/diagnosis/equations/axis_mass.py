"""Another mass in the parallel-axis theorem: one that is held above a limit, or limited to it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations, form_of
from omegadot.diagnosis.equations.evidence import INVERSE, SLACK, Evidence
from omegadot.diagnosis.equations.families.family import with_body
from omegadot.diagnosis.equations.limited_inertia import balance
from omegadot.diagnosis.wording.digits import number
from omegadot.diagnosis.wording.kinds import either
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array

PARTS: dict[tuple[str, ...], str] = {
    ("solve", "spin"): "",
    ("solve",): ", where omega-dot is solved for",
    ("spin",): ", in the gyroscopic term",
}
SAME = 1e-6  # relative: as well as fitted numbers are known
SIMPLE = 2  # digits of a limit that one body shows: of six that are drawn these are no chance
RATIO = 3  # of its ratio to the body's mass, which is then no simple factor


def axis_mass(every: Sequence[Evidence]) -> str:
    """What explains all that is wrong, of pivoted bodies alone; "" where nothing does.

    A limit must be seen from both sides: bodies that it changes, and others that would show it.
    """
    used = [e for e in every if e.finite]
    wrong = [e for e in used if e.clear]
    held = [e for e in used if e.system.load.pivot is not None]
    if not wrong or any(e.system.load.pivot is None or e.source == INVERSE for e in wrong):
        return ""
    texts = [text for parts in PARTS for text in _texts(held, wrong, parts)]
    return (either(texts) or [""])[0]


def _texts(
    held: Sequence[Evidence], wrong: Sequence[Evidence], parts: tuple[str, ...]
) -> Iterator[str]:
    found = [_mass_of(e, parts) for e in wrong]
    shown = [(e, mass, known) for e, (mass, known) in zip(wrong, found, strict=True) if mass > 0.0]
    if len(shown) < len(wrong):
        return
    own = np.array([_own(e) for e, _, _ in shown])
    masses, weights = np.array([(mass, 1.0 / known**2) for _, mass, known in shown]).T
    limit = float(np.sum(masses * weights) / np.sum(weights))
    single = bool(np.ptp(own) <= SAME * np.max(own))
    if single:
        simple = _rounded(limit, SIMPLE)
        if not _close(simple, limit) or _is_factor(limit / float(own[0])):
            return
        limit = simple
    above = float(own[0]) < limit
    if any((one < limit) != above for one in own) or not _is_reached(held, parts, limit, above):
        return
    if not all(
        _makes(e, parts, max(_own(e), limit) if above else min(_own(e), limit)) for e in held
    ):
        return
    how = f"held above {number(limit)} kg" if above else f"limited to {number(limit)} kg"
    alone = ", as far as one scenario shows it" * (len(wrong) == 1)
    yield f"the mass in the parallel-axis theorem is {how}{PARTS[parts]}{alone}"
    if parts == ("solve", "spin") and all(e.is_of(_whole(e, limit)) for e in wrong):
        yield f"the mass in the dynamics is {how}{alone}"  # no weight shows which


def _own(evidence: Evidence) -> float:
    return float(evidence.system.body.mass)


def _rounded(value: float, digits: int) -> float:
    return float(f"{value:.{digits - 1}e}")


def _close(one: float, other: float) -> bool:
    return abs(one - other) <= SAME * abs(other)


def _is_factor(ratio: float) -> bool:
    """Whether it is a simple number, or one over it: then the mass may be scaled instead."""
    return any(_close(_rounded(x, RATIO), x) for x in (ratio, 1.0 / ratio))


def _about(evidence: Evidence) -> tuple[Array, Array]:
    """The body's own inertia, and what 1 kg in the parallel-axis theorem adds to it."""
    own = np.asarray(evidence.system.body.inertia, dtype=float)
    return own, (np.asarray(moving_inertia(evidence.system), dtype=float) - own) / _own(evidence)


def _mass_of(evidence: Evidence, parts: tuple[str, ...]) -> tuple[float, float]:
    """The mass in the parallel-axis theorem, and how well it is known, kg; nan where it is not.

    ``J = I + m A`` is put in the balance of torques, which is linear in m.
    """
    before = _about(evidence)[1]
    line, due = balance(evidence, parts, before, _own(evidence) * before)
    size = float(line @ line)
    if not (size > 0.0 and np.isfinite(size) and np.all(np.isfinite(due))):
        return np.nan, np.inf
    mass, known = float(line @ due) / size, 1.0 / float(np.sqrt(size))
    good = SLACK * known <= SAME * abs(mass) and _makes(evidence, parts, mass)
    return (mass, known) if good else (np.nan, np.inf)


def _form(evidence: Evidence, parts: tuple[str, ...], mass: float) -> Form:
    own, before = _about(evidence)
    whole = own + mass * before
    made = {"solve": np.linalg.inv(whole), "spin": whole}
    return replace(form_of(evidence.system), **{name: made[name] for name in parts})


def _makes(evidence: Evidence, parts: tuple[str, ...], mass: float) -> bool:
    return mass > 0.0 and evidence.is_of(_form(evidence, parts, mass))


def _whole(evidence: Evidence, mass: float) -> Form:
    return form_of(with_body(evidence.system, mass=np.asarray(mass)))


def _is_reached(
    held: Sequence[Evidence], parts: tuple[str, ...], limit: float, above: bool
) -> bool:
    """Whether a body beyond the limit is right, and another mass there would be seen."""
    right = (e for e in held if not e.clear and (_own(e) >= limit) == above)
    return any(e.visible(accelerations(_form(e, parts, limit), e.states)) for e in right)
