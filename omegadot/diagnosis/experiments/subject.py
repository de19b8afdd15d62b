"""What an experiment is about: which answers show a fault, and what is known of it already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import FORWARD
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.experiments.conditioned import (
    condition_in,
    conditioned,
    not_always,
    without_condition,
)
from omegadot.diagnosis.experiments.experiment import Experiment
from omegadot.diagnosis.experiments.judges import (
    ForwardJudge,
    Judge,
    StateJudge,
    StepsJudge,
    reads_back,
    shown_in,
    shown_in_steps,
    shows,
)
from omegadot.diagnosis.experiments.observed import Trial
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.experiments.sorting import contradicted
from omegadot.diagnosis.experiments.step_lengths import limit_of_length
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.gates.case import Case
from omegadot.reference_impl.system import State

TRIED = 4  # systems of which lengths of step are tried
STATES = 40  # of each scenario that are looked at


@dataclass(frozen=True)
class Subject:
    """A fault of forward dynamics, of the steps of an integrator, or of states read back.

    candidate: the cause, where one is named; what it would show is then known. misreading: that of
    states, text: of the motion in the steps, where these are named.
    """

    candidate: Candidate | None = None
    integrator: Integrator | None = None
    of_states: bool = False
    misreading: str = ""
    text: str = ""
    by_length: bool = False

    @property
    def key(self) -> tuple[object, ...]:
        """What it is, on whichever scenario."""
        own = self.candidate.key if self.candidate is not None else ()
        name = self.integrator.name if self.integrator is not None else ""
        return (own, name, self.of_states, self.misreading, self.text, self.by_length)


@dataclass(frozen=True)
class Conditions:
    """What the experiments on a fault have shown; of lengths of step where nothing else sorts."""

    condition: str
    experiment: Experiment | None = None

    def of(self, text: str) -> str:
        """A cause on this condition; one that has another, which is contradicted, without it."""
        if self.condition:
            return conditioned(text, self.condition)
        if self.experiment is None:
            return text
        known, seen = condition_in(text), self.experiment.seen
        if known:
            return without_condition(text) if contradicted(seen, known) else text
        return not_always(text) if seen.trials and not np.all(seen.wrong) else text


def conditions_of(
    subject: Subject,
    driver: Requests,
    case: Case,
    scenes: Mapping[str, Scene],
    steps: Sequence[VanishingSteps],
    eps: float,
) -> Conditions:
    """By experiments on a fault that shows on a case. steps: of the integrator on every case."""
    if subject.by_length:
        return Conditions(_length_of(subject, driver, case, steps, eps))
    one = _experiment_of(subject, driver, case, scenes, steps, eps)
    found = one.condition()
    if not found and subject.integrator is not None:
        found = _length_of(subject, driver, case, steps, eps)
    return Conditions(found, one)


def _experiment_of(
    subject: Subject,
    driver: Requests,
    case: Case,
    scenes: Mapping[str, Scene],
    steps: Sequence[VanishingSteps],
    eps: float,
) -> Experiment:
    how, one = (driver, case, eps), subject.candidate
    judge: Judge
    if subject.of_states:
        judge = StateJudge(*how, misreading=subject.misreading)
        return Experiment(judge, _of_states(subject.misreading, case, scenes, eps))
    if subject.integrator is None:
        judge = ForwardJudge(*how, one)
        every = [s.evidence[FORWARD] for s in scenes.values() if FORWARD in s.evidence]
        few = [e.few(STATES) for e in every if e.finite]
        drawn = [Trial(e.system, e.states, *shown_in(e, one)) for e in few]
    else:
        judge = StepsJudge(*how, one, integrator=subject.integrator, text=subject.text)
        found = [(s, shown_in_steps(s, one, subject.text)) for s in steps]
        drawn = [Trial(s.system, s.states, *shown) for s, shown in found]
    return Experiment(judge, drawn)


def _length_of(
    subject: Subject, driver: Requests, case: Case, steps: Sequence[VanishingSteps], eps: float
) -> str:
    """A length of step, or a turn in one, from or up to which the steps are wrong."""
    if subject.integrator is None:
        return ""
    own = [one for one in steps if one.system is case.system]
    for one in (*own, *(o for o in steps if o.system is not case.system))[:TRIED]:
        scenario = case.scenario.model_copy(update={"name": f"{case.name}-by-length"})
        here = replace(case, scenario=scenario, system=one.system)
        found = limit_of_length(driver, here, subject.integrator, one.states, eps)
        if found:
            return found
    return ""


def _of_states(misreading: str, case: Case, scenes: Mapping[str, Scene], eps: float) -> list[Trial]:
    found = list[Trial]()
    for scene in scenes.values():
        if scene.states is None:
            continue
        requested, back = scene.states
        here = replace(case, system=scene.system)
        wrong = not reads_back(here, requested, back, eps)
        known = shows(misreading, here, requested, eps)
        one = State(*(f[None] for f in vars(requested).values()))
        found.append(Trial(scene.system, one, np.array([wrong]), np.array([known])))
    return found
