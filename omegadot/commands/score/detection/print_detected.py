"""``omegadot score --detect``: the conventions that fit, printed with the options to pass."""

from __future__ import annotations

import math
from pathlib import Path

import typer

from omegadot.commands.score.detection.detect import Detected
from omegadot.commands.score.detection.reading import Reading
from omegadot.reports.record.run_json import dump_json

MOST_SHOWN = 8


def print_detected(found: Detected, trace: Path, scenario: str, *, as_json: bool) -> int:
    """Print which conventions fit, and the options to pass.

    0 where one does, 1 where none or more than one do.
    """
    fitting = found.fitting
    code = 0 if len(fitting) == 1 else 1
    if as_json:
        typer.echo(dump_json(_machine(found, fitting, code)))
    else:
        typer.echo("\n".join(_lines(trace, scenario, found, fitting)))
    return code


def _machine(found: Detected, fitting: list[Reading], code: int) -> dict[str, object]:
    nearest = found.others[0] if found.others else None
    return {
        "exit_code": code,
        "ambiguous": len(fitting) > 1,
        "fitting": [{"options": r.options(), "misfit": r.misfit} for r in fitting],
        "runner_up": nearest and {"options": nearest.options(), "misfit": nearest.misfit},
        "turn": found.turn,
    }


def _lines(trace: Path, scenario: str, found: Detected, fitting: list[Reading]) -> list[str]:
    if not fitting:
        return [
            f"No convention that was tried fits {trace} to {scenario}: "
            "is it a motion of that scenario, from its start?"
        ]
    if len(fitting) > 1:
        return _ambiguous(found, fitting)
    best = fitting[0]
    lines = [
        f"One convention fits; its error is {best.misfit:.1e} of the size of the motion:",
        f"  omegadot score {trace} --scenario {scenario} {' '.join(best.options())}",
    ]
    if found.others:
        second = found.others[0]
        times = second.misfit / best.misfit if best.misfit > 0.0 else math.inf
        lines.append(
            f"The next best is {times:.0e} times as far off ({second.misfit:.1e}): "
            f"{' '.join(_different(second, best))}"
        )
    for part, name in ((best.attitude, "an attitude"), (best.omega, "an angular velocity")):
        if part is None:
            lines.append(f"No columns were found that fit as {name}.")
    return lines


def _ambiguous(found: Detected, fitting: list[Reading]) -> list[str]:
    why = "This motion does not distinguish them"
    if found.turn < 0.1:
        why = f"The body turns by {found.turn:.1e} rad only, too little to distinguish them"
    lines = [f"Ambiguous: {len(fitting)} conventions fit alike. {why}; nothing is guessed."]
    lines += [f"  {' '.join(reading.options())}" for reading in fitting[:MOST_SHOWN]]
    more = len(fitting) - MOST_SHOWN
    return lines + ([f"  and {more} more"] if more > 0 else [])


def _different(second: Reading, best: Reading) -> list[str]:
    own = [option for option in second.options() if option not in best.options()]
    left = [option for option in best.options() if option not in second.options()]
    return own or [f"without {' '.join(left)}"]
