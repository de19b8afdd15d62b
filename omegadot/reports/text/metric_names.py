"""What a metric of the record is called where people read it."""

from __future__ import annotations

_NAMES = {
    "match": "distance from the scheme",
    "rate_at_no_step": "rate as the step vanishes",
    "residual_alone": "residual at one state by itself",
    "residual_in_run": "residual along the run",
    "residual_of_sibling": "residual after a similar system was loaded",
    "residual_on_path": "residual along the exact motion",
    "residual_reloaded": "residual after another system was loaded",
}


def metric_name(metric: str) -> str:
    """A metric in plain English; one without a name of its own loses its underscores."""
    return _NAMES.get(metric, metric.replace("_", " "))


def residual_name(metric: str) -> str:
    """What tells a residual from that at the given states: along what, or after what; else ""."""
    of_path = metric == "residual_on_path"  # short, as it stands in cells
    text = "along the trajectory" if of_path else metric_name(metric).removeprefix("residual")
    return text.strip() if metric.startswith("residual_") else ""


def measure_name(channel: str, metric: str) -> str:
    """Channel and metric, as people read them, and no term twice: "time shift" of time."""
    if channel == "model" or channel.replace("-", " ") in metric:
        return metric
    return f"{channel} {metric}"
