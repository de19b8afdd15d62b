"""Commands as processes of their own: closed streams, other locales, full and read-only disks."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import psutil
import pytest
from command_line import PROGRAM, quick_scenario
from synthetic_record import build

from omegadot.reports.record.record import read_record, write_record

pytestmark = pytest.mark.no_cover

TRACE = "t,wx,wy,wz\n" + "".join(f"{0.02 * n},{0.3},{2.0 + 0.001 * n},0.1\n" for n in range(20))
READERS = {
    "scenarios": ("scenarios",),
    "report": ("report", "record", "--markdown"),
    "compare": ("compare", "record", "record"),
    "refusal": ("run", "caf\u00e9\u03c9"),
    "run": ("run", "quick.toml", "--engine", "exact", "--out", "out"),
}
WRITERS = {
    "run": READERS["run"],
    "report": ("report", "record", "--out", "new.html", "--figures", "figures"),
    "score": ("score", "trace.csv", "--scenario", "quick.toml", "--out", "scored"),
    "fit": ("fit", "trace.csv", "--out", "fitted.toml"),
    "check": ("check", "exact", "--scenario", "quick.toml", "--baseline", "b", "--update-baseline"),
    "choose": ("choose", "quick.toml", "--engine", "exact", "--attitude", "1deg", "--out", "out"),
}


@dataclass(frozen=True)
class Condition:
    """What is adverse: in the environment, in the process, or in the shell that starts it."""

    environment: Mapping[str, str] = field(default_factory=dict)
    prepare: Callable[[], object] | None = None
    shell: str = '"$@"'


def limited(which: int, most: int) -> Callable[[], object]:
    return lambda: resource.setrlimit(which, (most, most))


STREAMS = {
    "no-input": Condition(shell='"$@" <&-'),
    "no-output": Condition(shell='"$@" >&-'),
    "no-errors": Condition(shell='"$@" 2>&-'),
    "no-stream": Condition(shell='"$@" <&- >&- 2>&-'),
    "output-full": Condition(shell='"$@" >/dev/full'),
    "errors-full": Condition(shell='"$@" 2>/dev/full'),
    "reader-leaves": Condition(shell='"$@" | true; exit "${PIPESTATUS[0]}"'),
    "ascii": Condition({"LC_ALL": "C", "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}),
    "latin-1": Condition({"LC_ALL": "C", "PYTHONIOENCODING": "latin-1", "PYTHONUTF8": "0"}),
    "turkish": Condition({"LC_ALL": "tr_TR.UTF-8", "LANG": "tr_TR.UTF-8"}),
    "no-home": Condition({"HOME": "/nowhere", "XDG_CACHE_HOME": "/nowhere"}),
    "narrow": Condition({"TERM": "dumb", "COLUMNS": "1"}),
}
DISKS = {
    "no-large-file": Condition(prepare=limited(resource.RLIMIT_FSIZE, 2000)),
    "few-files": Condition(prepare=limited(resource.RLIMIT_NOFILE, 24)),
    "no-temporary-folder": Condition({"TMPDIR": "/nowhere"}),
}
# In a mount namespace of their own; where the machine allows none, they are left out below.
IN_NAMESPACE = ["unshare", "-rm", "sh", "-c"]
CAN_MOUNT = not subprocess.run([*IN_NAMESPACE, "mount -t tmpfs own /mnt"], check=False).returncode
MOUNTED = """exec unshare -rm sh -c 'cp -r . "$0" && {mount} && cd "$PWD" || exit 99; "$@"' \
    "$ASIDE" "$@" """
SMALL = 'mount -t tmpfs -o size=40k small . && cd "$PWD" && cp "$0"/*.toml "$0"/trace.csv .'
READ_ONLY = "mount --bind . . && mount -o remount,bind,ro ."
if CAN_MOUNT:
    DISKS["small-disk"] = Condition(shell=MOUNTED.format(mount=SMALL))
    DISKS["read-only-disk"] = Condition(shell=MOUNTED.format(mount=READ_ONLY))
CASES = [
    pytest.param(condition, arguments, id=f"{name}-{command}")
    for conditions, commands in ((STREAMS, READERS), (DISKS, WRITERS))
    for name, condition in conditions.items()
    for command, arguments in commands.items()
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "here"
    made.mkdir()
    text = quick_scenario(made).read_text().replace("duration = 1.0", "duration = 0.2")
    (made / "quick.toml").write_text(text.replace("0.02, 0.01, 0.005", "0.02, 0.01"))
    (made / "trace.csv").write_text(TRACE)
    write_record(build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02,), 4), made / "record", "<p>")
    return made


@pytest.mark.parametrize(("condition", "arguments"), CASES)
def test_a_condition_ends_no_command_in_a_traceback(
    condition: Condition, arguments: tuple[str, ...], folder: Path, tmp_path: Path
) -> None:
    kept = {key: value for key, value in os.environ.items() if not key.startswith("COV")}
    (tmp_path / "aside").mkdir()
    done = subprocess.run(
        ["bash", "-c", condition.shell, "sh", *PROGRAM, *arguments],
        cwd=folder,
        env={**kept, "ASIDE": str(tmp_path / "aside"), **condition.environment},
        preexec_fn=condition.prepare,
        capture_output=True,
        timeout=120,
        check=False,
    )
    printed = (done.stdout + done.stderr).decode(errors="replace")
    assert done.returncode in (0, 1, 2, 3, 128 + signal.SIGPIPE), printed
    if "No space left" in printed:  # the system's fault, not the arguments'
        assert done.returncode == 3, printed
    assert "Traceback" not in printed
    assert "Exception ignored" not in printed
    assert not [name for name in os.listdir(folder) if name.startswith(".")], "left half-written"
    read_record(folder / "record")
    assert _ended(folder)


def _ended(folder: Path) -> bool:
    """No process still works in the folder."""
    own = os.getpid()
    left = [
        p
        for p in psutil.process_iter(["cwd", "pid"])
        if p.info["pid"] != own and p.info["cwd"] and Path(p.info["cwd"]) == folder
    ]
    return not psutil.wait_procs(left, timeout=10.0)[1]
