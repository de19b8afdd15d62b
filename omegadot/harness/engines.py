"""The engines of a run: those that were requested, and the two that every judgement needs."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

from omegadot.adapters.protocol import Description, Integrator
from omegadot.adapters.registry import BUILT_IN
from omegadot.harness.arguments import check_integrators
from omegadot.harness.drive import Driver
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.workers.harness_end.pool import Limits, WorkerPool
from omegadot.workers.harness_end.process import Answer
from omegadot.workers.wire import description_of

Result = TypeVar("Result")
TRUTH = ("exact", "reference")


def integrators_chosen(choice: EngineChoice, description: Description) -> tuple[Integrator, ...]:
    """The integrators requested, in the engine's order; all of them when none was named."""
    if not choice.integrators:
        return description.integrators
    return tuple(i for i in description.integrators if i.name in choice.integrators)


class NoTruthError(Exception):
    """The exact solution's or the reference's worker did not start: nothing can be judged."""


class Engines:
    """Started once, used through their drivers, ended together.

    started: those requested that started.  missing: those that did not, with the answer.
    """

    def __init__(self, request: RunRequest) -> None:
        self.request = request
        requested = {choice.name: choice for choice in request.choices}
        added = {n: EngineChoice(n, BUILT_IN[n]) for n in TRUTH if n not in requested}
        self._choices = {**requested, **added}
        self._requested = set(requested)
        memory = None if request.memory is None else int(request.memory * 2**30)
        targets = {name: choice.target for name, choice in self._choices.items()}
        self._pool = WorkerPool(
            targets, request.setup, Limits(request.timeout, request.jobs, memory)
        )
        self.drivers: dict[str, Driver] = {}
        self.started: list[Engine] = []
        self.missing: list[tuple[EngineChoice, Answer]] = []

    def start(self) -> None:
        """Start every engine requested, the exact solution and the reference.

        Raises NoTruthError where one of the last two does not start, UsageError where an
        integrator is requested that an engine does not have.
        """
        for name, answer in self._pool.start().items():
            choice = self._choices[name]
            if not answer.ok:
                self.missing.append((choice, answer))
                continue
            description = description_of(answer.result)
            check_integrators(choice, description)
            engine = Engine(choice, description, integrators_chosen(choice, description))
            pool = self._pool
            self.drivers[name] = Driver(engine, pool.processes[name], pool.in_turn, pool.stopping)
            if name in self._requested:
                self.started.append(engine)
        self._require_truth()

    def _require_truth(self) -> None:
        for choice, answer in self.missing:
            if choice.name in TRUTH:
                raise NoTruthError(
                    f"worker of {choice.name}: {answer.outcome} ({answer.reason}), and without it "
                    f"nothing can be judged; {_advice(answer)}."
                )

    def submit(self, name: str, call: Callable[[], Result]) -> Future[Result]:
        """Have a call done on the engine's own thread, after what was submitted before."""
        return self._pool.submit(name, call)

    def stop(self) -> None:
        """End every worker at once; answers that were on their way become interruptions."""
        self._pool.stop()

    def finish(self) -> None:
        """Wait for the calls submitted, then end the workers."""
        self._pool.finish()

    def deaths(self) -> list[tuple[str, str]]:
        """Which workers died, and how."""
        return self._pool.deaths()


def _advice(answer: Answer) -> str:
    """What to do about a worker that did not start, by how it ended."""
    if answer.outcome == "timeout":
        return "give it more time (--timeout)"
    if "MemoryError" in answer.reason or "SIGKILL" in answer.reason:
        return "give it more memory (--memory)"
    if "ImportError" in answer.reason or "ModuleNotFoundError" in answer.reason:
        return (
            "a module is missing, or a file on PYTHONPATH hides it: install the one, or rename the "
            "other"
        )
    return "correct what this message names"
