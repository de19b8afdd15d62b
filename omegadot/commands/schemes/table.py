"""The tables of a study, as rows of text: schemes, orders, one-step defects."""

from __future__ import annotations

import math
from dataclasses import dataclass

from omegadot.commands.schemes.cells import (
    answered,
    defects_cell,
    kinds_text,
    labelled,
    largest_defect,
    orders_cell,
    orders_seen,
    range_of,
)
from omegadot.diagnosis.scheme_study.record import Record
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reports.text.numbers import short

HEADS = tuple(channel.replace("_", " ") for channel in CHANNELS)


@dataclass(frozen=True)
class Table:
    """A title, the heads of the columns, and the rows."""

    title: str
    heads: tuple[str, ...]
    rows: list[tuple[str, ...]]


def tables_of(record: Record) -> list[Table]:
    """Three tables, a row an integrator."""
    who = ("engine", "integrator")
    angle = f"{record['defect_angle']:g}"
    schemes = Table("Schemes", (*who, "scheme", "stepped in", "match", "declared"), [])
    orders = Table("Orders: declared (observed)", (*who, *HEADS), [])
    title = f"One-step defect at a step of {angle} rad, and its order"
    defects = Table(title, (*who, *HEADS), [])
    for engine in record["engines"]:
        for integrator in engine["integrators"]:
            label = (f"{engine['name']} {engine['version']}", integrator["name"])
            namings = [(list(n["kinds"]), _named(n)) for n in integrator["schemes"]]
            found = (_point(integrator), _match(record, integrator), _declared(integrator))
            schemes.rows.append((*label, labelled(namings), *found))
            orders.rows.append((*label, *(orders_cell(integrator, c) for c in CHANNELS)))
            defects.rows.append((*label, *(defects_cell(integrator, c) for c in CHANNELS)))
    return [schemes, orders, defects]


def _named(naming: Record) -> str:
    others = f" (or {', '.join(naming['others'])})" if naming["others"] else ""
    return f"{naming['scheme'] or 'unknown'}{others}"


def _chosen(integrator: Record) -> list[Record]:
    """The match of each probe under the name that it was given."""
    names = {kind: n["scheme"] for n in integrator["schemes"] for kind in n["kinds"]}
    matches = [(names[k], m) for k, p in answered(integrator).items() for m in p["matches"]]
    return [match for name, match in matches if match["scheme"] == name]


def _point(integrator: Record) -> str:
    """What of a free body with an offset is stepped, the one kind that shows it."""
    free = integrator["probes"].get("free", {"matches": []})
    ways = dict.fromkeys(match["coordinates"] for match in free["matches"])
    return " or ".join(ways) or "–"


def _match(record: Record, integrator: Record) -> str:
    """How closely, over how many steps; of an unknown scheme the order and the defect."""
    chosen = _chosen(integrator)
    texts = []
    if chosen:
        # Rounding differs from machine to machine, its decade hardly.
        worst = max(match["residual"] for match in chosen)
        steps = max(match["steps"] for match in chosen)
        texts.append(f"to {decade_above(worst)} over {steps} steps")
    if any(naming["scheme"] is None for naming in integrator["schemes"]):
        angle = f"{record['defect_angle']:g}"
        seen = ", ".join(
            f"{c} {range_of(orders_seen(integrator, c))}" for c in ("omega", "attitude")
        )
        texts.append(f"unknown: order {seen}; one step of {angle} rad: {_attitude(integrator)}")
    return "; ".join(texts) or "–"


def _attitude(integrator: Record) -> str:
    value, _ = largest_defect(integrator, "attitude")
    return "no defect" if value is None else f"defect {short(value)} rad in attitude"


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
        for integrator in engine["integrators"]:
            label = f"{engine['name']} {engine['version']}, {integrator['name']}"
            for kind, probe in integrator["probes"].items():
                if probe["outcome"] != "ok":
                    lines.append(f"{label}, {kind}: {probe['outcome']}: {probe['reason']}")
            lines += [f"{label}, {clause}" for clause in integrator["departures"]]
    return lines
