"""Records in which an engine fails, made from a synthetic one."""

from __future__ import annotations

from dataclasses import replace

from changed_records import FIGURE, edited
from synthetic_record import metric, with_metrics

from omegadot.reports.record.record import Record

FAILING = ("dart", "semi-implicit")


def failing(record: Record, cause: str = "the gyroscopic term is missing") -> Record:
    """DART's equation and its runs on one scenario fail; a later gate by more than the first."""
    where = ("sphere", *FAILING, 0.02)
    rows = (
        metric(*where, "trajectory", "attitude", "error_max", 3.0, verdict="fail"),
        metric(*where, "equation", "omega_dot", "residual", 2e-3, verdict="fail"),
        metric(*where, "equation", "omega_dot", "residual_on_path", 1e-3, verdict="fail"),
        metric(*where, "scheme", "omega", "observed_order", 0.1, verdict="fail"),
    )
    tasks = [
        {**task, "gates": {**task["gates"], "equation": "fail"}, "cause": cause}
        if (task["engine"], task["scenario"]) == ("dart", "sphere")
        else task
        for task in record.run["tasks"]
    ]
    return with_metrics(replace(record, run={**record.run, "tasks": tasks}), *rows)


def failing_in_a_probe(record: Record, **error: object) -> Record:
    """DART's steps fail from a state that its run does not reach; the error that it has is this."""
    where = ("sphere", *FAILING, 0.005)
    row = metric(*where, "scheme", "omega", "rate_at_no_step", 3e8, bound=1.0, verdict="fail")
    return with_metrics(edited(record, where, FIGURE, **error), row)
