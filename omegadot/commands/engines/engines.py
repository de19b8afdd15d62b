"""``omegadot.engines``: what is installed, and what each engine reports of itself."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from omegadot.adapters.protocol import Description
from omegadot.adapters.registry import OPTIONAL, is_absent
from omegadot.commands.engines.install import install as install_group
from omegadot.commands.typed import typed
from omegadot.harness.arguments import engine_choices, several
from omegadot.harness.engine_target import EngineLike
from omegadot.harness.plan import EngineChoice
from omegadot.workers.harness_end.process import WorkerProcess
from omegadot.workers.wire import description_of

START_TIMEOUT = 60.0


@dataclass(frozen=True)
class EngineEntry:
    """An engine. description: its version, integrators and conventions; None where it did not
    start, and then the reason.
    """

    name: str
    description: Description | None
    reason: str = ""

    @property
    def installed(self) -> bool:
        """Whether it started."""
        return self.description is not None


@typed
def engines(
    adapters: EngineLike | Sequence[EngineLike] = (), install: str | None = None
) -> tuple[EngineEntry, ...]:
    """Every engine that is registered, each started in a process of its own.

    Optional ones that are not installed are among them, with what installs them.
    adapters: engines of your own in addition, by class.  install: engines that are installed
    first; "node" stands for those that run through Node. Raises UsageError.
    """
    if install is not None:
        install_group(install)
    choices = engine_choices([], several(adapters))
    choices += [EngineChoice(name, OPTIONAL[name]) for name in OPTIONAL if is_absent(name)]
    with ThreadPoolExecutor() as threads:
        return tuple(threads.map(entry_of, choices))


def entry_of(choice: EngineChoice) -> EngineEntry:
    """One engine, started in a process of its own to describe itself."""
    worker = WorkerProcess(choice.target, "physics", START_TIMEOUT)
    answer = worker.start()
    worker.finish()
    if not answer.ok:
        return EngineEntry(choice.name, None, answer.reason)
    return EngineEntry(choice.name, description_of(answer.result))
