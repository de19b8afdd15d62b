"""From a finished run to its record: which engines ran, on what, with what outcome."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from typing import Any

import numpy as np

from omegadot import __version__
from omegadot.adapters.registry import PROGRAM, registered
from omegadot.diagnosis.clusters import clusters_of_run
from omegadot.diagnosis.over_engines import causes_over
from omegadot.gates.case import Case
from omegadot.harness.collect import metrics_of_run, tasks_of_run, trajectories_of_run
from omegadot.harness.outcome import Cause, EngineCase, JudgedCase, Outcome, RunRequest
from omegadot.harness.plan import EngineChoice
from omegadot.harness.python_path import setting_for
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import SCHEMA
from omegadot.workers.machine import describe_machine, package_versions


def record_of(
    outcome: Outcome,
    request: RunRequest,
    command: Sequence[str],
    seconds: float,
    causes: bool = True,
) -> Record:
    """The record of a finished or interrupted run. causes: whether those of failures are sought."""
    sought = causes_over(outcome.cases, request.seed) if causes else _no_causes
    now = datetime.datetime.now(datetime.UTC).replace(microsecond=0)
    run = {
        "schema": SCHEMA,
        "omegadot": __version__,
        "created": now.isoformat(),
        "command": list(command),
        "seed": request.seed,
        "seconds": round(seconds, 3),
        "complete": not outcome.interrupted,
        "machine": describe_machine(),
        "versions": package_versions(),
        "engines": _engines(outcome),
        "scenarios": [_scenario(case) for case in request.cases],
        "worker_deaths": [{"engine": name, "how": how} for name, how in outcome.deaths],
        "clusters": [vars(cluster) for cluster in clusters_of_run(outcome.cases)],
        "tasks": tasks_of_run(outcome, list(request.cases), request.setup, sought),
    }
    setup = request.setup
    return Record(run, metrics_of_run(outcome, setup), trajectories_of_run(outcome, setup))


def _no_causes(judged: JudgedCase, found: EngineCase) -> Cause:
    return lambda run: ""


def _engines(outcome: Outcome) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    for engine in outcome.engines:
        own = engine.description
        integrators = [vars(integrator) for integrator in own.integrators]
        parts = {"integrators": integrators, "features": sorted(own.features)}
        named = {"name": engine.name, "installed": True, "reason": ""}  # as the tasks name it
        ways = {"via": engine.choice.via or "api", "argument": _argument(engine.choice)}
        path = {"environment": setting_for(engine.choice.target)}
        found.append({**vars(own), **named, **parts, **ways, **path})
    for choice, answer in outcome.missing:
        found.append({"name": choice.name, "installed": False, "reason": answer.reason})
    return found


def _argument(choice: EngineChoice) -> str:
    """What `check` takes for an engine: its name, or the class or program of one's own."""
    if registered().get(choice.engine) == choice.target:
        return choice.engine
    return choice.target.removeprefix(PROGRAM)


def _scenario(case: Case) -> dict[str, Any]:
    scenario = case.scenario
    system = {**vars(case.system.body), **vars(case.system.load)}
    return {
        "name": scenario.name,
        "title": scenario.title,
        "shows": scenario.shows,
        "source": scenario.source,
        "definition": scenario.to_dict(),
        "system": {k: None if v is None else np.asarray(v).tolist() for k, v in system.items()},
    }
