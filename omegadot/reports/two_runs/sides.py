"""One of the two records: its runs by what makes them the same run in the other one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from omegadot.reports.record.record import Record
from omegadot.reports.summary.reasons import reason_of
from omegadot.reports.summary.summary import column_of, task_status, worst

# Scenario keys that change no number: its description, and the steps it is run with.
DESCRIPTION_OR_STEPS = {"schema", "name", "title", "shows", "source"}


class RunKey(NamedTuple):
    """What names a run in both records. version: "" unless a record has several of an engine."""

    scenario: str
    engine: str
    version: str
    setup: str
    integrator: str
    timestep: float | None
    accuracy: float | None


@dataclass(frozen=True)
class Task:
    """A run as one record has it. status: of STATUSES.  why: the reason."""

    key: RunKey
    status: str
    outcome: str
    gates: Mapping[str, str]
    why: str

    @property
    def stands_for_all(self) -> bool:
        """Whether the engine never got to a step: it then stands for all its runs there."""
        return self.key.timestep is None and self.key.accuracy is None and self.outcome != "ok"


@dataclass(frozen=True)
class Side:
    """A record with its label."""

    label: str
    record: Record

    @property
    def run(self) -> Mapping[str, Any]:
        """What its ``run.json`` holds."""
        return self.record.run

    @property
    def complete(self) -> bool:
        """False where the run was interrupted."""
        return bool(self.run.get("complete", True))


def several_versions(sides: Iterable[Side]) -> set[str]:
    """The engines of which a record holds more than one version: they are paired by version."""
    found = set()
    for side in sides:
        columns = {column_of(task) for task in side.run["tasks"]}
        counts = Counter((engine, setup) for engine, version, setup in columns if version)
        found |= {engine for (engine, _), count in counts.items() if count > 1}
    return found


def tasks_of(side: Side, versioned: set[str]) -> dict[RunKey, Task]:
    """Every run of a record; where one key stands several times, the worst of them."""
    found: dict[RunKey, Task] = {}
    for entry in side.run["tasks"]:
        engine, version, setup = column_of(entry)
        own = version if engine in versioned else ""
        # The exact solution is one engine, however it is computed.
        integrator = "" if engine == "exact" else entry.get("integrator") or ""
        knobs = entry.get("timestep"), entry.get("accuracy")
        key = RunKey(entry["scenario"], engine, own, setup, integrator, *knobs)
        verdict = task_status(entry), entry["outcome"], entry.get("gates") or {}
        task = Task(key, *verdict, reason_of(entry))
        if key not in found or worst((task.status, found[key].status)) == task.status:
            found[key] = task
    return found


def definition_of(entry: Mapping[str, Any]) -> dict[str, Any]:
    """What of a scenario decides its numbers: all but its description and its set of steps."""
    whole = entry.get("definition") or {}
    found = {key: value for key, value in whole.items() if key not in DESCRIPTION_OR_STEPS}
    if isinstance(found.get("run"), Mapping):
        found["run"] = {k: v for k, v in found["run"].items() if k != "timesteps"}
    return found


def redefined(was: Side, now: Side) -> set[str]:
    """The scenarios that differ between the two records under one name."""
    both = of_both(was.run["scenarios"], now.run["scenarios"])
    return {name for name, one, other in both if definition_of(one) != definition_of(other)}


def of_both(
    was: Iterable[Mapping[str, Any]], now: Iterable[Mapping[str, Any]]
) -> Iterator[tuple[str, Mapping[str, Any], Mapping[str, Any]]]:
    """Each name that two lists have, in the order of the second, with its entry in either."""
    then = {entry["name"]: entry for entry in was}
    yield from ((e["name"], then[e["name"]], e) for e in now if e["name"] in then)
