"""Everything that is measured of one version, and the outcome of each request that fails."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Description, Integrator
from omegadot.commands.versions.aims import Aims, drift_names, equation_names, names_of, probe_names
from omegadot.commands.versions.changes import Portrait
from omegadot.commands.versions.figures import (
    UNSUPPORTED,
    Figures,
    Wanted,
    drift_figures,
    equation_figures,
    reported_figures,
    scheme_figures,
)
from omegadot.commands.versions.metric import Figure, Name
from omegadot.diagnosis.scheme_study.probes import PROBES, Probe
from omegadot.diagnosis.scheme_study.study import IntegratorStudy, ProbeStudy
from omegadot.diagnosis.scheme_study.subject import NoAnswerError, load, one_of, stepper_of
from omegadot.gates.case import Case
from omegadot.gates.states.model import of_read_body
from omegadot.gates.steps.accuracy import usual_for
from omegadot.reference_impl.system import System
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import description_of
from omegadot.written import written

MOST_TIMEOUTS = 3
REQUESTED_OF_ENGINE = frozenset({"convention", "default"})
Declared = dict[str, Integrator]
Measuring = Callable[[Declared], Figures]  # of the integrators as declared for a loaded system


class Sitting:
    """One version being measured, through its worker; once `halted`, no further request is sent.

    read: whether its bodies are read from files.
    """

    def __init__(
        self,
        portrait: Portrait,
        worker: WorkerProcess,
        aims: Aims,
        halted: Callable[[], bool],
        read: bool = False,
    ) -> None:
        self.portrait, self._worker, self._aims = portrait, worker, aims
        self._halted, self._read = halted, read
        self._description: Description | None = None
        self._features: frozenset[str] = frozenset()
        self._timeouts = 0
        self._answered = False
        self._lost: tuple[str, str] | None = None

    def start(self) -> list[Name]:
        """Start the engine and take its description; the names of all its metrics.

        Where it does not start, the portrait has the reason, and there are none.
        """
        answer = self._worker.start()
        portrait = self.portrait
        if not answer.ok:
            portrait.outcome, portrait.reason = answer.outcome, answer.reason
            return []
        self._description = description_of(answer.result)
        self._features = self._description.features
        portrait.reported_version = self._description.version
        portrait.has = [integrator.name for integrator in self._description.integrators]
        portrait.integrators = self._aims.chosen(self._description)
        answer = self._worker.request("native")
        if not answer.ok:
            portrait.unreported = REQUESTED_OF_ENGINE
            if answer.outcome != "unsupported":
                self._note("its conventions", answer)
        native = answer.result if answer.ok else {}
        portrait.figures |= reported_figures(self._description, native)
        return [*portrait.figures, *names_of(self._aims, self._description)]

    def request(self, wanted: Wanted) -> None:
        """Measure the metrics that are wanted."""
        if self._description is None:
            return
        integrators = self.portrait.integrators
        for case in self._aims.cases:
            equations = partial(self._equations, case)
            self._measure(wanted, equation_names(case), case.name, case.system, equations)
            for name in integrators:
                drifts, what = partial(self._drifts, case, name), f"{name} on {case.name}"
                self._measure(wanted, drift_names(case, name), what, case.system, drifts)
        studies: dict[str, dict[str, ProbeStudy]] = {name: {} for name in integrators}
        for probe in PROBES:
            for name in integrators:
                call = partial(self._scheme, probe, name, wanted, studies[name])
                names, what = probe_names(name, probe.kind), f"{name} on {probe.kind}"
                self._measure(wanted, names, what, probe.system, call)
        for name, kinds in studies.items():
            departures = IntegratorStudy(name, kinds).departures
            self.portrait.faults += [f"{name}, {clause}" for clause in departures]
        if self._lost and not self._answered:  # no request was: it could not be measured
            self.portrait.outcome, self.portrait.reason = self._lost

    def _measure(
        self, wanted: Wanted, names: list[Name], what: str, system: System, call: Measuring
    ) -> None:
        """Load a system and take its figures; a request that fails costs these alone."""
        if not any(map(wanted, names)):
            return
        try:
            with np.errstate(all="ignore"):  # a release may give any numbers
                self.portrait.figures |= call(self._load(system))
            self._answered = True
        except NoAnswerError as error:
            unsupported = error.answer.outcome == "unsupported"
            self._answered = self._answered or unsupported
            self._lost = self._lost or (error.answer.outcome, error.answer.reason)
            lost = UNSUPPORTED if unsupported else Figure(None)
            self.portrait.figures |= dict.fromkeys(names, lost)
            self._note(what, error.answer)

    def _load(self, system: System) -> Declared:
        if self._halted():
            raise NoAnswerError(Answer("interrupted", "interrupted before this request"))
        if self._timeouts >= MOST_TIMEOUTS:
            raise NoAnswerError(Answer("timeout", f"not tried after {MOST_TIMEOUTS} time-outs"))
        return load(self._worker, system)

    def _drifts(self, case: Case, name: str, declared: Declared) -> Figures:
        step = stepper_of(self._worker, name, usual_for(one_of(declared, name)))
        return drift_figures(case, name, self._aims.truth(case), step)

    def _scheme(
        self,
        probe: Probe,
        name: str,
        wanted: Wanted,
        studies: dict[str, ProbeStudy],
        declared: Declared,
    ) -> Figures:
        step = stepper_of(self._worker, name)
        integrator = one_of(declared, name)
        figures, studies[probe.kind] = scheme_figures(probe, integrator, step, wanted)
        return figures

    def _equations(self, case: Case, _: Declared) -> Figures:
        request, features = partial(_answer_of, self._worker), self._features
        figures, rows = equation_figures(case, self._aims.truth(case), features, request)
        for row in map(of_read_body, rows) if self._read else rows:
            if row.verdict == "fail":
                off = f"{written(row.value, 2)} against a bound of {written(row.bound, 2)}"
                what = row.channel.replace("_", " ")
                self.portrait.faults.append(f"{case.name}, {row.gate}: {what} off by {off}")
        return figures

    def _note(self, what: str, answer: Answer) -> None:
        self._timeouts += answer.outcome == "timeout"
        self.portrait.unanswered += answer.outcome != "unsupported"
        self.portrait.troubles.append(f"{what}: {answer.outcome}: {answer.reason}")


def _answer_of(worker: WorkerProcess, operation: str, **fields: object) -> Answer:
    """An answer, or "unsupported". Raises NoAnswerError for any other."""
    answer = worker.request(operation, **fields)
    if answer.ok or answer.outcome == "unsupported":
        return answer
    raise NoAnswerError(answer)
