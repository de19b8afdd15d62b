"""The applied torques that act, in body and in world axes at once, and the law that makes them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import accelerations, form_of, stacked
from omegadot.diagnosis.equations.evidence import INVERSE, INVERTED, Evidence
from omegadot.diagnosis.wording.laws import law_of
from omegadot.reference_impl.system import Array, System

FRAMES = ("torque_body", "torque_world")
LEAST = 2  # scenarios that show a torque other than the requested one

Pairs = list[tuple[Array, Array]]


def acting_torques(every: Sequence[Evidence]) -> str:
    """The one law that makes every torque that acts, on all scenarios of a source; "" without any.

    A torque in body axes and one in world axes are fitted together, six numbers that omega-dot is
    linear in. Causes of one torque alone are of other searches.
    """
    used = [e for e in every if e.finite and e.source not in (INVERSE, INVERTED)]
    wrong = [e for e in used if e.clear]
    if len(wrong) < LEAST or not all(_requested(e.system) for e in wrong):
        return ""
    pairs = Pairs()
    for evidence in used:
        if not _requested(evidence.system):
            continue
        found = _acting(evidence)
        if found is None:
            return ""
        pairs += found
    law = law_of(pairs, "an applied torque", "N m")
    return law and f"{law}, in body axes and in world axes alike"


def _requested(system: System) -> list[str]:
    """The frames in which a torque was requested."""
    return [name for name in FRAMES if np.any(getattr(system.load, name))]


def _acting(evidence: Evidence) -> Pairs | None:
    """Requested and acting torques, (3,) N m each; None where none make the engine's answers."""
    right, names = form_of(evidence.system), _requested(evidence.system)
    none = replace(right, **{name: np.zeros(3) for name in names})
    size = {name: float(np.linalg.norm(getattr(right, name))) for name in names}
    units = [replace(none, **{n: size[n] * axis}) for n in names for axis in np.eye(3)]
    base = accelerations(none, evidence.states)
    made = accelerations(stacked(units), evidence.states)
    lines = np.stack(
        [
            evidence.weighted(type(base)(made.angular[k], made.linear[k]), base)
            for k in range(len(units))
        ],
        axis=-1,
    )
    shares, _, rank, _ = np.linalg.lstsq(lines, evidence.weighted(evidence.found, base))
    if rank < len(units) or not np.all(np.isfinite(shares)):
        return None
    acting = {
        name: size[name] * numbers
        for name, numbers in zip(names, shares.reshape(-1, 3), strict=True)
    }
    if not evidence.is_of(replace(right, **acting)):
        return None
    return [(np.asarray(getattr(right, name)), torque) for name, torque in acting.items()]
