"""An engine in this very process, called as in a worker: the same operations, the same wire."""

from __future__ import annotations

import io
import threading
from typing import Any, cast

from omegadot.adapters.protocol import Adapter, Integrator, UnsupportedError
from omegadot.harness.drive import Driver
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.workers.engine_end.described import description_of
from omegadot.workers.engine_end.operations import OPERATIONS
from omegadot.workers.frame_reader import read_frame
from omegadot.workers.harness_end.process import Answer, WorkerProcess
from omegadot.workers.wire import encode_frame


def _sent(message: dict[str, Any]) -> dict[str, Any]:
    return read_frame(io.BytesIO(encode_frame(message)))


class Local:
    """Stands for a `WorkerProcess`; what raises is an answer, what crashes is a crash."""

    started = True

    def __init__(self, adapter: Adapter) -> None:
        self.adapter = adapter

    def request(self, operation: str, **fields: Any) -> Answer:
        """Put one request."""
        try:
            found = OPERATIONS[operation](self.adapter, _sent(fields))
        except UnsupportedError as error:
            return Answer("unsupported", str(error))
        except Exception as error:
            return Answer("raised", f"{type(error).__name__}: {error}")
        return Answer("ok", result=_sent({"result": found})["result"])

    def stop(self) -> None:
        """Nothing: the adapter is the caller's."""


def driver_of(name: str, adapter: Adapter, integrators: tuple[Integrator, ...] = ()) -> Driver:
    """A driver of an adapter in this process, running the integrators given (all by default)."""
    description = description_of(adapter)
    engine = Engine(EngineChoice(name, ""), description, integrators or description.integrators)
    worker = cast(WorkerProcess, Local(adapter))
    return Driver(engine, worker, lambda call: call(), threading.Event())
