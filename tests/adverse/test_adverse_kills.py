"""A record is there and whole at every moment: its writer is killed 200 times, at any of them."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from synthetic_record import build

from omegadot.reports.record import record
from omegadot.reports.record.record import check_folder, read_record, write_record

pytestmark = pytest.mark.no_cover

KILLS = 200
# Imports once, and starts a writer for each line that it reads: a start in full takes a second.
WRITERS = """
import os, sys
from pathlib import Path
import numpy.ma, pyarrow.compute, pyarrow.parquet
sys.path.insert(0, sys.argv[1])
from synthetic_record import build
from omegadot.reports.record import record, run_model
record.SECONDS_TO_WRITE = 0.0
for _ in sys.stdin:
    writer = os.fork()
    if writer == 0:
        made = build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02,), 4)
        print(os.getpid(), flush=True)
        while True:
            record.write_record(made, Path(sys.argv[2]), "<p>" * 100_000)
    os.waitpid(writer, 0)
    print("ended", flush=True)
"""


def test_two_hundred_kills_lose_no_record(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(record, "SECONDS_TO_WRITE", 0.0)  # of another machine's disk
    folder, draw = tmp_path / "run", random.Random(5)
    write_record(build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02,), 4), folder, "<p>")
    synthetic = str(Path(__file__).parent.parent / "reports")
    kept = {key: value for key, value in os.environ.items() if not key.startswith("COV")}
    with subprocess.Popen(
        [sys.executable, "-c", WRITERS, synthetic, str(folder)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=kept,
    ) as writers:
        assert writers.stdin
        assert writers.stdout
        written = 0
        for _ in range(KILLS):
            before = folder.stat().st_ino
            print("go", file=writers.stdin, flush=True)
            number = int(writers.stdout.readline())
            time.sleep(draw.uniform(0.0, 0.1))
            os.kill(number, signal.SIGKILL)
            assert writers.stdout.readline() == "ended\n"
            read_record(folder)
            check_folder(folder)  # as the next run does first
            read_record(folder)
            written += folder.stat().st_ino != before
        writers.stdin.close()
    assert written > KILLS // 10  # many were killed as they replaced a record
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["run"]
