"""The harness's side of a worker, against programs that are no workers."""

import os
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from omegadot.adapters.protocol import Description
from omegadot.reference_impl.system import State
from omegadot.workers import machine
from omegadot.workers.harness_end import process as worker_process
from omegadot.workers.harness_end.process import WorkerProcess
from omegadot.workers.machine import memory_of_machine
from omegadot.workers.wire import encode_frame

WELCOME = encode_frame({"outcome": "ok", "result": Description("engine", "1.0", ())})
PRINT = "import os, time; os.write(1, {text!r}); "
NAMES_ITS_LIMIT = (
    "import resource, omegadot.workers.engine_end.worker as w; w.limit_memory(int(w.os.environ"
    "[w.MEMORY_VARIABLE])); r = str(resource.getrlimit(resource.RLIMIT_DATA)[0]); "
    "from omegadot.adapters.protocol import Description; "
    "w.os.write(1, w.encode_frame({'outcome': 'ok', 'result': Description('engine', r, ())}))"
)


def worker_of(code: str, timeout: float = 1.0, memory: int | None = None) -> WorkerProcess:
    command = [sys.executable, "-c", code]
    return WorkerProcess("none", "physics", timeout, command, memory)


def test_a_worker_that_does_not_read_blocks_no_thread() -> None:
    worker = worker_of(PRINT.format(text=WELCOME) + "time.sleep(3600)")
    assert worker.start().ok
    started = time.monotonic()
    answer = worker.request("forward", states=np.zeros(10_000_000))  # far more than a pipe holds
    assert answer.outcome == "timeout"
    assert time.monotonic() - started < 30.0
    assert not worker.started


def test_a_start_has_its_own_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker_process, "SECONDS_TO_START", 2.0)
    late = worker_of("import time; time.sleep(3600)", timeout=0.1).start()
    assert (late.outcome, late.reason) == (
        "timeout",
        "not started within 2 s; the worker was ended",
    )


def test_a_slow_start_is_no_slow_answer() -> None:
    worker = worker_of("import time; time.sleep(0.5); " + PRINT.format(text=WELCOME), timeout=0.1)
    assert worker.start().ok
    worker.stop()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (b"", "ended with exit code 0"),
        (b"\0\0", "ended with exit code 0"),
        (b"\0" * 8, "its answer cannot be read"),
        (b"welcome to the engine", "its answer cannot be read: it begins with b'welcome '"),
        (encode_frame({"a": np.ones(9)})[:-8], "ended with exit code 0"),
    ],
)
def test_what_is_no_frame_is_a_crash(text: bytes, reason: str) -> None:
    worker = worker_of(PRINT.format(text=text))
    answer = worker.start()
    assert answer.outcome == "crashed"
    assert answer.reason.startswith(reason)
    assert len(worker.deaths) == 1


RUN = {
    "time": np.zeros(2),
    "state": State(np.zeros((2, 4)), *np.zeros((3, 2, 3))),
    "omega_dot": np.zeros((2, 3)),
    "seconds_per_step": 1e-6,
}


@pytest.mark.parametrize(
    ("frame", "reason"),
    [
        ([1], "it is of type list"),
        ({"outcome": "ok", "result": RUN, "x": 1}, "it has the key 'x'"),
        ({"outcome": "best"}, "its outcome is 'best'"),
        ({"outcome": "raised", "reason": 5}, "its reason is of type int"),
        ({"outcome": "ok"}, "TypeError"),
        ({"outcome": "ok", "result": {**RUN, "time": 1.0}}, "TypeError"),
        ({"outcome": "ok", "result": {**RUN, "time": np.zeros(3)}}, "the state.orientation has"),
        ({"outcome": "ok", "result": {**RUN, "omega_dot": [[1.0]]}}, "omega_dot has the shape"),
        ({"outcome": "ok", "result": {**RUN, "seconds_per_step": 0.0}}, "its seconds_per_step is"),
        ({"outcome": "ok", "result": {**RUN, "seconds_per_step": np.nan}}, "its seconds_per_step"),
        ({"outcome": "ok", "result": {**RUN, "state": {"orientation": 1}}}, "TypeError"),
    ],
)
def test_a_frame_of_another_kind_is_a_crash(frame: Any, reason: str) -> None:
    """Caught: a TypeError of the harness, which loses what every other engine has answered."""
    worker = worker_of(PRINT.format(text=WELCOME + encode_frame(frame)) + "time.sleep(3600)")
    assert worker.start().ok
    answer = worker.request("run")
    assert answer.outcome == "crashed"
    assert "what it answers is no answer" in answer.reason
    assert reason in answer.reason
    assert not worker.started


@pytest.mark.parametrize("result", [{}, "engine", {"name": "x"}, {"integrators": 5}])
def test_a_worker_starts_with_its_description(result: Any) -> None:
    worker = worker_of(PRINT.format(text=encode_frame({"outcome": "ok", "result": result})))
    assert worker.start().outcome == "crashed"


def test_a_run_in_a_frame_is_an_answer() -> None:
    frame = encode_frame({"outcome": "ok", "result": RUN, "seconds": 0.1})
    worker = worker_of(PRINT.format(text=WELCOME + frame) + "time.sleep(3600)")
    assert worker.start().ok
    assert worker.request("run").ok
    worker.stop()


def test_a_program_that_is_not_there_is_reported() -> None:
    answer = WorkerProcess("none", "physics", 1.0, ["/nowhere/python"]).start()
    assert answer.outcome == "crashed"
    assert "could not be started" in answer.reason


def test_a_worker_that_is_not_running_gets_no_request() -> None:
    assert worker_of("").request("model").reason == "the worker is not running"


@pytest.mark.parametrize("memory", [None, 2**30])
def test_a_worker_has_half_of_the_memory_or_what_it_is_given(memory: int | None) -> None:
    worker = worker_of(NAMES_ITS_LIMIT, 20.0, memory)
    assert worker.start().result["version"] == str(memory or memory_of_machine() // 2)
    worker.stop()


def test_a_death_between_requests_is_counted() -> None:
    worker = worker_of(PRINT.format(text=WELCOME) + "time.sleep(3600)")
    worker.start()
    assert worker.pid is not None
    os.kill(worker.pid, 9)
    while worker._pipes is not None and worker._pipes.process.poll() is None:
        time.sleep(0.01)
    worker.finish()
    assert worker.deaths == ["ended by signal 9 (SIGKILL)"]


def test_what_the_harness_ends_is_no_death() -> None:
    worker = worker_of(PRINT.format(text=WELCOME) + "time.sleep(3600)", 60.0)
    worker.start()
    threading.Timer(0.1, worker.stop).start()
    assert worker.request("model").outcome == "crashed"
    assert worker.deaths == []


def test_peak_memory_is_the_workers_own_and_holds_what_it_gave_back() -> None:
    """Linux's getrusage would count what the starting process held: 400 MB here."""
    held = np.ones(50_000_000)
    worker = WorkerProcess("omegadot.adapters.reference.adapter:ReferenceAdapter", "physics", 60.0)
    assert worker.start().ok
    found = worker.peak_memory()
    worker.stop()
    assert found is not None
    assert 10e6 < found < held.nbytes
    assert worker.peak_memory() is None


def test_a_container_may_have_less_than_its_machine(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    whole = memory_of_machine()
    (tmp_path / "given").write_text("1073741824\n")
    (tmp_path / "none").write_text("max\n")
    for name, most in (("none", whole), ("missing", whole), ("given", 2**30)):
        monkeypatch.setattr(machine, "CONTAINER_LIMITS", (str(tmp_path / name),))
        assert memory_of_machine() == most


def test_a_processor_is_named_where_the_system_names_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine.sys, "platform", "darwin")
    monkeypatch.setattr(machine.subprocess, "check_output", lambda *_, **__: "Apple M2\n")
    assert machine.describe_machine()["processor"] == "Apple M2"
    monkeypatch.setattr(machine.sys, "platform", "other")
    monkeypatch.setattr(machine.Path, "read_text", lambda *_, **__: "BogoMIPS : 50\n")
    assert machine.describe_machine()["processor"]
