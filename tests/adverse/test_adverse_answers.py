"""Whatever an engine answers or declares, the record is written, and a cause is what is seen."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from command_line import ENGINES, Result, omegadot, quick_scenario

import omegadot as api

pytestmark = pytest.mark.no_cover

FIRST = "semi-implicit-euler"
# The outcome of the first scheme's run, and what its reason or its cause begins with.
ANSWERS = {
    "TimesAreNotNumbers": ("ok", "times are reported that are not finite"),
    "TimesAreInfinite": ("ok", "times are reported that are not finite"),
    "TimesAreHuge": ("ok", "every time is reported 1e308 s late"),
    "TimesBeginEarly": ("ok", "every time is reported 0.001 s early, "),
    "StartAlone": ("ok", "the last 20 samples are missing"),
    "CoarseClock": ("ok", ""),
    "InfinitePosition": ("diverged", "position: not finite from t = 0 s"),
    "HugeQuaternion": ("ok", "the run does not begin at the state it is given"),
    "TinyQuaternion": ("ok", "the run does not begin at the state it is given"),
    "HugeOmega": ("ok", "in the run, omega is scaled by 1e300"),
    "Noise": ("ok", "the same steps, requested again, give other samples"),
    "Forges": ("crashed", "what it answers is no answer: it is of type list"),
    "OrderTrue": ("raised", "the order of semi-implicit-euler in omega is True; give a whole"),
    "OrderOfManyDigits": ("raised", "the order of semi-implicit-euler in omega is of many digits"),
}
TIMES = [name for name in ANSWERS if name.startswith("Times")]
Ran = tuple[Result, Any, Path]


def adapter(name: str) -> tuple[str, str]:
    return "--adapter", f"{ENGINES / 'adverse.py'}:{name}"


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Ran:
    folder = tmp_path_factory.mktemp("answers")
    scenario = quick_scenario(folder)
    adapters = [part for name in ANSWERS for part in adapter(name)]
    steps = ("--timestep", 0.05, "--timestep", 0.025)
    arguments = ("run", scenario, "--engine", "reference:rk4-quaternion", *steps, *adapters)
    result = omegadot(*arguments, "--out", "out", folder=folder)
    return result, api.read_record(folder / "out"), folder / "out"


def test_the_record_is_written_and_read_again(ran: Ran) -> None:
    """Caught: a field or a column that no record may hold, met when every engine has answered."""
    result, record, folder = ran
    assert (result.code, result.err) == (3, "")
    assert (folder / "report.html").stat().st_size > 50_000
    engines = {task["engine"] for task in record.run["tasks"]}
    assert {name.lower() for name in ANSWERS} < engines
    assert record.trajectories["time"].is_finite().all()
    assert record.trajectories["time"].min() == 0.0


@pytest.mark.parametrize("name", ANSWERS)
def test_a_run_states_what_is_seen_of_it(name: str, ran: Ran) -> None:
    """Caught: a state left over where none is, omega in place of position, steps that rest."""
    tasks = [task for task in ran[1].run["tasks"] if task["engine"] == name.lower()]
    first = [task for task in tasks if task["integrator"] in (FIRST, "")]
    outcome, text = ANSWERS[name]
    assert {task["outcome"] for task in first} == {outcome}
    found = {task["reason"] or task.get("cause", "") for task in first}
    found |= {task.get("cause", "") for task in first} if outcome == "diverged" else set()
    assert any(one.startswith(text) for one in found), found
    assert not any("sound from where" in one for one in found), found
    assert not any("begin at other states" in one for one in found), found
    assert not any("do not move" in one for one in found), found
    fails = any("fail" in task["gates"].values() for task in first)
    assert fails == (outcome in ("ok", "diverged") and name != "CoarseClock")


def test_a_row_names_the_quantity_that_is_not_finite(ran: Ran) -> None:
    rows = ran[1].metrics.filter(engine="infiniteposition", metric="error_max", integrator=FIRST)
    assert set(rows["channel"]) == {"position"}
    assert set(rows["unit"]) == {"m"}


@pytest.mark.parametrize("names", [TIMES, ["CoarseClock"]], ids=["times", "clock"])
def test_choose_ranks_no_run_without_times_and_divides_by_no_pace(
    names: list[str], tmp_path: Path
) -> None:
    """Caught: an engine that `run` and `check` fail, ranked; ZeroDivisionError of its speed."""
    adapters = [part for name in names for part in adapter(f"{name}")]
    scenario = quick_scenario(tmp_path)
    arguments = ("choose", scenario, "--engine", "reference:rk4-quaternion", *adapters)
    result = omegadot(*arguments, "--attitude", "1deg", "--format", "json", folder=tmp_path)
    assert result.err == ""
    (case,) = result.json["scenarios"]
    rows = {(row["engine"], row["integrator"]): row for row in case["candidates"]}
    for name in names:
        row = rows[name.lower(), FIRST]
        assert row["status"] == ("qualifies" if name == "CoarseClock" else "raised")
        if name != "CoarseClock":
            assert "run() reports other times than requested" in row["reason"]
