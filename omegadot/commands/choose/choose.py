"""``omegadot.choose``: engine, integrator and largest step for a requirement."""

from __future__ import annotations

import datetime
import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from omegadot import __version__
from omegadot.commands.choose.chooser import Choice
from omegadot.commands.choose.document import document
from omegadot.commands.choose.licences import check_licences
from omegadot.commands.choose.motion import Motion, cases_of
from omegadot.commands.choose.requirements import merged, read_requirements
from omegadot.commands.choose.result import ChooseResult
from omegadot.commands.progress import Reporting, reporting
from omegadot.commands.typed import typed
from omegadot.harness.arguments import engine_choices, several
from omegadot.harness.engine_target import EngineLike
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError, check_number
from omegadot.reports.record.whole_file import make_folder, path_of
from omegadot.scenarios import ScenarioLike
from omegadot.workers.machine import describe_machine, package_versions

BROKEN = ("crashed", "timeout", "raised")
Quantity = str | float


@typed
def choose(
    scenarios: ScenarioLike | Sequence[ScenarioLike] | None = None,
    engines: EngineLike | Sequence[EngineLike] | None = None,
    *,
    body: str | os.PathLike[str] | None = None,
    allow_impossible_inertia: bool = False,
    angular_velocity: Sequence[float] | None = None,
    orientation: Sequence[float] | None = None,
    duration: Quantity | None = None,
    requirements: str | os.PathLike[str] | None = None,
    attitude: Quantity | None = None,
    omega: Quantity | None = None,
    energy_drift: Quantity | None = None,
    momentum_drift: Quantity | None = None,
    linear_momentum_drift: Quantity | None = None,
    flip_time: Quantity | None = None,
    real_time_factor: Quantity | None = None,
    precision: str | None = None,
    features: str | Sequence[str] = (),
    licences: str | Sequence[str] = (),
    python: str | None = None,
    adapters: EngineLike | Sequence[EngineLike] = (),
    budget: float = 2.0,
    timeout: float = 60.0,
    jobs: int | None = None,
    out: str | os.PathLike[str] | None = None,
    command: Sequence[str] = (),
    progress: Reporting = False,
) -> ChooseResult:
    """Find the engines, integrators and largest steps that meet requirements, cheapest first.

    scenarios, engines, adapters, timeout, jobs, command, progress: as of `run`.
    body: a link, ``FILE#LINK``, in place of the scenario's body, or by itself with
    angular_velocity (rad/s, body axes) and duration.  allow_impossible_inertia: go on with one that
    breaks the triangle inequality.  orientation: a quaternion (w, x, y, z).
    attitude, omega, flip_time, duration: a text with its unit, such as ``"0.1deg"``, or a number in
    rad, rad/s or s.  energy_drift, momentum_drift, linear_momentum_drift: relative.
    requirements: a TOML file of these; what is given here has precedence.
    budget: s that one run of the search may take.  out: a folder for the choice and its page.
    Raises UsageError, ScenarioError, RecordError and NoTruthError.
    """
    started = time.perf_counter()
    requested: dict[str, Any] = {
        "attitude": attitude,
        "omega": omega,
        "energy-drift": energy_drift,
        "momentum-drift": momentum_drift,
        "linear-momentum-drift": linear_momentum_drift,
        "flip-time": flip_time,
        "real-time-factor": real_time_factor,
        "precision": precision,
        "feature": several(features),
        "licence": several(licences),
        "python": python,
        "duration": duration,
    }
    file = read_requirements(path_of(requirements)) if requirements else {}
    wanted = merged(file, requested, str(requirements))
    motion = Motion(
        several(scenarios, "scenarios"),
        None if body is None else os.fspath(body),
        angular_velocity,
        orientation,
        wanted.duration,
        allow_impossible_inertia,
    )
    request = RunRequest(
        cases_of(motion),
        _choices(several(engines, "engines"), several(adapters)),
        timeout=timeout,
        jobs=(os.cpu_count() or 1) if jobs is None else jobs,
    )
    check_number("--budget", budget, 0.0)
    others = engine_choices([], several(adapters))
    check_licences(wanted.licences, {c.name: c for c in (*others, *request.choices)}.values())
    if out is not None:
        make_folder(path_of(out))
    with reporting(progress) as report:
        choice = Choice(request, wanted, budget, report)
        choice.execute()
    now = datetime.datetime.now(datetime.UTC).replace(microsecond=0)
    found = {
        **document(choice),
        "omegadot": __version__,
        "created": now.isoformat(),
        "command": list(command),
        "budget": budget,
        "seconds": round(time.perf_counter() - started, 3),
        "machine": describe_machine(),
        "versions": package_versions(),
    }
    result = ChooseResult(found, _answered(found, choice))
    # As the command ends: something qualifies in every case or not, or an engine did not answer.
    found["exit_code"] = 3 if not result.answered else 0 if result.qualifies else 1
    return result if out is None else replace(result, written=result.save(out))


def _choices(engines: Sequence[EngineLike], adapters: Sequence[EngineLike]) -> list[EngineChoice]:
    """The engines to choose among: not the truth itself, nor the reference unless it is named."""
    choices = engine_choices(engines, adapters)
    if any(choice.name == "exact" and choice.required for choice in choices):
        raise UsageError("--engine exact: it is what the others are measured by; name another.")
    return [c for c in choices if c.name != "exact" and (c.required or c.name != "reference")]


def _answered(found: Mapping[str, Any], choice: Choice) -> bool:
    """Whether every engine, the exact solution included, started where it had to and answered."""
    required = {c.name for c in choice.request.choices if c.required}
    for missing, answer in choice.engines.missing:
        if answer.outcome != "not-installed" or missing.name in required:
            return False
    rows = [row for case in found["scenarios"] for row in case["candidates"]]
    broken = found["worker_deaths"] or any(row["status"] in BROKEN for row in rows)
    return not (broken or any(case["reason"] for case in found["scenarios"]))
