"""What was found of a trace, as rows of ``metrics.parquet``."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.score.declared import KNOWN
from omegadot.commands.score.judged import GATES, Judged
from omegadot.commands.score.own_units import factor_of
from omegadot.commands.score.require import Requirement, requirement_row
from omegadot.commands.score.steps import Comparison
from omegadot.gates.bounds.likeness import Likeness
from omegadot.gates.bounds.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS
from omegadot.gates.bounds.scales import norm, torque_size
from omegadot.gates.rows import Row
from omegadot.gates.runs.invariants import HORIZONS
from omegadot.gates.states.equation import forward_rows
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.system import Acceleration
from omegadot.written import written

SPINS = ("omega", "attitude")
MOST_NAMED = 3
_PLURAL = re.compile(r"^(equals|is)\b")


def rows_of(found: Judged, requirements: list[Requirement]) -> list[Row]:
    """Every row; channels that the trace does not give have one that states so."""
    rows = [*_equation(found), *_scheme(found)]
    for channel in found.error:
        invariant = channel in INVARIANT_CHANNELS
        rows += _invariant(found, channel) if invariant else _trajectory(found, channel)
    rows += _omega_absolute(found) + _shift(found) + found.flips
    rows += [requirement_row(one, found) for one in requirements]
    rows += [
        Row(GATES[channel], channel, "samples_given", 0.0, "1", note=why)
        for channel, why in found.absent.items()
    ]
    return rows


def _trajectory(found: Judged, channel: str) -> list[Row]:
    unit = TRAJECTORY_UNITS[channel]
    score, start = found.score(channel, 1.0, unit), float(found.bound[channel][0])
    row = partial(Row, "trajectory", channel, unit=unit)
    rows = [
        row("error_max", score.max, bound=score.bound, verdict=score.verdict, note=score.note),
        row("error_end", score.end),
        row("error_rms", score.rms),
        row("error_start", score.start, bound=start),
        row("digits_open", score.digits_open),
    ]
    if channel in found.truth.floor:
        rows.append(row("resolvable_floor", float(np.max(found.truth.floor[channel]))))
    if own := found.own:
        left, bound = float(np.max(own.left[channel])), float(np.max(own.bound[channel]))
        rows.append(row("unexplained_max", left, bound=bound))
    return rows


def _omega_absolute(found: Judged) -> list[Row]:
    """In rad/s, largest and root mean square, and the largest of each component."""
    if "omega" not in found.error:
        return []
    gap = found.state.angular_velocity - found.truth.state.angular_velocity
    size = norm(gap)
    values = {"max": float(np.max(size)), "rms": float(np.sqrt(np.mean(size**2)))}
    values |= {
        f"max_{axis}": float(np.max(np.abs(part))) for axis, part in zip("xyz", gap.T, strict=True)
    }
    return [Row("trajectory", "omega", f"absolute_{k}", v, "rad/s") for k, v in values.items()]


def _invariant(found: Judged, channel: str) -> list[Row]:
    times, judgement = found.trace.times, found.judgement[channel]
    rows = []
    for metric, part in HORIZONS.items():
        until = times <= max(part * times[-1], times[0])
        value, bound = (float(np.max(x[channel][until])) for x in (found.error, found.bound))
        verdict, note = judgement.verdict, judgement.note
        rows.append(Row("invariants", channel, metric, value, "1", bound, verdict, note))
    return rows


def _shift(found: Judged) -> list[Row]:
    shift, rate, row = found.shift, found.rate, partial(Row, "trajectory")
    if shift is None:
        return []
    rows = [row("time", "time_shift", shift.seconds, "s", shift.open, note=shift.note)]
    if shift.of == "omega":
        note = f"{written(shift.before / rate, 2)} without the shift"
        left, bound = shift.after / rate, shift.bound / rate
        rows.append(row("omega", "residual_after_shift", left, "1", bound, note=note))
    if shift.attitude_after is not None:
        rows.append(row("attitude", "residual_after_shift", shift.attitude_after, "rad"))
    return rows


def _scheme(found: Judged) -> list[Row]:
    """As the scheme gate has it: the distance from the scheme in parts of its bound."""
    own, schemes, missing = found.own, found.compared.schemes, found.compared.not_sought
    if found.declared is None:
        return []
    if own is None:
        note = f"declares no scheme; {missing or _equals(found, schemes)}"
        least = [one.found for one in schemes if not np.isnan(one.found.share)]
        best = min(least, key=lambda f: f.share, default=Likeness(float("nan"), "omega", 0.0))
        return [Row("scheme", best.channel, "match", best.share, "1", 1.0, "info", note)]
    share, verdict = own.found.share, "info"
    if np.isnan(share):
        note = "not judged: the scheme itself blows up at so large a step"
    elif own.found.agree:
        verdict, note = "pass", f"equals {found.scheme}, to {written(own.found.distance, 2)}"
    else:
        verdict, others = "fail", [one for one in schemes[1:] if one.scheme != own.scheme]
        apart = ", ".join(c for c in SPINS if c in found.error and not own.agrees(c))
        instead = missing or _equals(found, others)
        note = f"declares {found.scheme}, but {apart} diverges from it; {instead}"
    if own.own_start:
        verdict, note = "info", f"{note}, from its own start, which is not the scenario's"
    return [Row("scheme", own.found.channel, "match", share, "1", 1.0, verdict, note)]


def _equals(found: Judged, schemes: list[Comparison]) -> str:
    """Which schemes each channel equals, or is near, one clause for channels that do alike."""
    channels = [c for c in SPINS if c in found.error]
    whole = [one for one in schemes if all(one.agrees(c) for c in channels)]
    if whole:
        return f"it {_named(whole)}"
    clauses: dict[str, list[str]] = {}
    for channel in channels:
        alike, near = [one for one in schemes if one.agrees(channel)], found.nearest(channel)
        if alike:
            clause = _named(alike)
        elif near is not None:
            factor, unit = factor_of(found, channel)
            left, error = (factor * float(np.max(x[channel])) for x in (near.left, found.error))
            rest = f"{written(left, 2)} of {written(error, 3)} {unit}"
            clause = f"is nearest to {near.scheme}, which leaves {rest}"
        else:
            clause = f"equals none of the {len(KNOWN)} that are known"
        clauses.setdefault(clause, []).append(channel)
    return ", ".join(_clause(names, clause) for clause, names in clauses.items())


def _clause(channels: list[str], clause: str) -> str:
    """``omega equals rk4``; ``omega and attitude equal rk4``."""
    if len(channels) > 1:
        clause = _PLURAL.sub(
            lambda verb: "equal" if verb[0] == "equals" else "are", clause, count=1
        )
    return f"{' and '.join(channels)} {clause}"


def _named(schemes: list[Comparison]) -> str:
    """``equals rk4-quaternion and lie-rk4 and 2 more``."""
    names = list(dict.fromkeys(one.scheme for one in schemes))
    more = f" and {len(names) - MOST_NAMED} more" if names[MOST_NAMED:] else ""
    own = ", from its own start" if all(one.own_start for one in schemes) else ""
    return f"equals {' and '.join(names[:MOST_NAMED])}{more}{own}"


def _equation(found: Judged) -> list[Row]:
    """omega-dot, where it is given with all that it depends on, against equation (8).

    It is measured, not judged: a log's omega-dot may be a difference of its omega.
    """
    given, system, state = found.trace.omega_dot, found.case.system, found.state
    by_attitude = bool(np.any(system.load.torque_world)) or system.load.pivot is not None
    lacking = {"omega", "attitude"} if by_attitude else {"omega"}
    if given is None or lacking & set(found.absent):
        return []
    own = acceleration_of(system)(state)
    rows = forward_rows(system, state, Acceleration(given, own.linear), "residual")
    first = next(row for row in rows if row.channel == "omega_dot")
    size, scale = torque_size(system, state, own), found.truth.yardstick.scale
    turning = 2.0 * norm(state.angular_velocity) * scale.largest / scale.smallest
    digits = found.trace.open["omega_dot"] + turning * found.trace.open["angular_velocity"]
    more = float(np.max(np.where(size > 0.0, scale.largest * digits / np.where(size, size, 1), 0)))
    bound = (first.bound or 0.0) + more
    if first.value <= bound:
        return [replace(first, bound=bound, verdict="pass", note="")]
    note = "measured, not judged: how it was formed is not declared"
    return [replace(first, bound=bound, verdict="info", note=note)]
