"""No command line ends in a traceback, hangs, or leaves its contract, whatever is typed."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from adverse_cases import AdverseCase, adverse_cases
from adverse_values import adverse_files
from command_line import quick_scenario
from synthetic_record import build

from omegadot.commands.cli import main
from omegadot.reports.record.record import write_record

pytestmark = pytest.mark.no_cover
SECONDS = 60
ALL = adverse_cases()
# Every third one, or all of them: they take some three minutes.
CASES = ALL if os.environ.get("OMEGADOT_ADVERSE") == "all" else ALL[::3]
TRACE = "t,wx,wy,wz\n" + "".join(f"{0.02 * n},{0.3},{2.0 + 0.001 * n},0.1\n" for n in range(20))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("adverse")
    quick_scenario(made)
    adverse_files(made)
    (made / "trace.csv").write_text(TRACE)
    write_record(build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02,), 4), made / "record", "<p>")
    return made


@pytest.fixture(autouse=True)
def _inside(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(folder)

    def late(*_: Any) -> None:
        raise TimeoutError(f"no end within {SECONDS} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def ended(arguments: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> tuple[int, str, str]:
    """The exit code and what was printed; a traceback is whatever else is raised."""
    out, err = io.StringIO(), io.StringIO()
    monkeypatch.setattr(sys, "argv", ["omegadot", *arguments])
    code: Any = None
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            code = end.code
    return int(code or 0), out.getvalue(), err.getvalue()


def test_there_are_cases_for_every_command() -> None:
    assert len(CASES) >= 600
    assert len({case.name for case in ALL}) == len(ALL)
    assert {case.arguments[0] for case in CASES} == {case.arguments[0] for case in ALL}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_it_ends_within_its_contract(case: AdverseCase, monkeypatch: pytest.MonkeyPatch) -> None:
    before = set(os.listdir())
    code, out, err = ended(case.arguments, monkeypatch)
    assert code in ((2,) if case.wrong else (0, 1, 2, 3)), (code, err)
    assert "Traceback" not in out + err
    assert "\x1b" not in out + err
    if code == 2:
        (line,) = err.splitlines()
        assert line.startswith("omegadot: ")
        assert line.endswith(".")
        assert len(line) < 1200
        assert set(os.listdir()) == before
