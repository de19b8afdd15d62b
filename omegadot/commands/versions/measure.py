"""Everything that is measured of one version, and the outcome of each request that fails."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from omegadot.adapters.protocol import Description, Integrator
from omegadot.commands.versions.aims import (
    Aims,
    drift_names,
    equation_names,
    names_of,
    order_names,
    scheme_name,
)
from omegadot.commands.versions.figures import (
    Figures,
    Wanted,
    drift_figures,
    equation_figures,
    figures_of_rows,
    model_rows,
    reported_figures,
    scheme_figures,
)
from omegadot.commands.versions.metric import Figure, Name
from omegadot.commands.versions.requests import answer_of, load
from omegadot.commands.versions.truths import Truths
from omegadot.diagnosis.scheme_study.probes import PROBES, Probe
from omegadot.diagnosis.scheme_study.study import IntegratorStudy, ProbeStudy
from omegadot.diagnosis.scheme_study.subject import NoAnswerError, stepper_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.reference_impl.system import State, System
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import description_of

MOST_TIMEOUTS = 3
REQUESTED_OF_ENGINE = frozenset({"convention", "default"})


@dataclass
class Portrait:
    """One version. outcome: "ok", or why there is nothing of it, with the reason.

    version: as requested.  reported_version: of the engine itself.  faults: where it is not as
    its adapter declares, or wrong.  has: its integrators, those not looked at included.
    troubles: requests that it failed to answer.  unreported: kinds of metric that it should report
    and did not.
    """

    version: str
    outcome: str = "ok"
    reason: str = ""
    origin: str = ""
    reported_version: str = ""
    integrators: list[str] = field(default_factory=list)
    has: list[str] = field(default_factory=list)
    figures: Figures = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)
    troubles: list[str] = field(default_factory=list)
    unreported: frozenset[str] = frozenset()
    speeds: dict[str, list[float]] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether the version could be measured."""
        return self.outcome == "ok"


class Sitting:
    """One version being measured, through its worker; once `halted`, no further request is sent."""

    def __init__(
        self, portrait: Portrait, worker: WorkerProcess, aims: Aims, halted: Callable[[], bool]
    ) -> None:
        self.portrait, self._worker, self._aims = portrait, worker, aims
        self._halted = halted
        self._description: Description | None = None
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
        portrait.reported_version = self._description.version
        portrait.has = [integrator.name for integrator in self._description.integrators]
        portrait.integrators = self._aims.chosen(self._description)
        answer = self._worker.request("native")
        native = answer.result if answer.ok else {}
        if not answer.ok:
            portrait.unreported = REQUESTED_OF_ENGINE
        if not answer.ok and answer.outcome != "unsupported":
            self._note("its conventions", answer)
        portrait.figures |= reported_figures(self._description, native)
        return [*portrait.figures, *names_of(self._aims, self._description)]

    def request(self, wanted: Wanted, truths: Truths) -> None:
        """Measure the metrics that are wanted."""
        if self._description is None:
            return
        for case in self._aims.cases:
            self._measure_case(case, wanted, truths)
        found: dict[str, dict[str, ProbeStudy]] = {}
        for probe in PROBES:
            for name in self.portrait.integrators:
                names = [scheme_name(name, probe.kind), *order_names(name, probe.kind)]
                if any(map(wanted, names)):
                    studied = self._study(probe, name, wanted, names)
                    if studied:
                        found.setdefault(name, {})[probe.kind] = studied
        for name, kinds in found.items():
            departures = IntegratorStudy(name, kinds).departures
            self.portrait.faults += [f"{name}, {clause}" for clause in departures]
        self._give_up_if_mute()

    def _give_up_if_mute(self) -> None:
        """A version that answered no request could not be measured."""
        if self._lost and not self._answered:
            self.portrait.outcome, self.portrait.reason = self._lost

    def _measure_case(self, case: Case, wanted: Wanted, truths: Truths) -> None:
        if any(map(wanted, equation_names(case))):
            with self._noting(case.name, equation_names(case)):
                self._load(case.system)
                self._equations(case, truths)
        for name in self.portrait.integrators:
            if any(map(wanted, drift_names(case, name))):
                with self._noting(f"{name} on {case.name}", drift_names(case, name)):
                    self._load(case.system)
                    step = stepper_of(self._worker, name)
                    self.portrait.figures |= drift_figures(case, name, truths.of(case), step)

    def _study(
        self, probe: Probe, name: str, wanted: Wanted, names: list[Name]
    ) -> ProbeStudy | None:
        with self._noting(f"{name} on {probe.kind}", names):
            declared = self._load(probe.system)[name]
            step = stepper_of(self._worker, name)
            figures, studied = scheme_figures(probe, declared, step, wanted)
            self.portrait.figures |= figures
            return studied
        return None

    def _load(self, system: System) -> dict[str, Integrator]:
        if self._halted():
            raise NoAnswerError(Answer("interrupted", "interrupted before this request"))
        if self._timeouts >= MOST_TIMEOUTS:
            raise NoAnswerError(Answer("timeout", f"not tried after {MOST_TIMEOUTS} time-outs"))
        return load(self._worker, system)

    def _equations(self, case: Case, truths: Truths) -> None:
        exact, worker = truths.of(case), self._worker
        first = State(*(values[0] for values in vars(exact.random).values()))
        rows = model_rows(case, first, answer_of(worker, "model", state=first))
        forward = answer_of(worker, "forward", states=exact.random)
        inverse = answer_of(worker, "inverse", states=exact.random, acceleration=exact.acceleration)
        equations = equation_figures(case, exact, forward, inverse)
        self.portrait.figures |= figures_of_rows(case, equations)
        self._judge(case, rows + equations)

    def _judge(self, case: Case, rows: list[Row]) -> None:
        for row in rows:
            if row.verdict == "fail":
                off = f"{row.value:.1e} against a bound of {row.bound:.1e}"
                what = row.channel.replace("_", " ")
                self.portrait.faults.append(f"{case.name}, {row.gate}: {what} off by {off}")

    @contextmanager
    def _noting(self, what: str, names: list[Name]) -> Iterator[None]:
        """A request that fails costs its own figures alone."""
        try:
            yield
            self._answered = True
        except NoAnswerError as error:
            lost = Figure(None)
            if error.answer.outcome == "unsupported":
                lost = Figure("unsupported")
                self._answered = True
            self._lost = self._lost or (error.answer.outcome, error.answer.reason)
            self.portrait.figures |= dict.fromkeys(names, lost)
            self._note(what, error.answer)

    def _note(self, what: str, answer: Answer) -> None:
        self._timeouts += answer.outcome == "timeout"
        self.portrait.troubles.append(f"{what}: {answer.outcome}: {answer.reason}")
