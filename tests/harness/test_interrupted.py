"""Ctrl-C while engines start, and while they are waited for."""

import os
import signal
import threading
import time
from concurrent.futures import Future
from typing import Any

import pytest

from omegadot.harness.engines import Engines, NoTruthError, outcome_of
from omegadot.harness.outcome import RunRequest
from omegadot.workers.harness_end.process import Answer, WorkerProcess


def test_ctrl_c_ends_a_wait_wherever_it_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Caught: a condition, in which Ctrl-C at the wrong moment becomes a RuntimeError."""

    def press() -> None:
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGINT)

    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    never: Future[None] = Future()
    thread = threading.Thread(target=press)
    thread.start()
    monkeypatch.setattr(threading.Condition, "_acquire_restore", interrupted)
    with pytest.raises(KeyboardInterrupt):
        outcome_of(never)
    thread.join()


def test_no_engine_starts_in_a_run_that_was_interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Caught: a worker that starts after the others were ended, and is waited for."""
    engines, started = Engines(RunRequest([], [], jobs=1)), []

    def start(process: WorkerProcess) -> Answer:
        started.append(process)
        engines.stop()
        return Answer("crashed")

    monkeypatch.setattr(WorkerProcess, "start", start)
    with pytest.raises(NoTruthError):
        engines.start()
    engines.finish()
    assert len(started) == 1
