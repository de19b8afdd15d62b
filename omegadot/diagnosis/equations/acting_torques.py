"""The applied torques that act, in body and in world axes at once, and the law that makes them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import accelerations, form_of, stacked
from omegadot.diagnosis.equations.evidence import INVERSE, INVERTED, Evidence
from omegadot.diagnosis.wording.laws import law_of
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, System

FRAMES = ("torque_body", "torque_world")
MOST_STATES = 12  # of a scenario, at which the torque in body axes is looked at
KNOWN = 1e-7  # relative: what a torque must be known to, as a law holds to no less
BOUNDED = re.compile(r"is limited to|held above")
LEAST = 2  # scenarios that show a torque other than the requested one

Pairs = list[tuple[Array, Array]]


def acting_torques(every: Sequence[Evidence]) -> str:
    """The one law that makes every torque that acts, on all scenarios of a source; "" without any.

    A torque in body axes and one in world axes are fitted together, six numbers that omega-dot is
    linear in; else the law is sought of both together, in body axes, state by state. Causes of one
    torque alone are of other searches.
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
            return _of_both(used)
        pairs += found
    law = law_of(pairs, "an applied torque", "N m")
    return f"{law}, in body axes and in world axes alike" if law else _of_both(used)


def _of_both(used: Sequence[Evidence]) -> str:
    """The law of the whole applied torque, in body axes at each state; "" without any."""
    pairs, shown = Pairs(), set[int]()
    for count, evidence in enumerate(used):
        found = _at_states(evidence) if _requested(evidence.system) else []
        if evidence.clear and not found:
            return ""  # it is not known there
        shown |= {count} if evidence.clear else set()
        pairs += found
    if len(shown) < LEAST:
        return ""
    law = law_of(pairs, "the applied torque, in body axes,", "N m")
    return law if BOUNDED.search(law) else ""


def _at_states(evidence: Evidence) -> Pairs:
    """Requested and acting torque, (3,) N m each, at the states where it is known well enough."""
    system, states = evidence.system, evidence.states[:MOST_STATES]
    requested = applied_torque(system, states)
    more = evidence.found.angular[:MOST_STATES] - evidence.true.angular[:MOST_STATES]
    inertia = moving_inertia(system)
    acting = requested + apply(inertia, more)
    bound = np.linalg.norm(inertia, 2) * evidence.angular_bound[:MOST_STATES]
    size = np.maximum(norm(requested), norm(acting))
    known = (bound <= KNOWN * np.minimum(norm(requested), norm(acting))) & (size > 0.0)
    return list(zip(requested[known], acting[known], strict=True))


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
