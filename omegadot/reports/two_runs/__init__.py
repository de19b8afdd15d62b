"""Two records compared: what got better, worse, appeared and vanished."""

from omegadot.reports.two_runs.comparison import Comparison, compare_records

__all__ = ["Comparison", "compare_records"]
