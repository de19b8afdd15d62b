"""What an engine starts ends with it, though it has left session, group and environment."""

import sys
import time
from pathlib import Path

import psutil
import pytest

from omegadot.workers.harness_end.process import Answer, WorkerProcess

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="no system else adopts orphans")

ENGINE = """
import os, subprocess, time
from omegadot.adapters.reference import ReferenceAdapter

class Engine(ReferenceAdapter):
    def load(self, system):
        first = os.fork()  # whose child is an orphan
        if first == 0:
            child = subprocess.Popen(["sleep", "600"], env={}, start_new_session=True)
            with open("left", "w") as file:
                file.write(str(child.pid))
            os._exit(0)
        os.waitpid(first, 0)
        ENDS
"""
ENDS = {
    "answers": "raise ValueError('no')",
    "leaves": "os._exit(9)",
    "dies": "os.kill(os.getpid(), 11)",
    "hangs": "time.sleep(600)",
    "closes": "os.closerange(0, 64); time.sleep(600)",
}
EXPECTED = {
    "answers": ("raised", "ValueError: no"),
    "leaves": ("crashed", "ended with exit code 9"),
    "dies": ("crashed", "ended by signal 11 (SIGSEGV)"),
    "hangs": ("timeout", "no answer within 5 s; the worker was ended"),
    "closes": ("crashed", "it closed the channel of its answers; the worker was ended"),
}


def loaded(folder: Path, ends: str) -> tuple[WorkerProcess, Answer]:
    (folder / "engine.py").write_text(ENGINE.replace("ENDS", ENDS[ends]))
    worker = WorkerProcess(f"{folder / 'engine.py'}:Engine", "physics", 5.0)
    assert worker.start().ok
    system = {"bodies": [{"mass": 1.0, "center_of_mass": [0, 0, 0], "inertia": [[1, 0, 0]] * 3}]}
    load = {"gravity": [0, 0, 0], "pivot": None, "torque_body": [0] * 3, "torque_world": [0] * 3}
    return worker, worker.request("load", system={**system, "load": {**load, "damping": 0.0}})


def gone(process: psutil.Process) -> bool:
    end = time.monotonic() + 10.0
    while process.is_running() and process.status() != psutil.STATUS_ZOMBIE:
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


@pytest.mark.parametrize("ends", ENDS)
def test_an_orphan_in_another_session_without_marks_is_ended(
    ends: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: a search by group and by environment alone. The worker's own end is as it was."""
    monkeypatch.chdir(tmp_path)
    worker, answer = loaded(tmp_path, ends)
    outcome, reason = EXPECTED[ends]
    assert answer.outcome == outcome
    assert reason in answer.reason
    left = psutil.Process(int((tmp_path / "left").read_text())) if ends == "answers" else None
    worker.finish()
    if left is not None:
        assert gone(left)
    else:
        with pytest.raises(psutil.NoSuchProcess):
            psutil.Process(int((tmp_path / "left").read_text()))
