"""From a record to what a reader must see first: verdicts, and the numbers behind them.

Pure functions: the terminal's table and the page show the same summary.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.record.run_json import impossible_bodies
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.accuracy import inaccurate
from omegadot.reports.summary.advice import Advice
from omegadot.reports.summary.engine_failure import EngineFailure
from omegadot.reports.summary.failed_gate import FailedGate, failed_gates
from omegadot.reports.summary.failures import failures_of
from omegadot.reports.summary.figures import (
    Figure,
    Key,
    Range,
    figures_of,
    range_of,
    size,
    worst_residual,
)
from omegadot.reports.summary.not_tried import not_tried
from omegadot.reports.summary.reasons import MODEL_ALONE, failing_gates, tests_motion
from omegadot.reports.text.engine_version import version_text, with_version
from omegadot.reports.text.numbers import degrees, times

# From the worst to the best. A skip is never a pass, and neither is a run that was not judged.
STATUSES = (
    "fail",
    "crashed",
    "timeout",
    "raised",
    "diverged",
    "interrupted",
    "unsupported",
    "not-installed",
    "not-judged",
    "declared",
    "pass",
    "absent",
)

FAR_OFF = 1.0  # rad: such an attitude is that of another motion


@dataclass(frozen=True)
class Column:
    """One engine in one version and one setup. label: the heading of its column.

    single: whether it computes in single precision, so that its bounds are wider.
    """

    engine: str
    version: str
    setup: str
    label: str
    single: bool = False

    @property
    def name(self) -> str:
        """The label, with the version in any case."""
        named = self.version and version_text(self.version) in self.label
        return self.label if named else with_version(self.label, self.version)


@dataclass(frozen=True)
class Cell:
    """One engine on one scenario.

    status: the worst over its runs, of STATUSES.  runs: how many runs have which status.
    residual: the worst omega-dot residual at identical states.  drift and attitude: the range over
    the integrators, at the finest step, of the angular-momentum drift and the attitude error.
    failed: the first gate that fails with its worst measure, if one fails.
    """

    status: str
    runs: Counter[str]
    residual: Figure | None
    drift: Range | None
    attitude: Range | None
    failed: FailedGate | None = None

    @property
    def far_off(self) -> str:
        """How far off a cell is that passes all the same; "" where that is less than a radian."""
        worst = self.attitude.worst if self.attitude else None
        if self.status != "pass" or worst is None or not size(worst) > FAR_OFF:
            return ""
        return f"{degrees(worst.value)} deg off"


@dataclass(frozen=True)
class Missing:
    """Runs of an engine that gave no verdict for the same reason; runs is 0 for an engine that is
    not installed.
    """

    engine: str
    status: str
    reason: str
    runs: int
    scenarios: tuple[str, ...]
    integrators: tuple[str, ...]


@dataclass(frozen=True)
class Summary:
    """The record at a glance.

    runs: by status, how many.  yardsticks: those of the exact solution and the reference, where
    others ran.
    failures: what fails of each engine that does.
    truths: by kind of exact solution, the number of scenarios.  notes: a sentence on each body
    whose inertia is impossible, each process that ended by itself, each engine without integrators.
    one_step: whether every integrator ran with one step or accuracy alone on each scenario.
    accuracy: where no gate fails, that an error is large all the same, if one is.
    untried: where no gate fails, what the scenarios do not have in them and random systems do.
    """

    complete: bool
    scenarios: tuple[str, ...]
    columns: tuple[Column, ...]
    cells: Mapping[tuple[str, Column], Cell]
    runs: Counter[str]
    yardsticks: Counter[str]
    missing: tuple[Missing, ...]
    failures: tuple[EngineFailure, ...]
    truths: Counter[str]
    notes: tuple[str, ...]
    one_step: bool = False
    accuracy: Advice | None = None
    untried: Advice | None = None


def worst(statuses: Iterable[str]) -> str:
    """The worst of some statuses; absent where there is none."""
    return min(statuses, key=STATUSES.index, default="absent")


def task_status(task: Mapping[str, Any]) -> str:
    """What one run came to: its outcome where it did not end, else the worst of its gates.

    A run of which nothing but the model was judged is not judged: that is no pass.
    """
    verdicts = list((task.get("gates") or {}).values())
    if "fail" in verdicts:
        return "fail"
    if task["outcome"] != "ok":
        return str(task["outcome"])
    if not tests_motion(task) and "declared" not in verdicts:
        return "not-judged"
    return worst([v for v in verdicts if v != "info"] or ["not-judged"])


def summarise(record: Record) -> Summary:
    """The matrix of scenarios and engines, the counts, and what did not run."""
    tasks = record.run["tasks"]
    singles = {e["name"] for e in record.run["engines"] if e.get("precision") == "float32"}
    failed = failed_gates(record.metrics)
    failing = {key[1:] for key in failed}
    failing |= {column_of(task) for task in tasks if task_status(task) == "fail"}
    failures = failures_of(record)
    columns = _columns(tasks, singles, failing, [failure.who for failure in failures])
    named = [entry["name"] for entry in record.run["scenarios"]]
    scenarios = tuple(dict.fromkeys([*named, *(task["scenario"] for task in tasks)]))
    statuses: dict[Key, list[str]] = {}
    unmeasured: dict[Key, FailedGate] = {}  # a task's verdict counts even where it has no row
    for task in tasks:
        statuses.setdefault((task["scenario"], *column_of(task)), []).append(task_status(task))
        for gate in failing_gates(task)[:1]:
            unmeasured.setdefault((task["scenario"], *column_of(task)), FailedGate(gate))
    figures = figures_of(record.metrics)
    cells = {}
    for scenario, column in product(scenarios, columns):
        key = (scenario, column.engine, column.version, column.setup)
        first = failed.get(key) or unmeasured.get(key)
        cells[scenario, column] = _cell(first, statuses.get(key, []), figures.get(key, {}))
    held = [n for n in scenarios if any(cells[n, c].runs["pass"] for c in columns)]
    return Summary(
        bool(record.run.get("complete", True)),
        scenarios,
        columns,
        cells,
        *_counted(tasks),
        _missing(record.run),
        failures,
        _truths(record.trajectories),
        (*impossible_bodies(record.run["scenarios"]), *_ended(record.run), *_unstepped(record.run)),
        _one_step(tasks),
        None if failing else _accuracy(record.run, cells),
        None if failing else not_tried(record.run, held),
    )


def _one_step(tasks: Iterable[Mapping[str, Any]]) -> bool:
    steps: dict[tuple[Any, ...], set[tuple[float | None, float | None]]] = {}
    for task in tasks:
        step = task.get("timestep"), task.get("accuracy")
        if any(step):
            key = (task["scenario"], *column_of(task), task.get("integrator"))
            steps.setdefault(key, set()).add(step)
    return bool(steps) and all(len(own) == 1 for own in steps.values())


def _accuracy(run: Mapping[str, Any], cells: Mapping[tuple[str, Column], Cell]) -> Advice | None:
    """Of the engines, or of the yardsticks where these alone ran."""
    ours = [cell for (_, column), cell in cells.items() if column.engine not in YARDSTICKS]
    own = ours or list(cells.values())
    return inaccurate(run, (cell.attitude for cell in own), (cell.drift for cell in own))


def _counted(tasks: Iterable[Mapping[str, Any]]) -> tuple[Counter[str], Counter[str]]:
    """How many runs have which status: the engines', and the yardsticks' where others ran."""
    engines, yardsticks = Counter[str](), Counter[str]()
    for task in tasks:
        own = yardsticks if task["engine"] in YARDSTICKS else engines
        own[task_status(task)] += 1
    return (engines, yardsticks) if engines else (yardsticks, engines)


def counts(summary: Summary) -> list[str]:
    """How many runs have which status, in words: the engines', and apart the yardsticks'."""
    found = []
    for runs, whose in ((summary.runs, ""), (summary.yardsticks, " of exact and reference")):
        if total := sum(runs.values()):
            parts = ", ".join(
                f"{runs[status]} {text_of(status)}" for status in STATUSES if runs[status]
            )
            found.append(f"{times(total, 'run')}{whose}: {parts}")
    return found


def text_of(status: str) -> str:
    """A status in plain English."""
    return {"not-judged": "not judged", "not-installed": "not installed", "absent": "not run"}.get(
        status, status
    )


def _ended(run: Mapping[str, Any]) -> Iterator[str]:
    """The processes that ended between two requests: no run of theirs reports it."""
    crashed = {task["engine"] for task in run["tasks"] if task["outcome"] == "crashed"}
    for death in run.get("worker_deaths") or ():
        if death["engine"] not in crashed:
            yield f"{death['engine']}: its process ended between two requests ({death['how']})."


def _unstepped(run: Mapping[str, Any]) -> Iterator[str]:
    """The engines without integrators, of which nothing over time is judged."""
    ran = {t["engine"] for t in run["tasks"] if t["outcome"] == "ok"} - set(YARDSTICKS)
    for engine in run["engines"]:
        name = engine["name"]
        if name not in ran or engine.get("integrators") != []:
            continue
        if any(tests_motion(task) for task in run["tasks"] if task["engine"] == name):
            judged = "its model and the equations that it offers are judged"
            yield f"{name} has no integrators: {judged}."
        else:
            yield f"{name} has no integrators and no dynamics: {MODEL_ALONE}."


def _truths(trajectories: pl.DataFrame) -> Counter[str]:
    exact = trajectories.filter(pl.col("engine") == "exact")
    return Counter(name for _, name in exact.select("scenario", "integrator").unique().rows())


def column_of(task: Mapping[str, Any]) -> tuple[str, str, str]:
    """Engine, version and setup: the column in which a run stands."""
    return task["engine"], task.get("engine_version") or "", task.get("setup") or "physics"


def _columns(
    tasks: Iterable[Mapping[str, Any]],
    singles: set[str],
    failing: Collection[tuple[str, ...]],
    dearest: Sequence[tuple[str, ...]],
) -> tuple[Column, ...]:
    # The engines stand first, those that fail before the others, as they are listed above the
    # table: of twenty a screen shows some.
    places = {who: place for place, who in enumerate(dearest)}
    keys = sorted(
        dict.fromkeys(column_of(task) for task in tasks),
        key=lambda k: (k[0] in YARDSTICKS, k not in failing, places.get(k, len(places))),
    )
    columns = []
    for engine, version, setup in keys:
        several = len({v for e, v, _ in keys if e == engine}) > 1
        label = with_version(engine, version) if several else engine
        label += (setup != "physics") * f" {setup}"
        columns.append(Column(engine, version, setup, label, engine in singles))
    return tuple(columns)


def _cell(failed: FailedGate | None, statuses: list[str], figures: dict[str, list[Figure]]) -> Cell:
    # A row's verdict counts even where its task has none: no failure gets lost.
    return Cell(
        "fail" if failed else worst(statuses),
        Counter(statuses),
        worst_residual(figures.get("omega_dot", [])),
        range_of(figures.get("angular_momentum", [])),
        range_of(figures.get("attitude", [])),
        failed,
    )


def _missing(run: Mapping[str, Any]) -> tuple[Missing, ...]:
    groups: dict[tuple[str, str, str], list[Mapping[str, Any]]] = {}
    for task in run["tasks"]:
        if task["outcome"] != "ok":
            key = (task["engine"], task["outcome"], task.get("reason") or "")
            groups.setdefault(key, []).append(task)
    requested = {task["engine"] for task in run["tasks"]}
    for engine in run["engines"]:
        if engine.get("installed") is False and engine["name"] not in requested:
            groups[engine["name"], "not-installed", engine.get("reason") or ""] = []
    return tuple(
        Missing(
            *key,
            len(tasks),
            tuple(dict.fromkeys(task["scenario"] for task in tasks)),
            tuple(dict.fromkeys(t["integrator"] for t in tasks if t.get("integrator"))),
        )
        for key, tasks in sorted(groups.items(), key=lambda item: STATUSES.index(item[0][1]))
    )
