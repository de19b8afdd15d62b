"""What was found of a trace, as rows of ``metrics.parquet``."""

from __future__ import annotations

import numpy as np

from omegadot.commands.score.judged import Judged
from omegadot.commands.score.require import requirement_rows
from omegadot.commands.score.verdicts import GATES, INVARIANTS
from omegadot.gates.equation import forward_rows
from omegadot.gates.invariants import HORIZONS
from omegadot.gates.measures import TRAJECTORY_UNITS
from omegadot.gates.rows import Row
from omegadot.gates.scales import norm, torque_size
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.system import Acceleration


def rows_of(found: Judged) -> list[Row]:
    """Every row; channels that the trace does not give have one that states so."""
    rows = [*_equation(found), *_scheme(found)]
    for channel in found.measured.error:
        rows += _invariant(found, channel) if channel in INVARIANTS else _trajectory(found, channel)
    rows += _omega_absolute(found) + _shift(found) + found.flips
    wanted = list(found.making.requirements)
    rate = found.truth.yardstick.rate
    rows += requirement_rows(wanted, found.measured, rate, found.flips)
    rows += [
        Row(GATES[channel], channel, "samples_given", 0.0, "1", note=why)
        for channel, why in found.measured.absent.items()
    ]
    return rows


def _trajectory(found: Judged, channel: str) -> list[Row]:
    error, judgement, unit = (
        found.measured.error[channel],
        found.judgement[channel],
        TRAJECTORY_UNITS,
    )
    gate, u = "trajectory", unit[channel]
    bound, largest = float(np.max(found.bound[channel])), float(np.max(error))
    rows = [
        Row(gate, channel, "error_max", largest, u, bound, judgement.verdict, judgement.note),
        Row(gate, channel, "error_end", float(error[-1]), u),
        Row(gate, channel, "error_rms", float(np.sqrt(np.mean(error**2))), u),
        Row(gate, channel, "error_start", float(error[0]), u, float(found.bound[channel][0])),
        Row(gate, channel, "digits_open", float(np.max(found.digits[channel])), u),
    ]
    if channel in found.truth.floor:
        floor = float(np.max(found.truth.floor[channel]))
        rows.append(Row(gate, channel, "resolvable_floor", floor, u))
    return rows + _unexplained(found, channel, u)


def _unexplained(found: Judged, channel: str, unit: str) -> list[Row]:
    if found.declared is None or found.declared.scheme is None:
        return []
    own = found.schemes[0]
    left, bound = float(np.max(own.left[channel])), float(np.max(own.bound[channel]))
    return [Row("trajectory", channel, "unexplained_max", left, unit, bound)]


def _omega_absolute(found: Judged) -> list[Row]:
    """In rad/s, largest and root mean square, and the largest of each component."""
    omega = found.trace.angular_velocity
    if omega is None:
        return []
    gap = omega - found.truth.state.angular_velocity
    size, gate = norm(gap), "trajectory"
    rows = [
        Row(gate, "omega", "absolute_max", float(np.max(size)), "rad/s"),
        Row(gate, "omega", "absolute_rms", float(np.sqrt(np.mean(size**2))), "rad/s"),
    ]
    for axis, part in zip("xyz", gap.T, strict=True):
        largest = float(np.max(np.abs(part)))
        rows.append(Row(gate, "omega", f"absolute_max_{axis}", largest, "rad/s"))
    return rows


def _invariant(found: Judged, channel: str) -> list[Row]:
    error, judgement, times = (
        found.measured.error[channel],
        found.judgement[channel],
        found.trace.times,
    )
    rows = []
    for metric, part in HORIZONS.items():
        until = times <= max(part * times[-1], times[0])
        value = float(np.max(error[until]))
        bound = float(np.max(found.bound[channel][until]))
        rows.append(
            Row("invariants", channel, metric, value, "1", bound, judgement.verdict, judgement.note)
        )
    return rows


def _shift(found: Judged) -> list[Row]:
    shift = found.shift
    if shift is None:
        return []
    note = shift.as_text if shift.seen else "neither late nor early"
    rows = [Row("trajectory", "time", "time_shift", shift.seconds, "s", shift.open, note=note)]
    if shift.of == "omega":
        rate = found.truth.yardstick.rate
        note = f"{shift.before / rate:.1e} without the shift"
        left, bound = shift.after / rate, shift.bound / rate
        rows.append(Row("trajectory", "omega", "residual_after_shift", left, "1", bound, note=note))
    if shift.attitude_after is not None:
        left = shift.attitude_after
        rows.append(Row("trajectory", "attitude", "residual_after_shift", left, "rad"))
    return rows


def _scheme(found: Judged) -> list[Row]:
    """As the scheme gate has it: the distance from the scheme in parts of its bound."""
    if found.declared is None or not found.schemes:
        return []
    agreeing = [one for one in found.schemes if one.found.agree]
    names = " and ".join(one.scheme for one in agreeing)
    wanted = found.declared.scheme
    if wanted is None:
        best = min(found.schemes, key=lambda one: (np.isnan(one.found.share), one.found.share))
        note = f"declares no scheme, and equals {names or 'none known'}"
        return [Row("scheme", best.found.channel, "match", best.found.share, "1", 1.0, note=note)]
    own = found.schemes[0].found
    if np.isnan(own.share):
        note = "not judged: the scheme itself blows up at so large a step"
        return [Row("scheme", own.channel, "match", own.share, "1", 1.0, "info", note)]
    note = f"equals {wanted}, to {own.distance:.1e}"
    if not own.agree:
        instead = f"equals {names}" if names else "steps otherwise"
        note = f"declares {wanted}, but {instead}: {own.channel} diverges from it"
    verdict = "pass" if own.agree else "fail"
    if found.schemes[0].own_start:
        verdict, note = "info", f"{note}, from its own start, which is not the scenario's"
    return [Row("scheme", own.channel, "match", own.share, "1", 1.0, verdict, note)]


def _equation(found: Judged) -> list[Row]:
    """omega-dot, where it is given with all that it depends on, against equation (8).

    It is measured, not judged: a log's omega-dot may be a difference of its omega.
    """
    given, system = found.trace.omega_dot, found.case.system
    state = found.measured.state
    load = system.load
    by_attitude = bool(np.any(load.torque_world)) or load.pivot is not None
    if given is None or found.trace.angular_velocity is None:
        return []
    if by_attitude and found.trace.orientation is None:
        return []
    own = acceleration_of(system)(state)
    rows = forward_rows(system, state, Acceleration(given, own.linear), "residual")
    first = next(row for row in rows if row.channel == "omega_dot")
    size = torque_size(system, state, own)
    scale = found.truth.yardstick.scale
    opened = found.trace.open
    rates = norm(state.angular_velocity)
    digits = (
        opened["omega_dot"]
        + 2.0 * rates * scale.largest / scale.smallest * opened["angular_velocity"]
    )
    more = float(np.max(np.where(size > 0.0, scale.largest * digits / np.where(size, size, 1), 0)))
    bound = (first.bound or 0.0) + more
    within = first.value <= bound
    note = "" if within else "measured, not judged: how it was formed is not declared"
    verdict = "pass" if within else "info"
    return [Row("equation", "omega_dot", "residual", first.value, "1", bound, verdict, note)]
