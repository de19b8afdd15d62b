"""Time a step, in rounds over all versions, so that a machine's moods fall on them alike."""

from __future__ import annotations

import statistics
from dataclasses import dataclass

from omegadot.commands.versions.measure import Portrait
from omegadot.commands.versions.requests import load
from omegadot.diagnosis.scheme_study.subject import NoAnswerError
from omegadot.gates.case import Case
from omegadot.workers.harness_end.process import WorkerProcess

ROUNDS, REPEATS = 3, 4


def time_steps(portrait: Portrait, worker: WorkerProcess, case: Case) -> None:
    """Several timings of each integrator on a case, added to those of earlier rounds, s a step."""
    sweep = case.sweeps[0]
    plan = {"timestep": sweep.timestep, "steps": sweep.steps, "every": sweep.steps}
    try:
        load(worker, case.system)
    except NoAnswerError:
        return
    for name in portrait.integrators:
        for _ in range(REPEATS):
            answer = worker.request("run", initial=case.initial, integrator=name, **plan)
            if not answer.ok:
                break
            portrait.speeds.setdefault(name, []).append(float(answer.result["seconds_per_step"]))


@dataclass(frozen=True)
class Pace:
    """Seconds a step: the median of some timings, the least and the greatest."""

    median: float
    least: float
    most: float


def pace_of(timings: list[float]) -> Pace | None:
    """None of no timings."""
    return Pace(statistics.median(timings), min(timings), max(timings)) if timings else None


@dataclass(frozen=True)
class Ratio:
    """Time a step over that of an earlier version. apart: the two spreads do not touch."""

    value: float
    least: float
    most: float
    apart: bool


def ratio_of(earlier: Pace, later: Pace) -> Ratio:
    """The ratio of the medians, and the range that the spreads allow."""
    least, most = later.least / earlier.most, later.most / earlier.least
    apart = later.least > earlier.most or later.most < earlier.least
    return Ratio(later.median / earlier.median, least, most, apart)
