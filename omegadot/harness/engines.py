"""The engines of a run: those that were requested, and the two that every judgement needs."""

from omegadot.adapters.registry import BUILT_IN
from omegadot.harness.arguments import integrators_chosen
from omegadot.harness.drive import Driver
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.workers.harness_end.pool import WorkerPool
from omegadot.workers.harness_end.process import Answer
from omegadot.workers.wire import description_of

TRUTH = ("exact", "reference")


class NoTruthError(Exception):
    """The exact solution's or the reference's worker did not start: nothing can be judged."""


class Engines(WorkerPool):
    """Started once, used through their drivers, ended together.

    started: those requested that started.  missing: those that did not, with the answer.
    """

    def __init__(self, request: RunRequest) -> None:
        requested = {choice.name: choice for choice in request.choices}
        added = {n: EngineChoice(n, BUILT_IN[n]) for n in TRUTH if n not in requested}
        self._choices = {**requested, **added}
        self._requested = set(requested)
        memory = None if request.memory is None else int(request.memory * 2**30)
        targets = {name: choice.target for name, choice in self._choices.items()}
        super().__init__(targets, request.setup, request.timeout, request.jobs, memory)
        self.drivers: dict[str, Driver] = {}
        self.started: list[Engine] = []
        self.missing: list[tuple[EngineChoice, Answer]] = []

    def start(self) -> None:
        """Start every engine requested, the exact solution and the reference.

        Raises NoTruthError where one of the last two does not start, UsageError where an
        integrator is requested that an engine does not have.
        """
        for name, answer in self.start_all().items():
            choice = self._choices[name]
            if not answer.ok:
                self.missing.append((choice, answer))
                continue
            description = description_of(answer.result)
            engine = Engine(choice, description, integrators_chosen(choice, description))
            self.drivers[name] = Driver(engine, self.processes[name], self.in_turn, self.stopping)
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
