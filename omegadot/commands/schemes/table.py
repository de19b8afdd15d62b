"""The tables of a study, as rows of text: schemes, orders, one-step defects."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from omegadot.diagnosis.scheme_study.record import Record
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reports.text.numbers import short
from omegadot.reports.text.text_grid import Grid
from omegadot.written import written

# Kinds of which one stands for both: damping adds nothing to the name where they agree.
PAIRS = (("free", "damped"), ("pivoted", "pivoted-damped"))


def answered(integrator: Record) -> dict[str, Any]:
    """The probes that an integrator answered, by kind."""
    return {kind: p for kind, p in integrator["probes"].items() if p["outcome"] == "ok"}


def kinds_text(kinds: list[str]) -> str:
    """Kinds as text; a pair in full goes by the name of its first."""
    second = {pair[1] for pair in PAIRS if set(pair) <= set(kinds)}
    return ", ".join(kind for kind in kinds if kind not in second)


def labelled(parts: list[tuple[list[str], str]]) -> str:
    """Texts by kind; the first stands for the rest and goes without its kinds."""
    texts = [
        text if n == 0 else f"{kinds_text(kinds)}: {text}" for n, (kinds, text) in enumerate(parts)
    ]
    return "; ".join(texts) or "–"


def range_of(orders: Iterable[float | None]) -> str:
    """0.95–1.02 of the orders seen, or 1.00 where both ends are the same to two digits."""
    seen = [order for order in orders if order is not None]
    ends = [f"{end:.2f}" for end in (min(seen), max(seen))] if seen else ["–"]
    return "–".join(dict.fromkeys(ends))


def orders_cell(integrator: Record, channel: str) -> str:
    """Declared and observed order, probes together that were declared and judged alike."""
    groups: dict[tuple[int | None, str], dict[str, float | None]] = {}
    for kind, probe in answered(integrator).items():
        order = probe["orders"][channel]
        groups.setdefault((order["declared"], order["verdict"]), {})[kind] = order["order"]
    return labelled(
        [(list(seen), _order(*judged, range_of(seen.values()))) for judged, seen in groups.items()]
    )


def _order(declared: int | None, verdict: str, figures: str) -> str:
    if verdict == "conserved":
        return "conserved"
    promised = "conserved" if declared is None else str(declared)
    if verdict == "floor":
        return f"{promised} (rounding alone)"
    return f"{promised} ({figures})" if verdict == "holds" else f"{promised} ({figures}, {verdict})"


def largest_defect(integrator: Record, channel: str) -> Record | None:
    """The defect largest above rounding over the probes."""
    defects = [p["defects"][channel] for p in answered(integrator).values()]
    above = [d for d in defects if d["value"] is not None and d["kind"] != "floor"]
    return max(above, key=lambda defect: float(defect["value"]), default=None)


def defects_cell(integrator: Record, channel: str) -> str:
    """The largest over the probes, each a mean over its starts, with its order there."""
    defect = largest_defect(integrator, channel)
    if defect is None:
        return "rounding alone" if answered(integrator) else "–"
    order = "" if defect["order"] is None else f", {defect['order']:.2f}"
    unsettled = "" if defect["kind"] == "settled" else " unresolved"
    return f"{short(defect['value'])}{order}{unsettled}"


HEADS = tuple(channel.replace("_", " ") for channel in CHANNELS)


def tables_of(record: Record) -> list[Grid]:
    """Three tables, a row an integrator."""
    who = ("engine", "integrator")
    angle = written(record["defect_angle"])
    schemes, orders, defects = (
        list[tuple[str, ...]](),
        list[tuple[str, ...]](),
        list[tuple[str, ...]](),
    )
    title = f"One-step defect at a step of {angle} rad, and its order"
    for engine in record["engines"]:
        for integrator in engine["integrators"]:
            label = (f"{engine['name']} {engine['version']}", integrator["name"])
            namings = [(list(n["kinds"]), _named(n)) for n in integrator["schemes"]]
            found = (_point(integrator), _match(record, integrator), _declared(integrator))
            schemes.append((*label, labelled(namings), *found))
            orders.append((*label, *(orders_cell(integrator, c) for c in CHANNELS)))
            defects.append((*label, *(defects_cell(integrator, c) for c in CHANNELS)))
    return [
        Grid("Schemes", (*who, "scheme", "stepped in", "match", "declared"), schemes),
        Grid("Orders: declared (observed)", (*who, *HEADS), orders),
        Grid(title, (*who, *HEADS), defects),
    ]


def _named(naming: Record) -> str:
    others = f" (or {', '.join(naming['others'])})" if naming["others"] else ""
    return f"{naming['scheme'] or 'unknown'}{others}"


def _point(integrator: Record) -> str:
    """What of a free body with an offset is stepped, the one kind that shows it."""
    free = integrator["probes"].get("free", {"matches": []})
    ways = dict.fromkeys(match["coordinates"] for match in free["matches"])
    return " or ".join(ways) or "–"


def _match(record: Record, integrator: Record) -> str:
    """How closely, over how many steps; of an unknown scheme the order and the defect."""
    names = {kind: n["scheme"] for n in integrator["schemes"] for kind in n["kinds"]}
    matches = [(names[k], m) for k, p in answered(integrator).items() for m in p["matches"]]
    # The match of each probe under the name that it was given.
    chosen = [match for name, match in matches if match["scheme"] == name]
    texts = []
    if chosen:
        # Rounding differs from machine to machine, its decade hardly.
        worst = max(match["residual"] for match in chosen)
        steps = max(match["steps"] for match in chosen)
        texts.append(f"to {decade_above(worst)} over {steps} steps")
    if any(naming["scheme"] is None for naming in integrator["schemes"]):
        angle = written(record["defect_angle"])
        orders = [p["orders"] for p in answered(integrator).values()]
        seen = [f"{c} {range_of(o[c]['order'] for o in orders)}" for c in ("omega", "attitude")]
        defect = largest_defect(integrator, "attitude")
        size = f"defect {short(defect['value'])} rad in attitude" if defect else "no defect"
        texts.append(f"unknown: order {', '.join(seen)}; one step of {angle} rad: {size}")
    return "; ".join(texts) or "–"


def _declared(integrator: Record) -> str:
    probes = answered(integrator)
    wrong = {k: p["declared"] for k, p in probes.items() if p["as_declared"] is False}
    if wrong:
        names = sorted(set(wrong.values()))
        return f"NOT as declared: {', '.join(names)} ({kinds_text(list(wrong))})"
    if any(p["as_declared"] is None for p in probes.values()):
        return "no scheme declared"
    return "as declared" if probes else "–"


def decade_above(value: float) -> str:
    """The power of ten at or above a residual: 1e-13 of 2.4e-14; 0 of nothing."""
    return "0" if value == 0.0 else f"1e{math.ceil(math.log10(value))}"


def remarks_of(record: Record) -> list[str]:
    """One line for whatever did not answer, and for whatever is not as declared."""
    lines = []
    for engine in record["engines"]:
        if engine["outcome"] != "ok":
            lines.append(f"{engine['name']}: {engine['outcome']}: {engine['reason']}")
        elif not engine["integrators"]:
            lines.append(f"{engine['name']} {engine['version']} declares no integrator")
        for integrator in engine["integrators"]:
            label = f"{engine['name']} {engine['version']}, {integrator['name']}"
            for kind, probe in integrator["probes"].items():
                if probe["outcome"] != "ok":
                    lines.append(f"{label}, {kind}: {probe['outcome']}: {probe['reason']}")
            lines += [f"{label}, {clause}" for clause in integrator["departures"]]
    return lines
