"""A run in both setups: what the record holds of each, and which setting mends most."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from command_line import ENGINES, omegadot, quick_scenario

import omegadot as api
from omegadot.commands.run.both import run_as_shipped
from omegadot.commands.run.result import RunResult
from omegadot.harness.outcome import Outcome, RunRequest

SHIPPED = ENGINES / "shipped.py"
BOTH = [f"{SHIPPED}:BrakedAdapter", f"{SHIPPED}:PlainAdapter"]


@pytest.fixture(scope="module")
def handle(tmp_path_factory: pytest.TempPathFactory) -> RunResult:
    """The T-handle at one step, its record written."""
    out = tmp_path_factory.mktemp("both") / "run"
    return api.run("t-handle", [*BOTH, "exact"], timesteps=0.005, setup="both", out=out)


def test_one_setting_mends_an_engine_that_never_flips(handle: RunResult) -> None:
    rows = {row.engine: row for row in handle.record.as_shipped}
    braked, plain = rows["braked"], rows["plain"]
    assert braked.flipping(braked.physics) == "yes"
    assert braked.flipping(braked.as_shipped) == "never"
    assert set(braked.settings) == {"gyroscopic", "damping", "sleeping"}
    name, ratio = braked.mends_most or ("", 1.0)
    assert name == "gyroscopic"
    assert ratio < 1.0
    assert braked.flipping(braked.settings["gyroscopic"]) in ("yes", "late", "early")
    assert braked.settings["sleeping"] == braked.as_shipped
    # 0.05 of omega a second, as h goes to 0: 1 - exp(-0.1 * 8) of its energy
    lost = braked.as_shipped.energy_lost
    assert lost is not None
    assert abs(lost - 0.5507) < 1e-3
    assert plain.mends_most is None
    assert plain.physics == plain.as_shipped


def test_the_record_has_each_task_in_both_setups_and_the_truth_once(handle: RunResult) -> None:
    record = handle.record
    found = {(t.engine, t.setup) for t in record.tasks}
    assert found == {
        ("exact", "physics"),
        *((engine, setup) for engine in ("braked", "plain") for setup in ("physics", "as-shipped")),
    }
    for frame in (record.metrics, record.trajectories):
        own = set(frame.filter(engine="exact")["setup"])
        assert own == {"physics"}
        assert set(frame.filter(engine="braked")["setup"]) == {"physics", "as-shipped"}
    assert len(record.run["single_settings"]) == 3
    assert not [t for t in record.tasks if t.failed and t.setup == "physics"]
    assert [t for t in record.tasks if t.failed and t.setup == "as-shipped"]


def test_it_is_read_again_and_shown_everywhere(handle: RunResult) -> None:
    assert handle.folder is not None
    stored = api.read_record(handle.folder)
    assert stored.as_shipped == handle.record.as_shipped
    page = (handle.folder / "report.html").read_text(encoding="utf-8")
    assert page.index('id="shipped"') < page.index('id="verdicts"')
    assert "gyroscopic: error × 0." in page
    message = stored.markdown()
    assert "**As shipped**" in message
    assert "| braked | step | never flips | flips in time: 1.3" in message
    assert "| fail | braked as-shipped | step |" in message
    assert stored.headline.startswith("1 of 2 engines fails: braked as-shipped, on t-handle.")


def test_without_the_t_handle_there_is_no_column_of_flips(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    how = ("--setup", "both", "--timestep", "0.01", "--out", tmp_path / "out")
    done = omegadot("run", quick, "--engine", BOTH[0], *how, folder=tmp_path)
    assert done.code == 1, done.err
    assert "As shipped, on quick. What mends most: braked gyroscopic" in " ".join(done.out.split())
    message = api.read_record(tmp_path / "out").markdown()
    assert "flips" not in message


def test_a_run_in_one_setup_has_no_such_table(tmp_path: Path) -> None:
    found = api.run(quick_scenario(tmp_path), BOTH[1], timesteps=0.01, setup="as-shipped")
    assert found.record.as_shipped == ()
    assert "As shipped" not in found.record.markdown()


def test_an_interrupted_first_half_has_no_second() -> None:
    def execute(request: Any, report: Any) -> Outcome:
        raise AssertionError("it is not to be run")

    for first in (Outcome([], [], [], True, []), Outcome([], [], [], False, [])):
        assert run_as_shipped(first, RunRequest([], []), execute, print) is None


@pytest.mark.parametrize("setup", ["bothh", "as-shipped+damping"])
def test_another_setup_is_refused(setup: Any) -> None:
    with pytest.raises(api.UsageError, match=r"no such setup; (write|choose) "):
        api.run("sphere", "mujoco", setup=setup)
