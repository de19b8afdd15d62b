"""The page of several versions of an engine: what changed, in text and charts, offline."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from omegadot.reports.page.templating import asset, environment
from omegadot.reports.record.whole_file import write_whole
from omegadot.reports.versions.chart import charts_of
from omegadot.reports.versions.sheet import sheet_of


def draw_versions(record: dict[str, Any]) -> str:
    """The page as HTML."""
    template = environment().get_template("versions.html.j2")
    return template.render(
        record=record,
        sheet=sheet_of(record),
        charts=[] if record["bisect"] else charts_of(record),
        css=asset("report.css") + asset("plot.css"),
    )


def write_versions(record: dict[str, Any], folder: Path) -> None:
    """``versions.json`` and ``versions.html``, each whole or not at all. Raises RecordError."""
    write_whole(folder / "versions.json", json.dumps(record, indent=2) + "\n")
    write_whole(folder / "versions.html", draw_versions(record))
