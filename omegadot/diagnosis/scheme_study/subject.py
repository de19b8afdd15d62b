"""The integrator under study: something that steps a probe, wherever it runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from omegadot.adapters.protocol import Integrator
from omegadot.reference_impl.system import State, System
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import description_of


class NoAnswerError(Exception):
    """The engine did not answer; the answer reports the outcome and the reason."""

    def __init__(self, answer: Answer) -> None:
        super().__init__(answer.reason)
        self.answer = answer


Stepper = Callable[[State, float, int, int], State]
"""Of initial, timestep, steps and every: the states at step 0, each `every`-th and the last.

Raises NoAnswerError.
"""


def _requested(worker: WorkerProcess, operation: str, **fields: object) -> Answer:
    answer = worker.request(operation, **fields)
    if not answer.ok:
        raise NoAnswerError(answer)
    return answer


def load(worker: WorkerProcess, system: System) -> dict[str, Integrator]:
    """Load a system; the integrators as declared for it. A worker that died is started again.

    Raises NoAnswerError.
    """
    if not worker.started:
        started = worker.start()
        if not started.ok:
            raise NoAnswerError(started)
    answer = _requested(worker, "load", system=system)
    return {i.name: i for i in description_of(answer.result).integrators}


def one_of(declared: Mapping[str, Integrator], name: str) -> Integrator:
    """The integrator of this name. Raises NoAnswerError where the system has none."""
    if name not in declared:
        raise NoAnswerError(Answer("unsupported", "it is not declared for this system"))
    return declared[name]


def stepper_of(worker: WorkerProcess, integrator: str, accuracy: float | None = None) -> Stepper:
    """The steps of one integrator, over the system that the worker has loaded.

    accuracy: of an error-controlled one, which steps from sample to sample as it likes.
    """

    def step(initial: State, timestep: float, steps: int, every: int) -> State:
        plan = {"timestep": timestep, "steps": steps, "every": every, "accuracy": accuracy}
        answer = _requested(worker, "run", initial=initial, integrator=integrator, **plan)
        state, kept = State(**answer.result["state"]), -(-steps // every) + 1
        if len(state.orientation) != kept:
            came = f"{len(state.orientation)} samples came back, {kept} were requested"
            raise NoAnswerError(Answer("raised", came))
        return state

    return step
