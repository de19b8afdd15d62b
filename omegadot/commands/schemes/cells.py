"""The cells of a study's tables: figures over several probes, in short."""

from __future__ import annotations

from typing import Any

from omegadot.diagnosis.scheme_study.record import Record
from omegadot.reports.text.numbers import short

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


def orders_seen(integrator: Record, channel: str) -> list[float]:
    """The observed orders of one channel, of every probe that shows one."""
    orders = [p["orders"][channel]["order"] for p in answered(integrator).values()]
    return [order for order in orders if order is not None]


def range_of(values: list[float]) -> str:
    """0.95–1.02, or 1.00 where both ends are the same to two digits."""
    ends = [f"{end:.2f}" for end in (min(values), max(values))] if values else ["–"]
    return "–".join(dict.fromkeys(ends))


def orders_cell(integrator: Record, channel: str) -> str:
    """Declared and observed order, probes together that were declared and judged alike."""
    groups: dict[tuple[int | None, str], list[str]] = {}
    probes = answered(integrator)
    for kind, probe in probes.items():
        order = probe["orders"][channel]
        groups.setdefault((order["declared"], order["verdict"]), []).append(kind)
    parts = []
    for (declared, verdict), kinds in groups.items():
        seen = [probes[kind]["orders"][channel]["order"] for kind in kinds]
        figures = range_of([order for order in seen if order is not None])
        parts.append((kinds, _order(declared, verdict, figures)))
    return labelled(parts)


def _order(declared: int | None, verdict: str, figures: str) -> str:
    if verdict == "conserved":
        return "conserved"
    promised = "conserved" if declared is None else str(declared)
    if verdict == "floor":
        return f"{promised} (rounding alone)"
    return f"{promised} ({figures})" if verdict == "holds" else f"{promised} ({figures}, {verdict})"


def largest_defect(integrator: Record, channel: str) -> tuple[float | None, Record]:
    """The defect largest above rounding over the probes, and all that is known of it."""
    defects = [p["defects"][channel] for p in answered(integrator).values()]
    known = [defect for defect in defects if defect["value"] is not None]
    above = [defect for defect in known if defect["kind"] != "floor"]
    if not above:
        return None, {}
    largest = max(above, key=lambda defect: float(defect["value"]))
    return largest["value"], largest


def defects_cell(integrator: Record, channel: str) -> str:
    """The largest over the probes, each a mean over its starts, with its order there."""
    value, defect = largest_defect(integrator, channel)
    if value is None:
        return "rounding alone" if answered(integrator) else "–"
    order = "" if defect["order"] is None else f", {defect['order']:.2f}"
    unsettled = "" if defect["kind"] == "settled" else " unresolved"
    return f"{short(value)}{order}{unsettled}"
