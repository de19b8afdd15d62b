"""How the pictures look: one column of a paper wide, engine is colour, integrator is dash."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from omegadot.reports.charts.palette import Line
from omegadot.reports.record.schema import RecordError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# A column is 3.4 in wide in most journals; text must be readable there without being enlarged.
WIDTH, HEIGHT = 3.4, 2.3
LEGEND_ROW = 0.1
DOTS_PER_INCH = 300
GREY, SOFT = "#6b7077", "#b9bec4"
DOTTED = (0, (1.0, 1.2))
# The palette's dashes are px on a screen, these are points on paper.
_PER_PX = 0.45
_LINE = 0.62

RC: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 7.0,
    "axes.labelsize": 7.0,
    "axes.titlesize": 7.5,
    "axes.titlelocation": "left",
    "axes.linewidth": 0.5,
    "axes.edgecolor": GREY,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#e4e6e9",
    "grid.linewidth": 0.4,
    "lines.scale_dashes": False,
    "legend.fontsize": 5.8,
    "legend.frameon": False,
    "legend.handlelength": 3.0,
    "legend.columnspacing": 1.2,
    "legend.labelspacing": 0.25,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "savefig.dpi": DOTS_PER_INCH,
    "path.simplify": True,
    "svg.fonttype": "path",
    "svg.hashsalt": "omegadot",
}


def require_matplotlib() -> None:
    """Raise RecordError, one sentence, where matplotlib cannot be imported."""
    try:
        import matplotlib  # noqa: F401
    except ImportError as error:
        raise RecordError(
            f"--figures: matplotlib is needed and cannot be imported ({error}); "
            "install omegadot[figures]."
        ) from error


def plain_text(text: str) -> str:
    """A name as it is: no formula between dollars, and on one line."""
    return "".join(c if c.isprintable() else " " for c in text).replace("$", r"\$")


def line_style(line: Line) -> dict[str, Any]:
    """Colour, dash and width of an engine's integrator, as on the page."""
    dash = [_PER_PX * float(px) for px in line.dash.split()]
    return {
        "color": line.colour[0],
        "linestyle": (0, tuple(dash)) if dash else "solid",
        "linewidth": _LINE * line.width,
    }


def new_figure(room: float) -> tuple[Figure, Axes]:
    """An empty picture with so many inches of room below its axes."""
    from matplotlib.figure import Figure

    below = 0.44 + room
    height = HEIGHT + below
    figure = Figure(figsize=(WIDTH, height))
    left, right, top = 0.52, 0.1, 0.36
    axes = figure.add_axes(
        (left / WIDTH, below / height, 1.0 - (left + right) / WIDTH, 1.0 - (below + top) / height)
    )
    return figure, axes


_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def log_axis(axis: Any) -> None:
    """Decades as powers of ten, as many as there is room for, without ticks between them."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    def power(value: float, _place: int | None) -> str:
        return "10" + str(round(math.log10(value))).translate(_RAISED)

    axis.set_major_locator(LogLocator(base=10.0, numticks=8))
    axis.set_major_formatter(FuncFormatter(power))
    axis.set_minor_locator(NullLocator())


def title(axes: Axes, name: str, what: str) -> None:
    """What is drawn in bold, and below it the scenario."""
    # Given its height, it is not sought among the ticks at every drawing.
    axes.set_title(what, fontweight="bold", y=1.09, pad=0.0)
    short = name if len(name) <= 62 else name[:61] + "…"
    axes.text(0.0, 1.02, plain_text(short), transform=axes.transAxes, color=GREY, fontsize=6.2)
