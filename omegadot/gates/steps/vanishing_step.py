"""Gate 3: steps made ever smaller must follow the equation, whatever the scheme is."""

from __future__ import annotations

import numpy as np

from omegadot.gates.bounds.roundings import PLAIN, Roundings
from omegadot.gates.bounds.scales import EPS, norm, omega_dot_bound
from omegadot.gates.rows import Row, within
from omegadot.gates.steps.limits import NOTHING, Limit, Tolerated, limits
from omegadot.gates.steps.probe import Probe, ladder_of
from omegadot.reference_impl.system import State, System
from omegadot.written import written

GATE = "scheme"
METRIC = "rate_at_no_step"
UNITS = {"attitude": "rad/s", "omega": "rad/s^2", "position": "m/s", "linear_momentum": "m/s^2"}
UNDETERMINED = "not judged: in this precision the inverse of the inertia has no digit"
TOO_LONG = "not judged: of so thin a body no steps in this precision are short enough"


def _common_factor(found: dict[str, Limit]) -> float | None:
    """The factor by which all rates are off: the step is longer than requested by that factor."""
    weights = [np.where(one.bound[0] > 0.0, 1.0 / one.bound[0], 0.0) for one in found.values()]
    pairs = list(zip(found.values(), weights, strict=True))
    rates = np.concatenate([np.ravel(one.found[0] * part[:, None]) for one, part in pairs])
    true = np.concatenate([np.ravel(one.expected * part[:, None]) for one, part in pairs])
    factor = float(rates @ true / (true @ true))
    return factor if all(np.all(one.shares(factor) <= 1.0) for one in found.values()) else None


def rows(
    system: System,
    probe: Probe,
    stepped: State,
    eps: float = EPS,
    tolerated: Tolerated = NOTHING,
    known: bool = True,
    roundings: Roundings = PLAIN,
) -> list[Row]:
    """Per channel, how far the steps' own rate is from the equation's, in parts of its bound.

    known: whether the scheme is.  Where ``64 eps J / lambda`` reaches one, rounding leaves no digit
    of the inertia's inverse.
    """
    digits = ladder_of(eps).digits
    with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
        found = limits(system, probe, stepped, eps, tolerated, known, roundings)
        shares = {channel: float(np.max(one.shares())) for channel, one in found.items()}
        wrong = not all(share <= 1.0 for share in shares.values())
        factor = _common_factor(found) if wrong else None
        if wrong and omega_dot_bound(system, eps) >= 1.0:
            worst = max(shares, key=lambda channel: shares[channel])
            return [Row(GATE, worst, METRIC, shares[worst], "1", 1.0, "info", UNDETERMINED)]
        notes = {
            channel: _note(one, factor, digits, UNITS[channel], probe)
            for channel, one in found.items()
        }
        return [
            Row(GATE, channel, METRIC, 0.0, "1", 1.0, "info", TOO_LONG)
            if np.all(np.isinf(found[channel].bound))
            else within(GATE, channel, METRIC, share, "1", 1.0, notes[channel])
            for channel, share in shares.items()
        ]


def _note(limit: Limit, factor: float | None, digits: int, unit: str, probe: Probe) -> str:
    if not np.all(np.isfinite(limit.found)):
        return "a step leads to numbers that are not finite"
    if factor is not None and abs(factor) < 10.0**-digits:  # it would read 100 % too short
        return "a run of one step does not move"
    if factor is not None:
        off = f"{written(100 * abs(factor - 1.0), digits)} %"
        return f"steps are {off} too {'long' if factor > 1 else 'short'}"
    if jump := limit.jumps(unit):
        return f"as the step vanishes, it still changes by {jump}"
    off = f"its rate is not the equation's: {limit.off(unit)}"
    return f"as the step vanishes, {off}, {_place(limit, probe)}"


def _place(limit: Limit, probe: Probe) -> str:
    """From which state the worst limit was looked for, and by how short steps: a run need not come
    near either.
    """
    place = int(np.argmax(limit.shares()))
    rate = float(norm(probe.states.angular_velocity[place]))
    step = float(probe.timesteps[place, 0])
    return (
        f"from a state of |omega| = {written(rate, 3)} rad/s, in steps up to {written(step, 2)} s"
    )
