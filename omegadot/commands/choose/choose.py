"""``omegadot choose``: from its arguments to a ranking and an exit code."""

from __future__ import annotations

import datetime
import os
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import typer

from omegadot import __version__
from omegadot.commands.choose.chooser import Choice, Chooser, choices_to_make
from omegadot.commands.choose.document import document
from omegadot.commands.choose.motion import Motion, cases_of
from omegadot.commands.choose.requirements import Requirements, merged
from omegadot.commands.choose.requirements_file import read_requirements
from omegadot.commands.report.report import redraw
from omegadot.harness.arguments import engine_choices
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError
from omegadot.reports.choice.files import check_choice_folder, write_choice
from omegadot.reports.choice.text import print_choice
from omegadot.reports.record.record import RUN
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.text.numbers import listed
from omegadot.workers.machine import describe_machine, package_versions

BROKEN = ("crashed", "timeout", "raised")


@dataclass(frozen=True)
class Arguments:
    """The arguments. requested: requirements by name, None or empty where not given."""

    scenarios: Sequence[str] = ()
    body: str | None = None
    allow_impossible_inertia: bool = False
    angular_velocity: tuple[float, float, float] | None = None
    orientation: tuple[float, float, float, float] | None = None
    requirements: Path | None = None
    requested: Mapping[str, Any] = field(default_factory=dict)
    engines: Sequence[str] = ()
    adapters: Sequence[str] = ()
    budget: float = 2.0
    timeout: float = 60.0
    jobs: int | None = None


def choose_and_print(names: Arguments, out: Path | None, *, as_json: bool) -> int:
    """Choose, print, write where a folder is given, and return the exit code.

    Raises UsageError, ScenarioError, AdapterError and RecordError.
    """
    started = time.perf_counter()
    file = read_requirements(names.requirements) if names.requirements else {}
    wanted = merged(file, names.requested, str(names.requirements))
    chooser = _chooser(names, wanted)
    if out is not None:
        check_choice_folder(out)
    with _progress_bar(chooser):
        choice = chooser.execute()
    found = {
        **document(choice, wanted),
        "omegadot": __version__,
        "created": datetime.datetime.now(datetime.UTC).replace(microsecond=0).isoformat(),
        "command": ["omegadot", *sys.argv[1:]],
        "budget": names.budget,
        "seconds": round(time.perf_counter() - started, 3),
        "machine": describe_machine(),
        "versions": package_versions(),
    }
    code = exit_code(found, choice, chooser.request.choices)
    found["exit_code"] = code
    written = _written(found, out) if out is not None else []
    if as_json:
        typer.echo(dump_json(found), nl=False)
    else:
        print_choice(found)
        if written:
            typer.echo(f"Written to {listed([str(path) for path in written])}.")
    return code


def _written(found: Mapping[str, Any], out: Path) -> list[Path]:
    """Write the choice; where that is a run's folder, the run's page has it as a section."""
    write_choice(found, out)
    paths = [out / "choice.html", out / "choice.json"]
    return [*paths, redraw(out)] if (out / RUN).is_file() else paths


def _chooser(names: Arguments, wanted: Requirements) -> Chooser:
    motion = Motion(
        names.scenarios,
        names.body,
        names.angular_velocity,
        names.orientation,
        wanted.duration,
        names.allow_impossible_inertia,
    )
    cases = cases_of(motion)
    choices = engine_choices(names.engines, names.adapters)
    if any(choice.name == "exact" and choice.required for choice in choices):
        raise UsageError("--engine exact: it is what the others are measured by; name another.")
    request = RunRequest(
        cases,
        choices_to_make(choices),
        timeout=names.timeout,
        jobs=names.jobs or os.cpu_count() or 1,
    )
    return Chooser(request, wanted, names.budget)


@contextmanager
def _progress_bar(chooser: Chooser) -> Iterator[None]:
    """A bar on a terminal, nothing where standard error is piped."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("starting the engines", total=None)
        chooser.on_start = lambda total: bar.update(
            task, total=total, description="seeking the largest steps"
        )
        chooser.on_advance = lambda: bar.advance(task)
        chooser.on_timing = lambda: bar.update(task, description="timing, engine by engine")
        yield


def exit_code(found: Mapping[str, Any], choice: Choice, choices: Sequence[EngineChoice]) -> int:
    """0 something qualifies in every case, 1 not so, 3 an engine failed to answer or to start."""
    required = {c.name for c in choices if c.required}
    for missing, answer in choice.missing:
        if answer.outcome != "not-installed" or missing.name in required:
            return 3
    rows = [row for case in found["scenarios"] for row in case["candidates"]]
    if choice.deaths or any(row["status"] in BROKEN for row in rows):
        return 3
    if any(case["reason"] for case in found["scenarios"]):
        return 3
    several = len(found["scenarios"]) > 1
    qualifies = bool(found["everywhere"]) if several else found["scenarios"][0]["qualifying"] > 0
    return 0 if qualifies else 1
