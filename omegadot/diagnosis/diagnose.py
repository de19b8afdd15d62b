"""The likeliest cause of what the gates found, as text.

``diagnose(case, truth, evaluation_states, result, runs) -> list[str]`` is a function of what the
harness has after judging one engine on one case: the `Case`, its `Truth` (with companions of the
schemes in question), the `EvaluationStates`, the `CaseResult` with the engine's own answers, and
the `JudgedRun` list of `judge_case`. Each sentence names a cause that was tried on those answers
and explains them within the gates' own bounds. `Causes` does so over all scenarios of a run: what
fits one scenario and is contradicted by another is not named.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np

from omegadot.diagnosis.case_causes import CaseCauses
from omegadot.diagnosis.defect import kept_apart
from omegadot.diagnosis.equations.evidence import FORWARD
from omegadot.diagnosis.experiments.in_batches import InBatches
from omegadot.diagnosis.experiments.judges import changes_by_itself
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.experiments.run_before import after_runs
from omegadot.diagnosis.experiments.subject import Conditions, Subject, conditions_of
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.requests import AGAIN
from omegadot.diagnosis.stepping.ends.after_run import AfterRun, taken_of_run_before
from omegadot.diagnosis.wording.among_others import beside_others, of_few
from omegadot.diagnosis.wording.kinds import is_named, kind_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import (
    EvaluationStates,
    evaluation_states_of,
)
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult, Driver
from omegadot.harness.judging.engine import shared_rows
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.outcome import EngineCase, JudgedCase

CHANGES = (
    "omega-dot of the same states is another when it is requested again at once: it is drawn at "
    "random, or depends on the requests before"
)
PAIRS = 3  # runs of one step, each after another run, on which a cause is looked for
MOST_EXPERIMENTS = 6  # causes of one engine whose conditions are looked for
Ask = Callable[[str, Callable[[Driver], Conditions]], Conditions]


class Causes:
    """Causes over the scenarios of a run, of which each engine's are kept in small arrays.

    ask: has a call made with an engine's driver, where more may be requested of the engines; the
    condition of a cause is then looked for by experiments.
    """

    def __init__(self) -> None:
        self.ask: Ask | None = None
        self._engines: dict[str, EngineOverScenarios] = {}
        self._cases: dict[str, dict[str, CaseCauses]] = {}
        self._texts: dict[tuple[str, str, str | None], str] = {}
        self._followed: dict[tuple[str, str, str], str] = {}
        self._conditions: dict[tuple[str, tuple[object, ...]], Conditions] = {}
        self._requests: dict[str, Requests] = {}
        self._unsteady: dict[str, bool] = {}
        self._batches: dict[str, InBatches] = {}
        self._after: dict[tuple[str, str], list[AfterRun]] = {}

    def add(self, judged: JudgedCase, found: EngineCase, seed: int) -> CaseCauses:
        """One more case of an engine. It must have an exact trajectory."""
        assert judged.truth is not None
        name = found.engine.name
        engine = self._engines.setdefault(name, EngineOverScenarios())
        states = evaluation_states_of(judged.case, judged.truth, seed)
        with np.errstate(all="ignore"):
            causes = CaseCauses(
                engine, judged.case, judged.truth, states, found.result, found.shared, found.runs
            )
        self._cases.setdefault(name, {})[judged.case.name] = causes
        # what was found before may not hold any more
        self._texts, self._conditions, self._followed = {}, {}, {}
        self._batches = {}
        return causes

    def text(self, engine: str, case: str, run: JudgedRun | None) -> str:
        """The cause of a run on one case, or of what all runs share there.

        Where none is named, or one that less than half of the failing cases show, it is one of
        another case that makes what is seen here as well; or else that of most other cases that
        fail stands before this.
        """
        defects, found = list[str](), ""
        with kept_apart(defects):
            found = self._text_or_others(engine, case, None if run is None else run.integrator.name)
        return found or "".join(defects)

    def _text_or_others(self, engine: str, case: str, integrator: str | None) -> str:
        text = self._text(engine, case, integrator)
        every = {
            name: self._text(engine, name, integrator)
            for name, one in self._cases[engine].items()
            if name != case and one.fails(integrator)
        }
        text = of_few(text, self._shown_by(engine, case, integrator, text, every))
        if is_named(text):
            return text
        others = {name: other for name, other in every.items() if other}
        same = self._same_as_others(engine, case, integrator, text, others)
        return same or beside_others(text, list(every.values()))

    def _shown_by(
        self, engine: str, case: str, integrator: str | None, text: str, every: Mapping[str, str]
    ) -> list[str]:
        """The texts of other cases, of which those that are silent may show this cause as well.

        Where only the same system with one thing changed fails, the cause is that of the others.
        """
        silent = [n for n, other in every.items() if not other and integrator is None]
        cases = self._cases[engine]
        same = {n for n in silent if is_named(text) and cases[n].siblings_follow(case)}
        return [text if name in same else other for name, other in every.items()]

    def _same_as_others(
        self, engine: str, case: str, integrator: str | None, text: str, others: Mapping[str, str]
    ) -> str:
        """A cause of other cases, by name, that makes what is seen of this one; "" where none."""
        own = self._cases[engine][case]
        named = {name: other for name, other in others.items() if is_named(other)}
        if integrator is None:
            follows = (name for name in named if not text and own.siblings_follow(name))
            return named.get(next(follows, ""), "")
        outgrown = (name for name in named if own.outgrown(integrator, name))
        found = named.get(next(outgrown, ""), "")
        if found:
            return found
        key = (engine, case, integrator)
        if key not in self._followed:
            known = _of_most(list(others.values()))
            made = (one for one in known if own.steps_follow(integrator, one))
            self._followed[key] = next(made, "")
        return self._followed[key]

    def _text(self, engine: str, case: str, integrator: str | None) -> str:
        key = (engine, case, integrator)
        if key not in self._texts:
            text = "; ".join(self._cases[engine][case].sentences(integrator))
            self._texts[key] = self._conditioned(engine, case, integrator, text) if text else ""
        return self._texts[key]

    def _conditioned(self, engine: str, case: str, integrator: str | None, text: str) -> str:
        """The cause on the condition that experiments find; they are made once for each cause."""
        own = self._cases[engine][case]
        if integrator is None and own.of_forward_dynamics and self._changes(engine, own):
            return CHANGES
        if self.ask is not None and own.of_answers(integrator):
            text, known = self._in_batches(engine, own, text)
            if known:
                return text
        if integrator is not None and text in AGAIN.values() and self.ask is not None:
            return self._of_run_before(engine, own, integrator) or text
        subject = own.subject(integrator, text) if self.ask is not None else None
        if subject is None or self.ask is None:
            return text
        key = (engine, subject.key)
        if key not in self._conditions:
            if sum(name == engine for name, _ in self._conditions) >= MOST_EXPERIMENTS:
                return text
            call = partial(self._conditions_of, engine, own, subject)
            self._conditions[key] = self.ask(engine, call)
        return self._conditions[key].of(text)

    @property
    def lost(self) -> dict[str, str]:
        """By engine, the experiment in which it crashed or gave no answer, and how."""
        return {
            name: requests.lost_in for name, requests in self._requests.items() if requests.lost_in
        }

    def _changes(self, engine: str, own: CaseCauses) -> bool:
        """Whether an engine's omega-dot changes by itself: then no cause of it is one."""
        if engine not in self._unsteady and self.ask is not None:
            evidence = self._engines[engine].across.scenes[own.case.name].evidence[FORWARD]

            def call(driver: Driver) -> Conditions:
                requests = self._requests.setdefault(engine, Requests(driver))
                changes = changes_by_itself(requests, own.case, evidence.states, own.eps)
                return Conditions(CHANGES if changes else "")

            self._unsteady[engine] = bool(self.ask(engine, call).condition)
        return self._unsteady.get(engine, False)

    def _in_batches(self, engine: str, own: CaseCauses, text: str) -> tuple[str, bool]:
        """The cause with the batches of states in which it acts, and whether these decide."""
        if engine not in self._batches:
            cases = {name: one.case for name, one in self._cases[engine].items()}
            self._batches[engine] = InBatches(cases, self._engines[engine].across.scenes)
        batches, about = self._batches[engine], (own.case.name, text, own.of_torques)

        def call(driver: Driver) -> Conditions:
            requests = self._requests.setdefault(engine, Requests(driver))
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                batches.ask(requests, *about)
            return Conditions("")

        if batches.wants(text, own.of_torques) and self.ask is not None:
            self.ask(engine, call)
        with np.errstate(all="ignore"):
            return batches.of(*about)

    def _of_run_before(self, engine: str, own: CaseCauses, integrator: str) -> str:
        """What the first step of a run takes of the run before; "" where that is not known.

        It is found on the first case, and must hold on each of which it is said.
        """
        first = self._after.setdefault((engine, integrator), [])
        here = list[AfterRun]()

        def call(driver: Driver) -> Conditions:
            requests = self._requests.setdefault(engine, Requests(driver))
            names = sorted(own.integrators, key=lambda one: one.name != integrator)
            states = own.states.random[: PAIRS + 1]
            pairs = 1 if first else PAIRS
            with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
                here.extend(after_runs(requests, own.case, names, states, own.eps, pairs))
                return Conditions(taken_of_run_before([*first, *here]))

        assert self.ask is not None
        text = self.ask(engine, call).condition
        if not first and text:
            first.extend(here)
        return text if here else ""

    def _conditions_of(
        self, engine: str, own: CaseCauses, subject: Subject, driver: Driver
    ) -> Conditions:
        """Made on the engine's own thread."""
        name = subject.integrator.name if subject.integrator is not None else ""
        every = (one.steps_of(name) for one in self._cases[engine].values())
        steps = [one for one in every if one is not None]
        scenes = self._engines[engine].across.scenes
        requests = self._requests.setdefault(engine, Requests(driver))
        with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
            return conditions_of(subject, requests, own.case, scenes, steps, own.eps)


def diagnose(
    case: Case,
    truth: Truth,
    evaluation_states: EvaluationStates,
    result: CaseResult,
    runs: Sequence[JudgedRun],
) -> list[str]:
    """Sentences that explain the failed gates of one case; none without failure."""
    shared = shared_rows(case, evaluation_states, result)
    causes = CaseCauses(EngineOverScenarios(), case, truth, evaluation_states, result, shared, runs)
    found = causes.sentences(None)
    names = dict.fromkeys(run.integrator.name for run in _by_length(runs) if run.fails)
    for name in names if not found else ():
        found = causes.sentences(name)
        if found:
            break
    return list(dict.fromkeys(found))


def _of_most(texts: Sequence[str]) -> list[str]:
    """The causes of the kind that is named most often."""
    kinds = Counter(kind_of(text) for text in texts if is_named(text))
    most = kinds.most_common(1)[0][0] if kinds else ""
    return [text for text in dict.fromkeys(texts) if is_named(text) and kind_of(text) == most]


def _by_length(runs: Sequence[JudgedRun]) -> list[JudgedRun]:
    return sorted(runs, key=lambda run: run.sweep.steps)
