"""What changed from one version to the next, in few lines, out of the record alone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from operator import itemgetter
from typing import Any

from omegadot.reports.text.numbers import listed, times

Record = dict[str, Any]
Line = tuple[str, str]  # the subject, and the text
ARROW = "→"
MOST_DRIFTS = 3
RATIO = "energy ratio E/E0"  # the last part of a metric's name that stands for E/E0
_PLAIN = ("convention", "default", "setup", "equation")


def lines_of(changes: Sequence[Record]) -> list[Line]:
    """Conventions, defaults, integrators; then the scheme, orders and drifts of each integrator."""
    found = [line for change in changes for line in _plain(change)]
    integrators = dict.fromkeys(c["integrator"] for c in changes if c["integrator"])
    for integrator in integrators:
        own = [change for change in changes if change["integrator"] == integrator]
        for report in (_schemes, _orders, _drifts):
            found += [(integrator, text) for text in report(own)]
    return found


def _plain(change: Record) -> list[Line]:
    kind, name = change["kind"], ", ".join(change["name"][1:]).replace("_", " ")
    if kind == "integrator":
        return [(name, f"the integrator {'vanishes' if change['after'] is None else 'appears'}")]
    return [(kind, f"{name}: {_from_to(change)}")] if kind in _PLAIN else []


def _text(figure: Record | None) -> str:
    return "none" if figure is None else str(figure["text"])


def _from_to(change: Record) -> str:
    return f"{_text(change['before'])} {ARROW} {_text(change['after'])}"


def _grouped(changes: Iterable[Record], texts: Any) -> dict[str, list[Record]]:
    groups: dict[str, list[Record]] = {}
    for change in changes:
        groups.setdefault(texts(change), []).append(change)
    return groups


def _schemes(changes: Sequence[Record]) -> list[str]:
    own = [change for change in changes if change["kind"] == "scheme"]
    groups = _grouped(own, _from_to)
    return [
        f"scheme on {listed([change['name'][2] for change in group])} bodies: {text}"
        for text, group in groups.items()
    ]


def _whole(figure: Record | None) -> str:
    """An order as the whole number that it stands for."""
    if figure is None or not isinstance(figure["value"], float):
        return _text(figure)
    nearest = round(figure["value"])
    close = abs(figure["value"] - nearest) <= figure["band"]
    return str(nearest) if close else str(figure["text"])


def _orders(changes: Sequence[Record]) -> list[str]:
    """One line for each change of order; which channels and bodies it is seen in."""
    own = [change for change in changes if change["kind"] == "order"]
    groups = _grouped(own, lambda c: f"{_whole(c['before'])} {ARROW} {_whole(c['after'])}")
    found = []
    for text, group in groups.items():
        kinds = _grouped(group, lambda change: change["name"][3].replace("_", " "))
        seen = [
            f"{channel} ({', '.join(change['name'][2] for change in members)})"
            for channel, members in kinds.items()
        ]
        found.append(f"order {text} in {listed(seen)}")
    return found


def _drifts(changes: Sequence[Record]) -> list[str]:
    """How many of its errors moved, and the most significant ones: E/E0 first, then the largest."""
    own = [change for change in changes if change["kind"] == "drift"]
    if not own:
        return []
    ratios = [change for change in own if change["name"][-1] == RATIO]
    others = [change for change in own if change not in ratios]
    others.sort(key=lambda change: -(change["size"] or 0.0))
    reported = (ratios + others)[: max(MOST_DRIFTS, len(ratios) + 1)]
    left = len(own) - len(reported)
    more = f", and {left} more" if left else ""
    return [f"{times(len(own), 'error')} changed: {'; '.join(map(_drift, reported))}{more}"]


def _drift(change: Record) -> str:
    _, case, _, step, channel = change["name"]
    what = "E/E0" if channel == RATIO else channel.replace("_", " ")
    return f"{what} on {case} at {step} s {_from_to(change)}"


def pace_text(value: float, least: float, most: float) -> str:
    """A time, or a ratio of times, with its spread."""
    return f"{value:.2f} ({least:.2f}–{most:.2f})"


def pace_lines(step: Record) -> list[Line]:
    """Integrators whose time per step changed beyond the range of the timings."""
    return [
        (name, f"time per step ×{pace_text(ratio['value'], ratio['least'], ratio['most'])}")
        for name, ratio in step["paces"].items()
        if ratio["apart"]
    ]


def runs_of(values: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """(versions, text): neighbours of one text together, as 3.7.0–3.10.0."""
    runs = []
    for text, group in groupby(values, itemgetter(1)):
        versions = [version for version, _ in group]
        runs.append(("–".join(dict.fromkeys((versions[0], versions[-1]))), text))
    return runs
