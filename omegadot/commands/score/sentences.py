"""A scored trace in sentences, in the trace's own units."""

from __future__ import annotations

from math import sqrt

import numpy as np

from omegadot.commands.score.axes_sentences import axes_sentences
from omegadot.commands.score.judged import Judged
from omegadot.commands.score.own_units import factor_of, in_own_unit
from omegadot.commands.score.shift import scatter
from omegadot.commands.score.stamps import gaps_of
from omegadot.gates.rows import Row
from omegadot.written import written


def sentences(found: Judged, rows: list[Row]) -> list[str]:
    """What the table of channels does not show, one sentence each."""
    return [
        *_samples(found),
        *_late(found),
        *axes_sentences(found),
        *(
            f"Likeliest cause: {cause}. The motion with that equals the trace's."
            for cause in found.causes
        ),
        *_start(found),
        *_notes(rows),
        *_digits(found),
        *_absent(found),
    ]


def _samples(found: Judged) -> list[str]:
    """Missing and held samples, and stamps that are not quite what they stand for."""
    table, stamps, lines = found.reading.table, found.reading.stamps, list[str]()
    if gaps := gaps_of(table, stamps):
        lines.append(gaps)
    for held in found.held:
        where = f"from {table.place(held.first)} to {table.place(held.last)}"
        what = f"at its {held.kind} value, {written(held.value, 10)}, {where}"
        if held.kind == "throughout":
            what = f"{written(held.value, 10)} throughout"
        elif held.kind == "between":
            what = f"{written(held.value, 10)} {where}"
        cause = "stale" if held.kind == "between" else "saturated"
        lines.append(
            f"{held.column} is {what} ({held.count} samples), while the exact one changes: it "
            f"looks {cause}."
        )
    opened = float(np.max(found.trace.open["times"]))
    if stamps.single:
        lines.append(
            f"The time stamps are in single precision, which leaves up to {written(opened, 2)} "
            "s of each "
            "open."
        )
    elif found.declared and found.declared.off:
        lines.append(
            f"The time stamps lie up to {written(found.declared.off, 2)} s off whole steps, and "
            "so much of "
            "each is taken as open."
        )
    return lines


def _late(found: Judged) -> list[str]:
    shift, lines = found.shift, list[str]()
    if shift is None:
        return []
    unit, what, factor = "rad", "the attitude", 1.0
    if shift.of == "omega":
        unit, what = found.reading.how.rate_unit, "omega"
        factor = 1.0 / found.reading.how.scale_of("rate")
    if shift.seen:
        share = "the error" if shift.explains else "only part of the error"
        lines.append(
            f"Best-fit time shift: {shift.as_text}. It explains {share}: {what} is off by "
            f"{written(factor * shift.before, 3)} {unit} without the shift and by "
            f"{written(factor * shift.after, 3)} {unit} with it."
        )
    noise = scatter(shift)
    if noise is not None:
        lines.append(
            f"The remaining error of {what} looks like noise: neighbouring samples are "
            f"uncorrelated, {written(factor * noise, 3)} {unit} (standard deviation, each axis)."
        )
    return lines


def _start(found: Judged) -> list[str]:
    lines = []
    noise = found.shift and scatter(found.shift)
    # Four standard deviations in each axis are still noise.
    noisy = {found.shift.of: 4.0 * sqrt(3.0) * noise} if found.shift and noise else {}
    if found.trace.times[0] > 0.0:
        lines.append(
            f"The first sample is {written(found.trace.times[0])} s after the scenario's start."
        )
    for channel in ("attitude", "omega", "position"):
        error = found.error.get(channel)
        if error is not None and error[0] > max(found.bound[channel][0], noisy.get(channel, 0.0)):
            factor, unit = factor_of(found, channel)
            lines.append(
                f"The first sample is not the scenario's state: {channel} is off by "
                f"{written(factor * float(error[0]), 3)} {unit}; digits and rounding account for "
                f"{written(factor * float(found.bound[channel][0]), 2)}."
            )
    return lines


def _notes(rows: list[Row]) -> list[str]:
    lines = []
    for row in rows:
        if row.gate == "scheme":
            lines.append(f"Scheme: {row.note}.")
        elif row.gate == "equation" and row.channel == "omega_dot":
            lines.append(
                "omega-dot against the equation at the trace's own states: "
                f"{written(row.value, 3)} "
                f"(bound {written(row.bound, 2)}), {row.note or 'within it'}."
            )
        elif row.metric == "flip_time_error":
            lines.append(f"Flip times: off by at most {written(row.value, 3)} s ({row.note}).")
        elif row.metric == "requirement":
            name = "flip time" if row.channel == "time" else row.channel.replace("_", " ")
            verb = "met" if row.verdict == "pass" else "missed"
            lines.append(f"Requirement {verb}: {name}, {row.note.removeprefix('required: ')}.")
    return lines


def _digits(found: Judged) -> list[str]:
    scores = {
        c: in_own_unit(found, c) for c in ("omega", "attitude", "position") if c in found.error
    }
    parts = [f"{written(score.digits_open, 1)} {score.unit} of {c}" for c, score in scores.items()]
    return [f"Resolution of the data (digits as written): {', '.join(parts)}."] * bool(parts)


def _absent(found: Judged) -> list[str]:
    lines = []
    if found.absent:
        names = ", ".join(name.replace("_", " ") for name in found.absent)
        lines.append(f"Not given, so not judged: {names}.")
    lacking = [] if found.trace.omega_dot is not None else ["equation (no omega-dot)"]
    if found.declared is None:
        lacking.append("scheme (declare --integrator-scheme and --timestep)")
    lacking.append("model and cost (a trace has none)")
    return [*lines, f"Gates not evaluated: {', '.join(lacking)}."]
