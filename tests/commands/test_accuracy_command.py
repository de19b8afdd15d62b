"""Error-controlled integrators in ``run``, ``check`` and ``choose``, through workers."""

from __future__ import annotations

from pathlib import Path

import polars as pl
import pytest
from command_line import Result, omegadot, quick_scenario

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "adaptive_engine.py"
ENGINE = f"{EXAMPLE}:AdaptiveAdapter"


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    folder = tmp_path_factory.mktemp("accuracy")
    knobs = ["--accuracy", "1e-3", "--accuracy", "1e-11", "--timestep", "0.02"]
    arguments = [quick_scenario(folder), "--adapter", ENGINE, "--engine", "reference:lie-rk4"]
    return folder, omegadot("run", *arguments, *knobs, "--format", "json", folder=folder)


def test_a_record_holds_accuracies_in_place_of_steps(ran: tuple[Path, Result]) -> None:
    folder, result = ran
    assert result.code == 0, result.err
    runs = {(t["engine"], t["timestep"], t["accuracy"]) for t in result.json["tasks"]}
    adaptive = {("adaptive", None, 1e-3), ("adaptive", None, 1e-11)}
    assert runs == {*adaptive, ("reference", 0.02, None)}
    assert {t["outcome"] for t in result.json["tasks"]} == {"ok"}
    kept = pl.read_parquet(folder / "omegadot-run" / "trajectories.parquet")
    own = kept.filter(pl.col("engine") == "adaptive")
    assert set(own["accuracy"]) == {1e-3, 1e-11}
    assert own["timestep"].null_count() == len(own)
    errors = pl.read_parquet(folder / "omegadot-run" / "metrics.parquet").filter(
        engine="adaptive", metric="error_max", channel="attitude"
    )
    coarse, fine = errors.sort("accuracy", descending=True)["value"]
    assert fine < coarse / 10  # it came to the engine


def test_its_page_is_drawn(ran: tuple[Path, Result]) -> None:
    page = (ran[0] / "omegadot-run" / "report.html").read_text(encoding="utf-8")
    assert "accuracy 1e-11" in page


@pytest.mark.parametrize("value", ["0", "-1e-3", "1", "nan", "inf"])
def test_what_is_no_accuracy_is_refused(value: str, tmp_path: Path) -> None:
    result = omegadot("run", "sphere", "--accuracy", value, "--engine", "exact", folder=tmp_path)
    assert result.code == 2
    assert "give one from 0 to 1" in result.err


def test_checks_are_named_by_their_accuracy(tmp_path: Path) -> None:
    scenario = quick_scenario(tmp_path)
    arguments = (ENGINE, "--scenario", scenario, "--baseline", "b", "--format", "json")
    written = omegadot("check", *arguments, "--update-baseline", folder=tmp_path)
    assert written.code == 0, written.out
    ids = [check["id"] for check in written.json["checks"]]
    assert "adaptive-dop853-quick-accuracy-1e-09-trajectory" in ids
    again = omegadot("check", *arguments, folder=tmp_path)
    assert again.code == 0, again.out
    ids = {check["id"]: check["verdict"] for check in again.json["checks"]}
    assert ids["adaptive-dop853-quick-accuracy-1e-09-baseline"] == "pass"


def test_a_choice_is_of_the_coarsest_accuracy(tmp_path: Path) -> None:
    limits = ["--attitude", "1e-9rad", "--adapter", ENGINE, "--engine", "reference:lie-rk4"]
    arguments = [quick_scenario(tmp_path), *limits, "--budget", "0.2", "--format", "json"]
    result = omegadot("choose", *arguments, folder=tmp_path)
    assert result.code == 0, result.err
    (case,) = result.json["scenarios"]
    row = next(r for r in case["candidates"] if r["engine"] == "adaptive")
    assert row["status"] == "qualifies"
    found, larger = row["found"], row["larger"]
    assert found["timestep"] is None
    assert 1e-13 <= found["accuracy"] < larger["accuracy"]
    assert found["errors"]["attitude"]["value"] <= 1e-9 < larger["errors"]["attitude"]["value"]
