"""The engines of a run: those that were requested, and the two that every judgement needs."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from typing import TypeVar

from omegadot.adapters.registry import BUILT_IN
from omegadot.harness.arguments import integrators_chosen
from omegadot.harness.drive import INTERRUPTED, Driver
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.harness.usage import UsageError
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import description_of

Result = TypeVar("Result")
TRUTH = ("exact", "reference")
SECONDS_ASLEEP = 0.2


def outcome_of(future: Future[Result]) -> Result:
    """A future's result, waited for in short turns.

    A signal may reach another thread than the main one, which then sees it only when it wakes: a
    single long wait would sleep through Ctrl-C. What is waited for is a bare lock: Ctrl-C as a
    condition takes its lock back would become a RuntimeError.
    """
    ready = threading.Lock()
    ready.acquire()
    future.add_done_callback(lambda _: ready.release())
    while not ready.acquire(timeout=SECONDS_ASLEEP):
        pass
    return future.result()


class NoTruthError(Exception):
    """The exact solution's or the reference's worker did not start: nothing can be judged."""


class Engines:
    """A process and a thread for each, started once, used through their drivers, ended together.

    Calls for one of them run on its own thread, in the order submitted.
    started: those requested that started.  missing: those that did not, with the answer.
    """

    def __init__(self, request: RunRequest) -> None:
        requested = {choice.name: choice for choice in request.choices}
        added = {n: EngineChoice(n, BUILT_IN[n]) for n in TRUTH if n not in requested}
        self._choices = {**requested, **added}
        self._requested = set(requested)
        memory = None if request.memory is None else int(request.memory * 2**30)
        self._stopping = threading.Event()
        # First come, first served: where workers wait for a free processor, none waits for long.
        self._turns = ThreadPoolExecutor(request.jobs, "turn")
        self._processes = {
            name: WorkerProcess(
                choice.target, request.setup, request.timeout, memory=memory, via=choice.via
            )
            for name, choice in self._choices.items()
        }
        self._threads = {name: ThreadPoolExecutor(1, name) for name in self._choices}
        self.drivers: dict[str, Driver] = {}
        self.started: list[Engine] = []
        self.missing: list[tuple[EngineChoice, Answer]] = []

    def start(self) -> None:
        """Start every engine requested, the exact solution and the reference.

        Raises NoTruthError where one of the last two does not start, UsageError where an
        integrator or a way in is requested that an engine does not have.
        """
        # By turns: many engines that start together would only be late together.
        starts = {
            name: self._turns.submit(self._called, p.start) for name, p in self._processes.items()
        }
        answers = {name: outcome_of(future) for name, future in starts.items()}
        for name, answer in answers.items():
            choice, process = self._choices[name], self._processes[name]
            if not answer.ok:
                if choice.via and choice.required and answer.outcome == "unsupported":
                    raise UsageError(f"--via {choice.via}: {answer.reason}.")
                self.missing.append((choice, answer))
                continue
            description = replace(description_of(answer.result), name=name)
            engine = Engine(choice, description, integrators_chosen(choice, description))
            self.drivers[name] = Driver(engine, process, self._in_turn, self._stopping)
            if name in self._requested:
                self.started.append(engine)
        for choice, answer in self.missing:
            if choice.name in TRUTH:
                raise NoTruthError(
                    f"worker of {choice.name}: {answer.outcome} ({answer.reason}), and without it "
                    f"nothing can be judged; {_advice(answer)}."
                )

    def _in_turn(self, call: Callable[[], Answer]) -> Answer:
        """A request's answer, once fewer than `jobs` others are being answered."""
        return self._turns.submit(self._called, call).result()

    def _called(self, call: Callable[[], Answer]) -> Answer:
        """A call's answer; none is made whose turn comes when the run has been interrupted."""
        return INTERRUPTED if self._stopping.is_set() else call()

    def submit(self, name: str, call: Callable[[], Result]) -> Future[Result]:
        """Have a call done on the engine's own thread, after what was submitted before."""
        return self._threads[name].submit(call)

    def stop(self) -> None:
        """End every process at once; answers that were on their way become interruptions."""
        self._stopping.set()
        for process in self._processes.values():
            process.stop()

    def finish(self) -> None:
        """End the threads, then the processes, which are idle by then or stopped already."""
        for threads in (*self._threads.values(), self._turns):
            threads.shutdown(wait=True, cancel_futures=True)
        for process in self._processes.values():
            process.finish()

    def deaths(self) -> list[tuple[str, str]]:
        """Which processes died, and how."""
        return [(name, how) for name, p in self._processes.items() for how in p.deaths]


def _advice(answer: Answer) -> str:
    """What to do about a worker that did not start, by how it ended."""
    if answer.outcome == "timeout":
        return "give it more time (--timeout; a start has 20 s in any case)"
    if "MemoryError" in answer.reason or "SIGKILL" in answer.reason:
        return "give it more memory (--memory)"
    if "ImportError" in answer.reason or "ModuleNotFoundError" in answer.reason:
        return (
            "a module is missing, or a file on PYTHONPATH hides it: install the one, or rename the "
            "other"
        )
    return "correct what this message names"
