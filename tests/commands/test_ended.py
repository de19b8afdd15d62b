"""What a run leaves when it is ended: its record beside an earlier one, and no process."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from command_line import PROGRAM, WRONG, quick_scenario
from synthetic_record import build

import omegadot as api
from omegadot.diagnosis.diagnose import Causes
from omegadot.reports.record.record import write_record

# Its children leave its session and its environment, one each, and one both.
SLOW = """
import subprocess
from omegadot.adapters.reference import ReferenceAdapter

class Endless(ReferenceAdapter):
    def run(self, *arguments, **more):
        subprocess.Popen(["sleep", "600"], start_new_session=True)
        subprocess.Popen(["sleep", "600"], env={})
        subprocess.Popen(["sleep", "600"], env={}, start_new_session=True)
        open("busy", "w").close()
        while True:
            pass
"""
COMMAND = [*PROGRAM, "run", "quick.toml", "--engine", "slow.py:Endless", "--out", "out"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    quick_scenario(tmp_path)
    (tmp_path / "slow.py").write_text(SLOW)
    return tmp_path


def begun(folder: Path) -> tuple[subprocess.Popen[str], list[psutil.Process]]:
    """The command, and its workers with their children, once one of them is busy."""
    running = subprocess.Popen(
        COMMAND,
        cwd=folder,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL) and None,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline:
        workers = psutil.Process(running.pid).children(recursive=True)
        busy = [w for w in workers if w.is_running() and "slow.py:Endless" in w.cmdline()]
        if busy and (folder / "busy").exists():
            return running, workers
        time.sleep(0.1)
    raise AssertionError("no worker became busy")


def gone(processes: list[psutil.Process]) -> bool:
    _, alive = psutil.wait_procs(processes, timeout=10.0)
    return not alive


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_a_signal_writes_what_there_is_beside_an_earlier_record(folder: Path, name: str) -> None:
    write_record(build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02,), 4), folder / "out", "<p>")
    before = (folder / "out" / "run.json").read_bytes()
    running, workers = begun(folder)
    number = getattr(signal, name)
    running.send_signal(number)
    try:
        printed, _ = running.communicate(timeout=60.0)
    finally:
        running.kill()
    assert running.returncode == 128 + number
    assert "The earlier record in out is kept: this run was interrupted." in printed
    assert "This run's record is in out-interrupted." in printed
    assert "Traceback" not in printed
    assert (folder / "out" / "run.json").read_bytes() == before
    run = api.read_record(folder / "out-interrupted").run
    assert (run["complete"], run["worker_deaths"]) == (False, [])
    assert gone(workers)


def test_workers_die_with_a_harness_that_is_killed(folder: Path) -> None:
    """Caught: a busy worker, which does not look at its channel, goes on for ever; its children,
    which do not die with it.
    """
    running, workers = begun(folder)
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    assert gone(workers)
    assert not (folder / "out").exists()


def test_an_interrupted_run_states_where_its_record_is(folder: Path) -> None:
    """Caught: silence where nothing stood there before, or another interrupted run."""
    for sentence in (
        "Interrupted. This run's record is in out.",
        "The record of an interrupted run in out is replaced. This run's record is in out.",
    ):
        running, _ = begun(folder)
        running.send_signal(signal.SIGINT)
        try:
            printed, _ = running.communicate(timeout=60.0)
        finally:
            running.kill()
        assert sentence in printed
        (folder / "busy").unlink()


AS_RUNS_ARE_PLANNED = """
from omegadot.commands.run import run

def interrupted(*arguments):
    raise KeyboardInterrupt

run.execute = interrupted
from omegadot.commands.cli import main
main()
"""


@pytest.mark.parametrize("earlier", [False, True])
def test_where_nothing_is_written_that_is_stated(folder: Path, earlier: bool) -> None:
    """Caught: "interrupted." alone, after which nobody knows what became of the earlier record."""
    if earlier:
        write_record(build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02,), 4), folder / "out", "<p>")
    command = [sys.executable, "-c", AS_RUNS_ARE_PLANNED, "run", "quick.toml", "--out", "out"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    kept = " The earlier record in out is kept." if earlier else ""
    assert done.returncode == 130
    assert done.stderr.split("\n")[0] == f"Interrupted: no record of this run was written.{kept}"
    assert (folder / "out").exists() is earlier


def test_an_interruption_as_causes_are_sought_leaves_them_out(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: a run of an hour that is lost as its failures are explained."""

    def interrupted(*arguments: object) -> object:
        raise KeyboardInterrupt

    monkeypatch.setattr(Causes, "add", interrupted)
    with pytest.raises(api.RunInterrupted) as caught:
        api.run(folder / "quick.toml", f"{WRONG}:NoGyroscopic", out=folder / "out")
    result = caught.value.result
    assert result.folder == folder / "out"
    assert result.note == f"Interrupted. This run's record is in {folder / 'out'}."
    assert {task.failed for task in result.failures} == {True}
    stored = api.read_record(folder / "out")
    assert stored.run["complete"] is False
    assert not any(task.cause for task in stored.tasks)


def test_an_interruption_waits_until_a_record_is_written(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: a page half drawn, or a record that is there and is said to be none."""
    draw = api.RunRecord.page

    def drawn(record: api.RunRecord) -> str:
        os.kill(os.getpid(), signal.SIGINT)
        return draw(record)

    monkeypatch.setattr(api.RunRecord, "page", drawn)
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(api.RunInterrupted) as caught:
        api.run(folder / "quick.toml", "reference:lie-rk4", out=folder / "out")
    assert caught.value.result.passed
    assert api.read_record(folder / "out").run["complete"]
    assert signal.getsignal(signal.SIGINT) is before


INTERRUPTED_IN_IMPORT = """
import os
import sys

class Interrupts:
    def find_spec(self, name, path, target=None):
        if name == "omegadot.commands.cli":
            os.kill(os.getpid(), int(sys.argv[1]))

sys.meta_path.insert(0, Interrupts())
from omegadot.__main__ import main
main()
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_an_interruption_while_it_is_loaded_is_one_line(name: str) -> None:
    """Caught: handlers that the command line sets when it has been imported itself."""
    number = int(getattr(signal, name))
    command = [sys.executable, "-c", INTERRUPTED_IN_IMPORT, str(number)]
    done = subprocess.run(
        command,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL) and None,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (128 + number, "omegadot: interrupted.\n")
