"""``omegadot.schemes``: which scheme each integrator steps, and how its errors shrink."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from omegadot.commands.other_python import checked_interpreters, worker_command
from omegadot.commands.progress import Progress, Reporting, reporting
from omegadot.commands.typed import typed
from omegadot.diagnosis.scheme_study.record import Record, record_of
from omegadot.diagnosis.scheme_study.study import EngineStudy, study_engine
from omegadot.harness.arguments import engine_choices, several
from omegadot.harness.engine_target import EngineLike
from omegadot.harness.plan import EngineChoice
from omegadot.workers.harness_end.process import WorkerProcess

TIMEOUT = 60.0  # s, for one request to an engine
NOT_STEPPED = "exact"  # the truth that the others are held against
ITSELF = "reference"  # it would be held against itself
BROKEN = ("crashed", "timeout", "raised")


@dataclass(frozen=True)
class SchemesResult:
    """Integrators studied. record: engines, integrators, probes, orders and defects, as printed.

    required: engines that were given by name; one of these that is missing did not answer.
    """

    record: Record
    required: frozenset[str] = frozenset()

    @property
    def departures(self) -> Mapping[str, list[str]]:
        """Where an integrator is not as declared, by ``engine:integrator``."""
        return {
            f"{engine['name']}:{integrator['name']}": integrator["departures"]
            for engine in self.record["engines"]
            for integrator in engine["integrators"]
            if integrator["departures"]
        }

    @property
    def answered(self) -> bool:
        """Whether every engine started, or need not, and answered."""
        for engine in self.record["engines"]:
            absent = engine["outcome"] == "not-installed"
            if engine["outcome"] != "ok" and not (absent and engine["name"] not in self.required):
                return False
        integrators = [i for engine in self.record["engines"] for i in engine["integrators"]]
        return not any(p["outcome"] in BROKEN for i in integrators for p in i["probes"].values())

    @property
    def passed(self) -> bool:
        """Whether every engine answered and every integrator is as declared."""
        return self.answered and not self.departures

    def __repr__(self) -> str:
        count = sum(len(engine["integrators"]) for engine in self.record["engines"])
        return f"<omegadot schemes of {count} integrators, {len(self.departures)} not as declared>"


@typed
def schemes(
    engines: EngineLike | Sequence[EngineLike] | None = None,
    *,
    adapters: EngineLike | Sequence[EngineLike] = (),
    pythons: Mapping[str, str] | None = None,
    progress: Reporting = False,
) -> SchemesResult:
    """Name the scheme of every integrator, from its steps alone, with its orders and defects.

    engines, adapters: as of `run`; without engines the exact solution and the reference are left
    out.  pythons: the interpreter that an engine runs under, by engine. Raises UsageError.
    """
    choices = [
        choice
        for choice in engine_choices(several(engines, "engines"), several(adapters))
        if choice.required or choice.name not in (NOT_STEPPED, ITSELF)
    ]
    interpreters = checked_interpreters(pythons or {}, [choice.name for choice in choices])
    with reporting(progress) as report:
        report(Progress("stepping the reference's schemes and the engines"))
        record = record_of(study_all(choices, interpreters))
    return SchemesResult(record, frozenset(c.name for c in choices if c.required))


def study_all(choices: Sequence[EngineChoice], pythons: Mapping[str, str]) -> list[EngineStudy]:
    """Every engine at the same time, each with a worker; Ctrl-C ends them at once."""
    workers = []
    for choice in choices:
        command = worker_command(pythons[choice.name]) if choice.name in pythons else None
        workers.append(WorkerProcess(choice.target, "physics", TIMEOUT, command))
    stopping = threading.Event()
    with ThreadPoolExecutor(max(1, len(choices))) as threads:
        futures = [
            threads.submit(study_engine, choice, worker, stopping)
            for choice, worker in zip(choices, workers, strict=True)
        ]
        try:
            return [future.result() for future in futures]
        except BaseException:
            stopping.set()
            for worker in workers:
                worker.stop()
            raise
