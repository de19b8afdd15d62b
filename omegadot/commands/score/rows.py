"""What was found of a trace, as rows of ``metrics.parquet``."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.score.judged import GATES, Judged
from omegadot.commands.score.require import Requirement, requirement_row
from omegadot.gates.equation import forward_rows
from omegadot.gates.invariants import HORIZONS
from omegadot.gates.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS
from omegadot.gates.rows import Row
from omegadot.gates.scales import norm, torque_size
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.system import Acceleration


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
    if found.scheme is not None:
        own = found.schemes[0]
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
        note = f"{shift.before / rate:.1e} without the shift"
        left, bound = shift.after / rate, shift.bound / rate
        rows.append(row("omega", "residual_after_shift", left, "1", bound, note=note))
    if shift.attitude_after is not None:
        rows.append(row("attitude", "residual_after_shift", shift.attitude_after, "rad"))
    return rows


def _scheme(found: Judged) -> list[Row]:
    """As the scheme gate has it: the distance from the scheme in parts of its bound."""
    if not found.schemes:
        return []
    names = " and ".join(one.scheme for one in found.schemes if one.found.agree)
    wanted, own, verdict = found.scheme, found.schemes[0].found, "info"
    if wanted is None:
        own = min((one.found for one in found.schemes), key=lambda f: (np.isnan(f.share), f.share))
        note = f"declares no scheme, and equals {names or 'none known'}"
    elif np.isnan(own.share):
        note = "not judged: the scheme itself blows up at so large a step"
    elif own.agree:
        verdict, note = "pass", f"equals {wanted}, to {own.distance:.1e}"
    else:
        instead = f"equals {names}" if names else "steps otherwise"
        verdict = "fail"
        note = f"declares {wanted}, but {instead}: {own.channel} diverges from it"
    if found.schemes[0].own_start:
        verdict, note = "info", f"{note}, from its own start, which is not the scenario's"
    return [Row("scheme", own.channel, "match", own.share, "1", 1.0, verdict, note)]


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
