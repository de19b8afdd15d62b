"""The worker processes of a run: a process and a thread an engine, started and ended together."""

import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TypeVar

from omegadot.workers.harness_end.process import Answer, WorkerProcess

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


class WorkerPool:
    """Processes by name. Calls for one of them run on its own thread, in the order submitted.

    timeout: s, for one request.  jobs: requests at the same time.  memory: bytes, or None.
    """

    def __init__(
        self, targets: Mapping[str, str], setup: str, timeout: float, jobs: int, memory: int | None
    ) -> None:
        self.stopping = threading.Event()
        # First come, first served: where workers wait for a free processor, none waits for long.
        self._turns = ThreadPoolExecutor(jobs, "turn")
        self.processes = {
            name: WorkerProcess(target, setup, timeout, memory=memory)
            for name, target in targets.items()
        }
        self._threads = {name: ThreadPoolExecutor(1, name) for name in targets}

    def start_all(self) -> dict[str, Answer]:
        """Start every process; each answers with its engine's description, or why it has none."""
        # By turns: many engines that start together would only be late together.
        started = {name: self._turns.submit(p.start) for name, p in self.processes.items()}
        return {name: outcome_of(future) for name, future in started.items()}

    def in_turn(self, call: Callable[[], Answer]) -> Answer:
        """A request's answer, once fewer than `jobs` others are being answered."""
        return self._turns.submit(call).result()

    def submit(self, name: str, call: Callable[[], Result]) -> Future[Result]:
        """Have a call done on the engine's own thread, after what was submitted before."""
        return self._threads[name].submit(call)

    def stop(self) -> None:
        """End every process at once; answers that were on their way become interruptions."""
        self.stopping.set()
        for process in self.processes.values():
            process.stop()

    def finish(self) -> None:
        """End the threads, then the processes, which are idle by then or stopped already."""
        for threads in (*self._threads.values(), self._turns):
            threads.shutdown(wait=True, cancel_futures=True)
        for process in self.processes.values():
            process.finish()

    def deaths(self) -> list[tuple[str, str]]:
        """Which processes died, and how."""
        return [(name, how) for name, p in self.processes.items() for how in p.deaths]
