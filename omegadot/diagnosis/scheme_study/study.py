"""The study of an engine: every integrator on every probe."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.scheme_study.fingerprint import Match, fingerprint
from omegadot.diagnosis.scheme_study.naming import Naming, name_schemes
from omegadot.diagnosis.scheme_study.one_step import Defect, defects
from omegadot.diagnosis.scheme_study.orders import Observed, global_errors, observe
from omegadot.diagnosis.scheme_study.probes import PROBES, Probe, in_precision
from omegadot.diagnosis.scheme_study.subject import (
    NoAnswerError,
    Stepper,
    load,
    one_of,
    stepper_of,
)
from omegadot.gates.errors.findings import orders_for
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.errors.observed_order import ORDER_TOLERANCE
from omegadot.gates.truth import scheme_key
from omegadot.harness.arguments import integrators_chosen
from omegadot.harness.plan import EngineChoice
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import description_of

OWN_STEPS = "it controls its error: its steps are its own"


@dataclass(frozen=True)
class Order:
    """One channel on one probe. declared: None where it is declared to be conserved."""

    declared: int | None
    observed: Observed

    @property
    def verdict(self) -> str:
        """One of "holds", "higher", "lower", "conserved", "drifts", "floor" or "unresolved"."""
        if self.observed.kind == "floor":
            return "conserved" if self.declared is None else "floor"
        if self.declared is None:
            return "drifts"
        if self.observed.kind == "unresolved" or self.observed.order is None:
            return "unresolved"
        excess = self.observed.order - self.declared
        if abs(excess) <= ORDER_TOLERANCE:
            return "holds"
        return "higher" if excess > 0 else "lower"


@dataclass(frozen=True)
class ProbeStudy:
    """One integrator on one probe. answer: what went wrong, or ok.

    as_declared: whether the declared scheme is among the matches; None where none is declared.
    """

    answer: Answer
    declared: str | None = None
    as_declared: bool | None = None
    matches: tuple[Match, ...] = ()
    orders: dict[str, Order] = field(default_factory=dict)
    defects: dict[str, Defect] = field(default_factory=dict)


NOT_TRIED = ProbeStudy(Answer("timeout", "not tried after an earlier time-out"))


@dataclass(frozen=True)
class IntegratorStudy:
    """One integrator; probes by kind."""

    name: str
    probes: dict[str, ProbeStudy]

    @property
    def studied(self) -> dict[str, ProbeStudy]:
        """The probes that it answered."""
        return {kind: probe for kind, probe in self.probes.items() if probe.answer.ok}

    @property
    def namings(self) -> list[Naming]:
        """Its scheme, or schemes where they depend on the system."""
        matched = {k: [m.scheme for m in p.matches] for k, p in self.studied.items()}
        return name_schemes(matched, {k: p.declared for k, p in self.studied.items()})

    @property
    def departures(self) -> list[str]:
        """What is not as declared, a clause a kind and fault."""
        found = []
        for kind, probe in self.studied.items():
            if probe.as_declared is False:
                found.append(f"{kind}: it does not step the declared {probe.declared}")
            orders = {c.replace("_", " "): order for c, order in probe.orders.items()}
            drifting = [c for c, order in orders.items() if order.verdict == "drifts"]
            if drifting:
                found.append(f"{kind}: declared conserved, and drifting: {', '.join(drifting)}")
            lower = [
                f"{c} {o.observed.order:.2f} of {o.declared}"
                for c, o in orders.items()
                if o.verdict == "lower"
            ]
            if lower:
                found.append(f"{kind}: below the declared order: {', '.join(lower)}")
        return found


@dataclass(frozen=True)
class EngineStudy:
    """One engine. answer: why there is nothing of it, or ok."""

    name: str
    answer: Answer
    version: str = ""
    integrators: tuple[IntegratorStudy, ...] = ()


def study_probe(probe: Probe, integrator: Integrator, step: Stepper) -> ProbeStudy:
    """One integrator on one probe; what the engine fails to answer is the answer."""
    if integrator.knob != "timestep":
        return ProbeStudy(Answer("unsupported", OWN_STEPS))
    declared, key = orders_for(integrator, probe.system), scheme_key(integrator, probe.system)
    try:
        matches = tuple(fingerprint(probe, step))
        errors = global_errors(probe, step)
        wrongs = defects(probe, step)
    except NoAnswerError as error:
        return ProbeStudy(error.answer)
    return ProbeStudy(
        answer=Answer("ok"),
        declared=integrator.scheme,
        as_declared=None if key is None else any(match.key == key for match in matches),
        matches=matches,
        orders={c: Order(declared.get(c), observe(errors[c])) for c in CHANNELS},
        defects=wrongs,
    )


def study_engine(
    choice: EngineChoice, worker: WorkerProcess, stopping: threading.Event | None = None
) -> EngineStudy:
    """Start an engine's worker and study it on every probe; end the worker.

    stopping: an event that ends the study. Raises UsageError where an integrator is
    requested that the engine does not have.
    """
    halt = stopping or threading.Event()
    try:
        started = worker.start()
        if not started.ok:
            return EngineStudy(choice.name, started)
        description = description_of(started.result)
        names = [i.name for i in integrators_chosen(choice, description)]
        found: dict[str, dict[str, ProbeStudy]] = {name: {} for name in names}
        for probe in (in_precision(one, description.precision) for one in PROBES):
            for name in names:
                if not halt.is_set():
                    late = any(p.answer.outcome == "timeout" for p in found[name].values())
                    found[name][probe.kind] = NOT_TRIED if late else _study(worker, probe, name)
    finally:
        worker.finish()
    studies = tuple(IntegratorStudy(name, kinds) for name, kinds in found.items())
    return EngineStudy(choice.name, Answer("ok"), description.version, studies)


def _study(worker: WorkerProcess, probe: Probe, name: str) -> ProbeStudy:
    try:
        integrator = one_of(load(worker, probe.system), name)
    except NoAnswerError as error:
        return ProbeStudy(error.answer)
    with np.errstate(all="ignore"):  # an engine may give any numbers
        return study_probe(probe, integrator, stepper_of(worker, name))
