"""Put one engine through one scenario: load, read back, equation, every integrator and step.

A request that crashes the worker, or that gets no answer in time, costs its own task; the worker
is started again and the next request goes on.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Case, Sweep
from omegadot.gates.runs.repeats import How
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.steps.probe import Probe
from omegadot.harness.loaded_before import LoadedBefore, Loads
from omegadot.harness.plan import Engine
from omegadot.reference_impl.system import State, System
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import description_of

MOST_TIMEOUTS_IN_A_ROW = 3
# Outcomes of loading a scenario that deserve a second attempt; the others would come again.
MAY_PASS = {"crashed", "timeout", "interrupted"}
INTERRUPTED = Answer("interrupted", "the run was interrupted before this task")
RELOADED = "reloaded"
LACKING = Answer("unsupported", "the engine offers no such call")


@dataclass
class CaseResult:
    """What one engine answered for one scenario; answers that failed are kept as such.

    integrators: those that are run, as the engine declares them for this system.
    runs: by integrator and its step or accuracy.  begun: of those that raise, whose scheme is not
    known, the samples until then, and no numbers from there on.
    first_steps, restarts: of integrators whose scheme is unknown, what was requested and what came:
    steps from several states, and the sample from which a run was restarted with some of its rest.
    alone, inverse_alone: forward and inverse dynamics of the first random state by itself.
    siblings: by what was changed in the system, the system that was loaded next, the states, and
    forward dynamics there.
    scaled: the same by what was doubled, where forward dynamics are wrong; judged by no gate.
    opposites: the same by what is the other way than in the system, where forward dynamics are
    wrong; judged by no gate.  opposite_steps: by integrator and by that, first steps where these
    alone are wrong.
    turned: by integrator and its step, the states of the same run in turned worlds, turned back.
    reloaded: forward dynamics after another system was loaded in between.  again: the beginnings
    of runs that were requested again, by integrator, step, and how (see `gates.repeats`).
    via: the format of the file by which the body went in; "" for the engine's API.
    own_rounding: the bound of omega-dot by the engine's own rounding, where that was looked at.
    before: what had been loaded before the case (""), before each sibling, by what was changed, and
    before the case was loaded again (RELOADED).
    """

    integrators: tuple[Integrator, ...] = ()
    model: Answer = INTERRUPTED
    forward: Answer = INTERRUPTED
    path: Answer = INTERRUPTED
    inverse: Answer = INTERRUPTED
    runs: dict[tuple[str, float], Answer] = field(default_factory=dict)
    begun: dict[tuple[str, float], State] = field(default_factory=dict)
    first_steps: dict[str, tuple[Probe, Answer]] = field(default_factory=dict)
    restarts: dict[tuple[str, float], tuple[int, Sweep, Answer]] = field(default_factory=dict)
    alone: Answer = LACKING
    inverse_alone: Answer = LACKING
    siblings: dict[str, tuple[System, State, Answer]] = field(default_factory=dict)
    scaled: dict[str, tuple[System, State, Answer]] = field(default_factory=dict)
    opposites: dict[str, tuple[System, State, Answer]] = field(default_factory=dict)
    opposite_steps: dict[tuple[str, str], tuple[System, Probe, Answer]] = field(
        default_factory=dict
    )
    turned: dict[tuple[str, float], list[State]] = field(default_factory=dict)
    reloaded: Answer = LACKING
    again: dict[tuple[str, float, How], Answer] = field(default_factory=dict)
    precision: str = "float64"
    via: str = ""
    own_rounding: float | None = None
    before: dict[str, LoadedBefore] = field(default_factory=dict)

    def first_failure(self) -> Answer | None:
        """The first answer besides the runs that failed; unsupported parts are no failure."""
        named = {
            "reading the model back": self.model,
            "forward dynamics": self.forward,
            "forward dynamics along the trajectory": self.path,
            "inverse dynamics": self.inverse,
            "forward dynamics of one state": self.alone,
            "inverse dynamics of one state": self.inverse_alone,
            "forward dynamics after another system": self.reloaded,
            **{f"another {what}": found[2] for what, found in self.siblings.items()},
        }
        for name, answer in named.items():
            if answer.outcome not in ("ok", "unsupported"):
                return replace(answer, reason=f"{name}: {answer.reason}")
        return None


class Driver:
    """One engine's worker with the engine's memory of failures."""

    def __init__(
        self,
        engine: Engine,
        worker: WorkerProcess,
        in_turn: Callable[[Callable[[], Answer]], Answer],
        stopping: threading.Event,
    ) -> None:
        self.engine, self.worker = engine, worker
        self._in_turn, self._stopping = in_turn, stopping
        self._timeouts_in_a_row = 0
        self._loaded: Case | None = None
        self._loads = Loads()
        self._tried: set[str] = set()
        self._refused: dict[str, Answer] = {}
        self._declared: tuple[Integrator, ...] = ()
        self._primed = False

    def prime(self, others: Sequence[Case]) -> None:
        """Before any other, load the first of these systems that the engine takes, once.

        What is kept of a first system is then none of the first case's, which it would be right on.
        """
        if not self._primed:
            self._primed = True
            any(self._load(other).ok for other in others)
            self._timeouts_in_a_row = 0  # no case was requested

    def _send(self, call: Callable[[], Answer]) -> Answer:
        """What a call to the worker comes to, when its turn has come."""
        answer = self._in_turn(call)
        if self._stopping.is_set() and not answer.ok:
            return INTERRUPTED
        late = answer.outcome == "timeout"
        self._timeouts_in_a_row = self._timeouts_in_a_row + 1 if late else 0
        if not self.worker.started:
            self._loaded = None
        return answer

    def _load(self, case: Case) -> Answer:
        """Have the worker up and the scenario loaded, whatever went before."""
        if self._timeouts_in_a_row >= MOST_TIMEOUTS_IN_A_ROW:
            return Answer("timeout", f"not tried: {self._timeouts_in_a_row} time-outs in a row")
        if case.name in self._refused:
            return self._refused[case.name]
        if not self.worker.started:
            self._loads = Loads()
            started = self._send(self.worker.start)
            if not started.ok:
                return started
        if self._loaded is case:
            return Answer("ok")
        answer = self._send(partial(self.worker.request, "load", system=case.system))
        self._loaded = case if answer.ok else None
        if answer.ok:
            self._loads.add(case.system)
            self._declared = description_of(answer.result).integrators
        elif answer.outcome not in MAY_PASS or case.name in self._tried:
            self._refused[case.name] = answer
        self._tried.add(case.name)
        return answer

    @property
    def before(self) -> LoadedBefore:
        """What the worker had been loaded with before the system that it has now."""
        return self._loads.before

    def restart(self) -> None:
        """Have the next request start the worker afresh: nothing that it kept is left."""
        self.worker.stop()
        self._loaded = None

    def integrators(self) -> tuple[Integrator, ...]:
        """The integrators to run, as declared for the system that was loaded last."""
        declared = {integrator.name: integrator for integrator in self._declared}
        return tuple(declared.get(i.name, i) for i in self.engine.integrators)

    def request(self, case: Case, operation: str, **fields: Any) -> Answer:
        """One request about a case; what fails is the answer."""
        loaded = self._load(case)
        return (
            self._send(partial(self.worker.request, operation, **fields)) if loaded.ok else loaded
        )

    def run(
        self, case: Case, integrator: str, sweep: Sweep, initial: State | None = None
    ) -> Answer:
        """One integrator with one step size or accuracy, from the case's own state or another."""
        return self.request(
            case,
            "run",
            initial=initial or case.initial,
            integrator=integrator,
            timestep=sweep.timestep,
            steps=sweep.steps,
            every=sweep.every,
            accuracy=sweep.accuracy,
        )

    def replay(self, case: Case, integrator: str, sweep: Sweep, initial: State) -> Answer:
        """The states of a run alone, without what measures its cost: no step goes before it."""
        how = {"initial": initial, "integrator": integrator, **vars(sweep)}
        return self.request(case, "replay", **how)

    def evaluate_equations(self, case: Case, evaluation_states: EvaluationStates) -> CaseResult:
        """The model read back, and the engine's equations at the states in question."""
        precision, via = self.engine.description.precision, self.engine.choice.via
        result = CaseResult(precision=precision, via=via)
        features = self.engine.description.features
        first, before = evaluation_states.random[0], evaluation_states.random[1]
        result.model = self.request(case, "model", state=first, before=before)
        result.before[""] = self.before
        result.integrators = self.integrators()
        result.forward = result.path = result.inverse = LACKING
        states, acceleration = evaluation_states.random, evaluation_states.acceleration
        one, its = states[:1], acceleration[:1]
        if "forward_dynamics" in features:
            result.alone = self.request(case, "forward", states=one)
            result.forward = self.request(case, "forward", states=states)
            result.path = self.request(case, "forward", states=evaluation_states.path)
        if "inverse_dynamics" in features:
            result.inverse_alone = self.request(case, "inverse", states=one, acceleration=its)
            result.inverse = self.request(case, "inverse", states=states, acceleration=acceleration)
        return result

    def run_all(
        self, case: Case, finished: Callable[[], object]
    ) -> dict[tuple[str, float], Answer]:
        """Every integrator with every step or accuracy; `finished` is called after each run."""
        runs = {}
        for integrator in self.integrators():
            for sweep in case.sweeps_of(integrator):
                runs[integrator.name, sweep.knob] = self.run(case, integrator.name, sweep)
                finished()
        return runs
