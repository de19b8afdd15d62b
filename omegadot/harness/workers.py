"""The worker processes of one run: one process and one thread an engine."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TypeVar

from omegadot.adapters.protocol import Description, Integrator
from omegadot.adapters.registry import BUILT_IN
from omegadot.adapters.wire import description_of
from omegadot.harness.drive import Driver
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.harness.usage import check_integrators
from omegadot.harness.worker_process import Answer, WorkerProcess

Result = TypeVar("Result")
SECONDS_ASLEEP = 0.2


def outcome_of(future: Future[Result]) -> Result:
    """A future's result, waited for in short turns.

    A signal may reach another thread than the main one, which then sees it only when it wakes: a
    single long wait would sleep through Ctrl-C.
    """
    while not future.done():
        wait([future], timeout=SECONDS_ASLEEP)
    return future.result()


def integrators_chosen(choice: EngineChoice, description: Description) -> tuple[Integrator, ...]:
    """The integrators asked for, in the engine's order; all of them when none was named."""
    if not choice.integrators:
        return description.integrators
    return tuple(i for i in description.integrators if i.name in choice.integrators)


class NoTruthError(Exception):
    """The exact solution's or the reference's worker did not start: nothing can be judged."""


class Workers:
    """Started once, asked through their drivers, ended together.

    engines: those asked for that started.  missing: those that did not, with the answer.
    """

    def __init__(self, request: RunRequest) -> None:
        self.request = request
        self._stopping = threading.Event()
        self._slots = threading.Semaphore(request.jobs)
        self._processes: dict[str, WorkerProcess] = {}
        self._threads: dict[str, ThreadPoolExecutor] = {}
        self.drivers: dict[str, Driver] = {}
        self.engines: list[Engine] = []
        self.missing: list[tuple[EngineChoice, Answer]] = []

    def start(self) -> None:
        """Start every engine asked for, and the two that know the truth.

        Raises NoTruthError where one of those two does not start.
        """
        wanted = {choice.name: choice for choice in self.request.choices}
        helpers = [EngineChoice(n, BUILT_IN[n]) for n in ("exact", "reference") if n not in wanted]
        setup, timeout, memory = self.request.setup, self.request.timeout, self.request.memory
        limit = None if memory is None else int(memory * 2**30)
        for choice in (*wanted.values(), *helpers):
            worker = WorkerProcess(choice.target, setup, timeout, memory=limit)
            self._processes[choice.name] = worker
            self._threads[choice.name] = ThreadPoolExecutor(1, choice.name)
        started = {
            name: self._threads[name].submit(self._start_one, worker)
            for name, worker in self._processes.items()
        }
        for choice in (*wanted.values(), *helpers):
            answer = outcome_of(started[choice.name])
            if not answer.ok:
                self.missing.append((choice, answer))
                continue
            description = description_of(answer.result)
            check_integrators(choice, description)
            engine = Engine(choice, description, integrators_chosen(choice, description))
            worker = self._processes[choice.name]
            self.drivers[choice.name] = Driver(engine, worker, self._slots, self._stopping)
            if choice.name in wanted:
                self.engines.append(engine)
        self._demand_truth()

    def _demand_truth(self) -> None:
        for choice, answer in self.missing:
            if choice.name in ("exact", "reference"):
                raise NoTruthError(
                    f"worker of {choice.name}: {answer.outcome} ({answer.reason}), and without it "
                    "nothing can be judged; give it more memory or time (--memory, --timeout)."
                )

    def _start_one(self, worker: WorkerProcess) -> Answer:
        with self._slots:  # many engines that start together would only be late together
            return worker.start()

    def stop(self) -> None:
        """End every worker at once; answers that were on their way become interruptions."""
        self._stopping.set()
        for worker in self._processes.values():
            worker.stop()

    def finish(self) -> None:
        """End the threads, then the workers, which are idle by then or stopped already."""
        for threads in self._threads.values():
            threads.shutdown(wait=True, cancel_futures=True)
        for worker in self._processes.values():
            worker.finish()

    def deaths(self) -> list[tuple[str, str]]:
        """Which workers died, and how."""
        return [(name, how) for name, p in self._processes.items() for how in p.deaths]

    def submit(self, name: str, call: Callable[[], Result]) -> Future[Result]:
        """Have a call done on the engine's own thread, after what was submitted before."""
        return self._threads[name].submit(call)
