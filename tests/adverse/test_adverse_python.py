"""Every public function with every kind of value in the place of every argument."""

from __future__ import annotations

import datetime
import decimal
import fractions
import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import quick_scenario
from synthetic_record import build

import omegadot
from omegadot.reports.record.record import write_record
from omegadot.workers.harness_end.process import WorkerProcess

HUGE = 10**400
VALUES: dict[str, Any] = {
    **{"huge": HUGE, "negative-huge": -HUGE, "big": 10**30, "many-digits": 10**5000},
    **{"nan": float("nan"), "infinite": float("inf"), "float": 1.5, "zero": 0, "negative": -3},
    **{"text": "soon", "empty": "", "null": "a\0b", "surrogate": "caf\udce9", "digits": "9" * 5000},
    **{"long": "x" * 5000, "bytes": b"x", "bytearray": bytearray(b"abc"), "true": True},
    **{"object": object(), "class": int, "module": sys, "function": print, "complex": 1j},
    **{"list": [], "table": {}, "table-huge": {HUGE: HUGE}, "table-one": {"a": 1}, "set": {1, 2}},
    **{"of-none": [None], "nested": [[]], "of-huge": [HUGE, 0, 0], "of-texts": ["a", "b", "c"]},
    **{"of-nan": [float("nan"), 0, 1], "mixed": (1, "a", None), "range": range(3)},
    **{"array": np.array([1.0, 2.0]), "of-objects": np.array([object()], dtype=object)},
    **{"nan-of-numpy": np.float64("nan"), "whole-of-numpy": np.int64(5)},
    **{"decimal": decimal.Decimal("1e500"), "fraction": fractions.Fraction(1, 3)},
    **{"path": Path("nowhere"), "date": datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC)},
}
VERSIONS = {"engine": "mujoco", "releases": [f"1.0={sys.executable}"], "offline": True}
# What each is given besides: wrong enough, or small enough, to end at once.
BASE: dict[str, dict[str, Any]] = {
    "check": {"engine": "exact", "scenarios": "quick.toml"},
    "choose": {"scenarios": "quick.toml", "engines": "exact", "attitude": "1deg"},
    "compare": {"was": "record", "now": "record"},
    "detect": {"trace": "nowhere.csv", "scenario": "quick.toml"},
    "engines": {},
    "exact": {"scenario": "quick.toml"},
    "faults": {"engines": "nowhere"},
    "findings": {"records": "record", "folder": "findings"},
    "fit": {"trace": "nowhere.csv"},
    "read_record": {"folder": "record"},
    "report": {"run": "record", "out": "page.html"},
    "run": {"scenarios": "quick.toml", "engines": "exact"},
    "schemes": {"engines": "exact"},
    "score": {"trace": "nowhere.csv", "scenario": "quick.toml"},
    "versions": {**VERSIONS, "cache": "cache", "scenarios": "quick.toml"},
}
OURS = (omegadot.UsageError, omegadot.ScenarioError, omegadot.RecordError, omegadot.AdapterError)


class WorkerStartedError(Exception):
    """The arguments were accepted."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("python")
    quick_scenario(made)
    write_record(build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02,), 4), made / "record", "<p>")
    return made


@pytest.fixture(autouse=True)
def _inside(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    def start(_: WorkerProcess) -> None:
        raise WorkerStartedError

    monkeypatch.setattr(WorkerProcess, "start", start)
    monkeypatch.chdir(folder)
    return


def test_every_public_function_is_there() -> None:
    public = {name: getattr(omegadot, name) for name in omegadot.__all__}
    functions = {name for name, found in public.items() if inspect.isfunction(found)}
    assert functions == {*BASE, "builtin_names", "scenario"}


@pytest.mark.parametrize("name", BASE)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_whatever_is_passed_is_a_sentence_or_accepted(name: str) -> None:
    function, base, wrong = getattr(omegadot, name), BASE[name], list[str]()
    for argument in inspect.signature(function).parameters:
        # What is called to report may raise what it likes.
        for kind, value in VALUES.items() if argument not in ("progress", "ask") else ():
            try:
                function(**{**base, argument: value})
            except WorkerStartedError:
                pass
            except OURS as error:
                if not str(error).endswith("."):
                    wrong.append(f"{argument}={kind}: {error}")
            except Exception as error:
                wrong.append(f"{argument}={kind}: {type(error).__name__}: {error}")
    assert not wrong
