"""Every picture of a run, written as SVG and PNG, each whole or not at all."""

from __future__ import annotations

import os
import re
import secrets
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from omegadot.reports.charts.static.charts import Charts, charts_of
from omegadot.reports.charts.static.style import RC, require_matplotlib
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import RecordError
from omegadot.reports.record.whole_file import check_target

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("svg", "png")
_LONGEST = 60
# Devices, on systems where no file may be called so.
_DEVICES = re.compile(r"^(con|prn|aux|nul|com\d|lpt\d)$")


def write_figures(record: Record, folder: Path) -> list[Path]:
    """Draw every scenario's charts into `folder`, as SVG and PNG; returns the paths.

    ``SCENARIO-CHART.svg``, with CHART one of omega-dot, energy, angular-momentum, linear-momentum,
    attitude, convergence and work-precision; a chart that has nothing to show is left out. The
    same record gives the same bytes. Raises RecordError: no matplotlib, nothing to draw, or a
    folder that cannot be written.
    """
    require_matplotlib()
    import matplotlib

    charts = charts_of(record)
    if not charts:
        raise RecordError("--figures: the record holds no trajectories to draw; give another run.")
    stems = file_stems(chart.name for chart in charts)
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with matplotlib.rc_context(cast(Any, RC)), warnings.catch_warnings():
            # A name may hold letters that the font has not; they become boxes, and that is all.
            warnings.filterwarnings("ignore", message="Glyph .* missing from")
            for chart in charts:
                for kind, figure in _figures(chart):
                    written += _save(figure, folder, f"{stems[chart.name]}-{kind}")
    except OSError as error:
        reason = error.strerror or str(error)
        raise RecordError(f"{folder}: the figures cannot be written ({reason}).") from error
    return written


def file_stems(names: Iterable[str]) -> dict[str, str]:
    """The start of the file names of each scenario: plain letters, digits and hyphens, unique."""
    stems: dict[str, str] = {}
    taken: set[str] = set()
    for place, name in enumerate(names, 1):
        stem = re.sub(r"[^a-z0-9]+", "-", name.lower())[:_LONGEST].strip("-")
        if not stem or _DEVICES.match(stem) or stem in taken:
            stem = f"{stem}-{place}".lstrip("-") if stem else f"scenario-{place}"
        while stem in taken:
            stem += "-x"
        taken.add(stem)
        stems[name] = stem
    return stems


def _figures(charts: Charts) -> list[tuple[str, Figure]]:
    from omegadot.reports.charts.static import deviations as all_series
    from omegadot.reports.charts.static import sweeps

    drawn = {c.replace("_", "-"): all_series.draw(charts, c) for c in charts.chart.units}
    drawn["convergence"] = sweeps.draw_convergence(charts)
    drawn["work-precision"] = sweeps.draw_work_precision(charts)
    return [(kind, figure) for kind, figure in drawn.items() if figure is not None]


def _save(figure: Figure, folder: Path, stem: str) -> list[Path]:
    """Write both formats under other names, then give them theirs. Raises RecordError."""
    found = []
    for form in FORMATS:
        target = folder / f"{stem}.{form}"
        check_target(target, "omegadot")
        fresh = folder / f".{stem}.{secrets.token_hex(4)}.{form}"
        # Neither a date nor the library's version: the same record is the same file.
        nothing = (
            {"Date": None, "Creator": "omegadot"} if form == "svg" else {"Software": "omegadot"}
        )
        try:
            figure.savefig(fresh, format=form, metadata=nothing)
            os.replace(fresh, target)
        finally:
            fresh.unlink(missing_ok=True)
        found.append(target)
    return found
