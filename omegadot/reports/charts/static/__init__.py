"""The charts of a run as pictures for papers and slides: SVG and PNG."""

from omegadot.reports.charts.static.write import write_figures

__all__ = ["write_figures"]
