"""A system put into a version's worker, which is started again where it has died."""

from __future__ import annotations

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.scheme_study.subject import NoAnswerError
from omegadot.reference_impl.system import System
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import description_of


def answer_of(worker: WorkerProcess, operation: str, **fields: object) -> Answer:
    """An answer, or "unsupported". Raises NoAnswerError for any other."""
    answer = worker.request(operation, **fields)
    if answer.ok or answer.outcome == "unsupported":
        return answer
    raise NoAnswerError(answer)


def load(worker: WorkerProcess, system: System) -> dict[str, Integrator]:
    """The integrators as declared for the system, which is then loaded. Raises NoAnswerError."""
    if not worker.started:
        started = worker.start()
        if not started.ok:
            raise NoAnswerError(started)
    answer = worker.request("load", system=system)
    if not answer.ok:
        raise NoAnswerError(answer)
    return {i.name: i for i in description_of(answer.result).integrators}
