"""A scored trace for a person, as a table with sentences, and the same for machines."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from omegadot.commands.score.judged import Judged
from omegadot.commands.score.sentences import factor_of, sentences
from omegadot.commands.score.shift import scatter
from omegadot.gates.rows import Row

UNITS = {"omega": "rad/s", "attitude": "rad", "position": "m"}
STYLES = {"pass": "green", "fail": "bold red", "info": "default"}
WIDTH_WHEN_PIPED = 200


def print_score(found: Judged, rows: list[Row], name: str, console: Console) -> None:
    """The table of channels, then what else must be reported."""
    truth, table = found.truth, found.reading.table
    first, last = found.trace.times[0], found.trace.times[-1]
    console.print(
        Text(
            f"{name} ({table.file}, {len(found.trace.times)} samples from {first:g} to {last:g} s) "
            f"against the exact solution of {found.case.name} ({truth.source})"
        )
    )
    console.print(_table(found))
    for sentence in sentences(found, rows):
        console.print(Text(sentence))


def _table(found: Judged) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold")
    for head in ("channel", "largest", "at the end", "rms", "left open", "unit", "", "why"):
        table.add_column(head, no_wrap=True)
    for channel, error in found.measured.error.items():
        factor, unit = factor_of(found, channel)
        rms = math.sqrt(float(np.mean(error**2)))
        shown = (np.max(error), error[-1], rms, np.max(found.bound[channel]))
        judgement = found.judgement[channel]
        table.add_row(
            channel.replace("_", " "),
            *(f"{factor * float(value):.4g}" for value in shown),
            unit,
            Text(judgement.verdict, STYLES[judgement.verdict]),
            Text(judgement.note),
        )
    return table


def machine_readable(found: Judged, rows: list[Row], name: str) -> dict[str, Any]:
    """What the text states, as numbers. SI units; omega in rad/s."""
    rate, channels = found.truth.yardstick.rate, {}
    for channel, error in found.measured.error.items():
        factor, judgement = (rate if channel == "omega" else 1.0), found.judgement[channel]
        channels[channel] = {
            "max": factor * np.max(error),
            "end": factor * error[-1],
            "rms": factor * math.sqrt(float(np.mean(error**2))),
            "start": factor * error[0],
            "digits_open": factor * np.max(found.digits[channel]),
            "bound": factor * np.max(found.bound[channel]),
            "unit": UNITS.get(channel, "1"),
            "verdict": judgement.verdict,
            "kind": judgement.kind,
            "note": judgement.note,
        }
    shift = found.shift
    late = shift and {
        "seconds": shift.seconds,
        "open": shift.open,
        "before": shift.before,
        "after": shift.after,
        "of": shift.of,
        "unit": "rad/s" if shift.of == "omega" else "rad",
        "attitude_after": shift.attitude_after,
        "noise": scatter(shift),
        "explains": shift.explains,
        "note": shift.as_text if shift.seen else "neither late nor early",
    }
    return {
        "scenario": found.case.name,
        "trace": name,
        "samples": len(found.trace.times),
        "truth": found.truth.source,
        "channels": channels,
        "not_given": found.measured.absent,
        "shift": late,
        "requirements": [vars(row) for row in rows if row.metric == "requirement"],
        "sentences": sentences(found, rows),
    }
