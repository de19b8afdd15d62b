"""Engines as shipped with one default mended at a time: what a single setting does."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from omegadot.adapters.protocol import WITH, Integrator
from omegadot.gates.case import Sweep, knobs_of
from omegadot.gates.truth import Truth
from omegadot.harness.engines import outcome_of
from omegadot.harness.outcome import JudgedCase, Outcome, RunRequest
from omegadot.harness.plan import Engine
from omegadot.reference_impl.system import State
from omegadot.reports.shipped.figures import Figures, figures_of, stored
from omegadot.reports.shipped.rows import middle, scenario_of
from omegadot.workers.harness_end.process import Answer, WorkerProcess

Entry = dict[str, Any]


class SingleSettings:
    """Runs of the engines of an outcome, which are as shipped, on the scenario of the table.

    One integrator after the other, each at its middle step or accuracy. No gate judges them.
    deaths: which processes died, and how.
    """

    def __init__(self, request: RunRequest, outcome: Outcome) -> None:
        name = scenario_of(case.name for case in request.cases)
        self._request = request
        self._judged = next((j for j in outcome.cases if j.case.name == name and j.truth), None)
        self._engines = [engine for engine in outcome.engines if engine.description.settings]
        self._stopping = threading.Event()
        self._processes: list[WorkerProcess] = []
        self.deaths: list[tuple[str, str]] = []

    @property
    def total(self) -> int:
        """How many runs there are."""
        return sum(
            len(engine.description.settings) * len(_integrators(self._judged, engine))
            for engine in self._engines
        )

    def execute(self, finished: Callable[[], object]) -> list[Entry]:
        """Every run, as ``run.json`` holds it; Ctrl-C ends the workers and is raised.

        finished: called after each run.
        """
        judged = self._judged
        found: list[Entry] = []
        with ThreadPoolExecutor(self._request.jobs, "setting") as threads:
            try:
                calls = [
                    threads.submit(self._runs, engine, setting, judged, finished)
                    for engine in self._engines
                    for setting in engine.description.settings
                    if judged is not None
                ]
                for call in calls:
                    own = outcome_of(call)
                    found += own
            except BaseException:
                self._stopping.set()
                for process in self._processes:
                    process.stop()
                threads.shutdown(wait=False, cancel_futures=True)
                raise
        return found

    def _runs(
        self, engine: Engine, setting: str, judged: JudgedCase, finished: Callable[[], object]
    ) -> list[Entry]:
        """One engine with one setting, in a process of its own."""
        if self._stopping.is_set():
            return []
        choice, request, truth = engine.choice, self._request, judged.truth
        assert truth is not None
        memory = None if request.memory is None else int(request.memory * 2**30)
        process = WorkerProcess(
            choice.target,
            f"as-shipped{WITH}{setting}",
            request.timeout,
            memory=memory,
            via=choice.via,
        )
        self._processes.append(process)
        named = {"scenario": judged.case.name, "engine": engine.name, "setting": setting}
        found = []
        for integrator in _integrators(judged, engine):
            sweep = middle(judged.case.sweeps_of(integrator), lambda one: one.knob)
            run = self._answer(process, judged, integrator, sweep)
            own = {**named, "integrator": integrator.name, **knobs_of(sweep), "reason": run.reason}
            found.append({**own, **stored(_figures(truth, sweep, run))})
            finished()
        process.finish()
        self.deaths += [(f"{engine.name} with {setting}", how) for how in process.deaths]
        return found

    def _answer(
        self, process: WorkerProcess, judged: JudgedCase, integrator: Integrator, sweep: Sweep
    ) -> Answer:
        """One run; a process that is not there is started and loaded first."""
        if not process.started:
            for answer in (process.start(), process.request("load", system=judged.case.system)):
                if not answer.ok:
                    process.stop()
                    return answer
        how = {"initial": judged.case.initial, "integrator": integrator.name, **vars(sweep)}
        return process.request("run", **how)


def _integrators(judged: JudgedCase | None, engine: Engine) -> tuple[Integrator, ...]:
    """Those that are run, as the engine declares them for the system."""
    if judged is None:
        return ()
    own = next((one for one in judged.engines if one.engine is engine), None)
    return own.result.integrators if own else ()


def _figures(truth: Truth, sweep: Sweep, run: Answer) -> Figures:
    if not run.ok:
        return Figures(run.outcome)
    state, exact = State(**run.result["state"]), truth.at(sweep)
    finite = all(np.isfinite(part).all() for part in vars(state).values())
    if not finite or len(state.orientation) != len(exact.orientation):
        return Figures("diverged")
    return figures_of(truth.yardstick.system, sweep.times, state, exact)
