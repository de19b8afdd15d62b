"""What people read for a channel and a metric."""

import pytest

from omegadot.reports.text.metric_names import measure_name


@pytest.mark.parametrize(
    ("channel", "metric", "expected"),
    [
        ("time", "time shift", "time shift"),
        ("time", "flip time error", "flip time error"),
        ("time", "sample times", "sample times"),
        ("omega-dot", "omega dot", "omega dot"),
        ("model", "mass", "mass"),
        ("attitude", "error max", "attitude error max"),
        ("", "observed order", "observed order"),
    ],
)
def test_no_term_stands_twice(channel, metric, expected):
    """Caught: "trajectory: time time shift"."""
    assert measure_name(channel, metric) == expected
