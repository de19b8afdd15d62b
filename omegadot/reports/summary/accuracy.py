"""Where every gate holds and an error is large all the same: how large, and what to do about it."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.advice import Advice
from omegadot.reports.summary.figures import Figure, Range, size
from omegadot.reports.summary.orders import declared_orders
from omegadot.reports.summary.provenance import requested_scenarios
from omegadot.reports.text.numbers import angle, knob, plain, short

# What few users of a simulator want, whatever they simulate: each stands in the command as well.
LARGEST_ANGLE, LARGEST_DRIFT = math.radians(1.0), 0.01
_MANY = 4  # engines of one order that are named; of more, the least accurate one


def inaccurate(
    run: Mapping[str, Any], attitudes: Iterable[Range | None], drifts: Iterable[Range | None]
) -> Advice | None:
    """What is to be known where the attitude error or the drift of a sound run is large.

    run: ``run.json``.  attitudes and drifts: of the engines that pass, by scenario. An error may be
    wholly that of the scheme and the step, and so pass; that does not make it small.
    """
    found = _largest(attitudes, LARGEST_ANGLE)
    option, what = "--attitude 1deg", "is off"
    text: Callable[[float], str] = angle
    if not found:
        found = _largest(drifts, LARGEST_DRIFT)
        option, what, text = "--momentum-drift 0.01", "has an angular momentum off", _percent
    if not found:
        return None
    orders = declared_orders(run["engines"])
    groups: dict[float | None, list[Figure]] = {}
    for figure in sorted(found, key=size, reverse=True):
        order = orders.get((figure.engine, figure.integrator or ""))
        groups.setdefault(order, []).append(figure)
    parts = [_part(order, own, text) for order, own in groups.items()]
    off = "; ".join(parts).replace(") by ", f") {what} by ", 1)
    name, knobs = found[0].scenario, {knob(one.timestep, one.accuracy) for one in found}
    at = f", {knobs.pop()}," if len(knobs) == 1 and all(knobs) else ""
    worst = next(iter(groups))
    scheme = "that scheme" if worst is None else f"order {plain(worst)}"
    of_step = any(one.timestep for one in groups[worst])
    reason = f"The reason is the {'step' if of_step else 'accuracy'}, too coarse for {scheme} here"
    scenario = requested_scenarios(run).get(name, name)
    return Advice(
        f"Sound, not necessarily accurate: on {name}{at} {off}. {reason}; the equations hold.",
        " ".join(["omegadot choose", shlex.quote(scenario), option, *_engines(run)]),
        "finds an engine and a step that suffice",
    )


def _part(order: float | None, figures: Sequence[Figure], text: Callable[[float], str]) -> str:
    """An order with the worst integrator of each engine, and its largest error.

    figures: the largest first.
    """
    lost = [figure for figure in figures if not math.isfinite(figure.value)]
    own = {figure.engine: figure for figure in reversed(lost or figures)}
    names = [_run(figure) for figure in sorted(own.values(), key=size, reverse=True)]
    if len(names) > _MANY:
        names = [f"{len(names)} engines", f"{names[0]} is worst"]
    whose = "undeclared order" if order is None else f"order {plain(order)}"
    if lost:
        return f"{whose} ({', '.join(names)}) leaves the range of numbers"
    most = "up to " if len({text(figure.value) for figure in figures}) > 1 else ""
    return f"{whose} ({', '.join(names)}) by {most}{text(figures[0].value)}"


def _largest(ranges: Iterable[Range | None], limit: float) -> list[Figure]:
    """Every integrator's error on the scenario of the largest; none where that is not above."""
    given = [one for one in ranges if one is not None]
    worst = max((one.worst for one in given), key=size, default=None)
    if worst is None or not size(worst) > limit:
        return []
    return [figure for one in given for figure in one.all if figure.scenario == worst.scenario]


def _percent(value: float) -> str:
    return f"{short(100.0 * value)} %"


def _run(figure: Figure) -> str:
    return " ".join(filter(None, (figure.engine, figure.integrator)))


def _engines(run: Mapping[str, Any]) -> list[str]:
    """Engines of the reader's own, which no command knows by itself.

    None is singled out: it may be another that suffices.
    """
    ours = [e for e in run["engines"] if e["name"] not in YARDSTICKS and e.get("argument")]
    own = [e["argument"] for e in ours if e["argument"] != e["name"]]
    return [text for argument in own for text in ("--adapter", shlex.quote(argument))]
