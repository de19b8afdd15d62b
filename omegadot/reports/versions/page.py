"""The page of several versions of an engine: what changed, in text and charts, offline."""

from __future__ import annotations

from typing import Any

from omegadot.reports.charts.palette import COLOURS
from omegadot.reports.page.templating import asset, environment
from omegadot.reports.versions import chart as versions_chart
from omegadot.reports.versions.chart import charts_of
from omegadot.reports.versions.sheet import sheet_of


def draw_versions(record: dict[str, Any]) -> str:
    """The page as HTML."""
    template = environment().get_template("versions.html.j2")
    names = ("WIDTH", "HEIGHT", "LEFT", "RIGHT", "TOP", "BOTTOM")
    return template.render(
        record=record,
        sheet=sheet_of(record),
        charts=[] if record["bisect"] else charts_of(record),
        size={name.lower(): getattr(versions_chart, name) for name in names},
        colours=COLOURS,
        css=asset("report.css"),
    )
