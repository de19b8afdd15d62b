"""The page of several versions of an engine: what changed, in text and charts, offline."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from omegadot.reports.charts.palette import COLOURS, DASHES
from omegadot.reports.charts.plot import Frame, LogAxis, Plot, PlotLine
from omegadot.reports.page.templating import asset, environment
from omegadot.reports.record.whole_file import PAGE_MARK, write_whole
from omegadot.reports.text.numbers import plain, short
from omegadot.reports.versions.sheet import sheet_of

Record = dict[str, Any]
_FRAME = Frame(width=720, height=260, left=64, right=12, top=12, bottom=46)
LEAST = 1e-17  # an error of zero is drawn here


def draw_versions(record: Record) -> str:
    """The page as HTML."""
    template = environment().get_template("versions.html.j2")
    return template.render(
        record=record,
        sheet=sheet_of(record),
        charts=[] if record["bisect"] else _charts(record),
        css=asset("report.css") + asset("plot.css"),
    )


def write_versions(record: Record, folder: Path) -> None:
    """``versions.json`` and ``versions.html``, each whole or not at all. Raises RecordError."""
    write_whole(folder / "versions.json", json.dumps(record, indent=2) + "\n", '"omegadot":')
    write_whole(folder / "versions.html", draw_versions(record), PAGE_MARK)


def _charts(record: Record) -> list[Plot]:
    """The largest error in attitude by version, on a logarithmic scale."""
    known = [version for version in record["versions"] if version["outcome"] == "ok"]
    names = list(dict.fromkeys(name for version in known for name in version["integrators"]))
    return [chart for case in record["cases"] if (chart := _chart(case, known, names))]


def _error(version: Record, case: Record, name: str) -> float | None:
    metric = f"drift:{case['name']}:{name}:{plain(case['timestep'])}:attitude"
    figure = version["figures"].get(metric) or {}
    value = figure.get("value")
    return max(float(value), LEAST) if isinstance(value, float | int) else None


def _chart(case: Record, known: Sequence[Record], names: Sequence[str]) -> Plot | None:
    errors = {name: [_error(version, case, name) for version in known] for name in names}
    values = [math.log10(e) for line in errors.values() for e in line if e is not None]
    if not values:
        return None
    low, high = math.floor(min(values)), max(math.ceil(max(values)), math.floor(min(values)) + 1)
    y = LogAxis(low, high, _FRAME.height - _FRAME.bottom, _FRAME.top)
    across = (_FRAME.width - _FRAME.left - _FRAME.right) / max(1, len(known))
    places = [round(_FRAME.left + across * (n + 0.5), 1) for n in range(len(known))]
    lines = []
    for number, name in enumerate(names):
        marks = [
            (x, y.at(error), f"{name}, {version['version']}: {short(error)} rad")
            for x, version, error in zip(places, known, errors[name], strict=True)
            if error is not None
        ]
        colour, dash = COLOURS[number % len(COLOURS)], DASHES[number % len(DASHES)]
        lines.append(PlotLine(name, colour, dash, _path(marks, across), marks))
    return Plot(
        f"{case['title']}, steps of {plain(case['timestep'])} s: largest error in attitude, rad",
        _FRAME,
        lines,
        [(x, version["version"]) for x, version in zip(places, known, strict=True)],
        y.ticks((high - low) // 6),
    )


def _path(marks: Sequence[tuple[float, float, str]], across: float) -> str:
    """Lines between neighbouring versions; a version without a figure breaks the line."""
    pieces: list[str] = []
    before = -math.inf
    for x, y, _ in marks:
        joined = x - before <= 1.01 * across
        pieces.append(f"{'L' if joined else 'M'}{x} {y}")
        before = x
    return " ".join(pieces)
