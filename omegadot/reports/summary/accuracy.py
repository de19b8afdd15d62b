"""Where every gate holds and an error is large all the same: how large, and what to do about it."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.advice import Advice
from omegadot.reports.summary.figures import Figure, Range, size
from omegadot.reports.summary.provenance import requested_scenarios
from omegadot.reports.text.numbers import angle, knob, short

# What few users of a simulator want, whatever they simulate: each stands in the command as well.
LARGEST_ANGLE, LARGEST_DRIFT = math.radians(1.0), 0.01


def inaccurate(
    run: Mapping[str, Any], attitudes: Iterable[Range | None], drifts: Iterable[Range | None]
) -> Advice | None:
    """What is to be known where the attitude error or the drift of a sound run is large.

    run: ``run.json``.  attitudes and drifts: of the engines that pass, by scenario. An error may be
    wholly that of the scheme and the step, and so pass; that does not make it small.
    """
    found = _largest(attitudes, LARGEST_ANGLE)
    option, what = "--attitude 1deg", "is off by {}"
    text: Callable[[float], str] = angle
    if found is None:
        found = _largest(drifts, LARGEST_DRIFT)
        option, what, text = "--momentum-drift 0.01", "has an angular momentum off by {}", _percent
    if found is None:
        return None
    worst, best = found
    parts = [f"{_run(worst)} {what.format(text(worst.value))}"]
    if _run(best) != _run(worst):
        parts.append(f"{_run(best)} by {text(best.value)}")
    scenario = requested_scenarios(run).get(worst.scenario, worst.scenario)
    return Advice(
        f"Sound, not necessarily accurate: on {worst.scenario} {', '.join(parts)}.",
        " ".join(["omegadot choose", shlex.quote(scenario), option, *_engines(run)]),
        "finds an engine and a step that suffice",
    )


def _largest(ranges: Iterable[Range | None], limit: float) -> tuple[Figure, Figure] | None:
    """The largest error above the limit, and the least on the same scenario."""
    given = [one for one in ranges if one is not None]
    worst = max((one.worst for one in given), key=size, default=None)
    if worst is None or not size(worst) > limit:
        return None
    here = (one.best for one in given if one.best.scenario == worst.scenario)
    return worst, min(here, key=size)


def _percent(value: float) -> str:
    return f"{short(100.0 * value)} %"


def _run(figure: Figure) -> str:
    step = knob(figure.timestep, figure.accuracy)
    name = " ".join(filter(None, (figure.engine, figure.integrator)))
    return f"{name}, {step}," if step else name


def _engines(run: Mapping[str, Any]) -> list[str]:
    """Engines of the reader's own, which no command knows by itself; and a single one by name."""
    ours = [e for e in run["engines"] if e["name"] not in YARDSTICKS and e.get("argument")]
    own = [e["argument"] for e in ours if e["argument"] != e["name"]]
    found = [text for argument in own for text in ("--adapter", shlex.quote(argument))]
    return found + (["--engine", shlex.quote(ours[0]["name"])] if len(ours) == 1 else [])
