"""``omegadot compare``: what a user gets of two stored runs, and how the command ends."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import polars as pl
import pytest
from command_line import omegadot, quick_scenario

from omegadot.commands.check.baseline import OF_A_RUN, OF_A_SCENARIO
from omegadot.commands.compare.compare import compare
from omegadot.commands.report.command import printed
from omegadot.harness.usage import UsageError
from omegadot.reports.record.record import METRICS, read_record
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.record.schema import RecordError
from omegadot.reports.two_runs.figures import changed_figures, paired
from omegadot.reports.two_runs.sides import Side
from omegadot.reports.two_runs.text import as_json, as_markdown

# One engine, as it is and as it comes on another machine or in another version.
ENGINE = '''
from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Description
from omegadot.adapters.reference.adapter import ReferenceAdapter

SCHEMES = ("semi-implicit-euler", "lie-rk4")


class FlyAdapter(ReferenceAdapter):
    """A sound engine whose last digit and last step are settled by two numbers."""

    @property
    def description(self):
        whole = super().description
        kept = tuple(i for i in whole.integrators if i.name in SCHEMES)
        return Description("fly", "{version}", kept, features=whole.features)

    def forward_dynamics(self, states):
        found = super().forward_dynamics(states)
        noise = np.random.default_rng({machine}).uniform(-1.0, 1.0, found.angular.shape)
        return replace(found, angular=found.angular * (1.0 + 2.0**-52 * noise))

    def run(self, initial, integrator, timestep, steps, every):
        found = super().run(initial, integrator, timestep * {late}, steps, every)
        noise = np.random.default_rng({machine}).uniform(-1.0, 1.0, found.state.position.shape)
        omega = found.state.angular_velocity * (1.0 + 2.0**-52 * noise)
        if {crash}:
            raise RuntimeError("the solver gave up")
        state = replace(found.state, angular_velocity=omega)
        return replace(found, state=state, time=found.time / {late})
'''
AS_IT_IS = {"version": "1.0", "machine": 1, "late": 1.0, "crash": False}


@pytest.fixture(scope="module")
def run_of(tmp_path_factory):
    """The folder of a run of the engine with some of its numbers changed."""
    made: dict[tuple[object, ...], Path] = {}

    def run(*arguments: object, **changed: object) -> Path:
        key = (*arguments, *sorted(changed.items()))
        if key not in made:
            folder = tmp_path_factory.mktemp("run")
            text = ENGINE
            for name, value in {**AS_IT_IS, **changed}.items():
                text = text.replace("{" + name + "}", str(value))
            (folder / "fly.py").write_text(text, encoding="utf-8")
            scenario = quick_scenario(folder)
            line = (scenario, "--engine", "fly", "--adapter", "fly.py:FlyAdapter", *arguments)
            done = omegadot("run", *line, "--out", "out", folder=folder)
            assert (folder / "out" / "run.json").exists(), done.err
            made[key] = folder / "out"
        return made[key]

    return run


def compared(was: Path, now: Path) -> Any:
    """What the command prints for machines, and that the comparison has the same verdict."""
    comparison = compare(was, now)
    found = json.loads(dump_json(as_json(comparison)))
    assert comparison.regressed == found["regressed"]
    return found


def test_two_machines_and_seeds_have_no_change(run_of, tmp_path: Path) -> None:
    result = omegadot("compare", run_of(), run_of("--seed", 3, machine=2), folder=tmp_path)
    assert result.code == 0, result.out
    assert result.out.splitlines()[-1].startswith("No change.")
    assert "seed:  0 → 3" in result.out


def test_a_step_that_is_wrong_is_a_regression(run_of, tmp_path: Path) -> None:
    broken = run_of(version="2.0", late=1.001)
    found = compared(run_of(), broken)
    turned = {(c["gate"], c["was"], c["now"]) for c in found["worse"]}
    assert ("trajectory", "pass", "fail") in turned
    assert {d["what"] for d in found["settings"]} == {"fly version"}
    text = omegadot("compare", run_of(), broken, folder=tmp_path)
    assert text.code == 1
    assert "fly version:  1.0 → 2.0" in text.out
    assert text.out.splitlines()[-1].startswith("Worse: fly ")


def test_a_step_that_is_fixed_is_no_regression(run_of) -> None:
    """The scheme of first order may lose by it: two errors that made up for each other."""
    found = compared(run_of(version="2.0", late=1.001), run_of())
    assert all((c["was"], c["now"]) != ("pass", "fail") for c in found["worse"])
    assert not [c for c in found["worse"] if c["integrator"] == "lie-rk4"]
    assert {(c["was"], c["now"]) for c in found["better"]} >= {("fail", "pass")}


def test_an_engine_that_raises_where_it_ran_is_a_regression(run_of) -> None:
    found = compared(run_of(), run_of(crash=True))
    assert {(c["was"], c["now"]) for c in found["worse"]} == {("ok", "raised")}
    assert len(found["worse"]) == 6
    assert "the solver gave up" in found["worse"][0]["why"]
    fixed = compare(run_of(crash=True), run_of())
    assert as_markdown(fixed).startswith("### Better: fly ")
    assert not fixed.regressed


def test_bands_are_those_of_the_baselines(run_of) -> None:
    """2 R for two runs of one machine: a figure that stays there is in both or in neither."""
    record = read_record(run_of())
    pairs = paired(Side("A", record), Side("B", record), set())
    known = pl.col("gate").is_in(sorted(OF_A_SCENARIO)) | pl.col("metric").is_in(sorted(OF_A_RUN))
    held = pairs.filter(known & pl.col("bound").is_not_null())
    assert held.height > 20
    for times, expected in ((1.999, 0), (2.001, held.filter(pl.col("bound") > 0.0).height)):
        moved = held.with_columns(value_now=pl.col("value") + times * pl.col("bound"))
        found = list(changed_figures(moved, same_seed=True, redefined=set()))
        assert len(found) == expected


def test_two_runs_stand_side_by_side_on_a_page(run_of, tmp_path: Path) -> None:
    was, now = run_of(), run_of(version="2.0", late=1.001)
    result = omegadot("report", was, now, folder=tmp_path)
    assert (result.code, result.out.strip()) == (0, "two-runs.html")
    text = (tmp_path / "two-runs.html").read_text(encoding="utf-8")
    assert "✓ pass → ✗ fail" in text
    assert "1.0 → 2.0" in text
    assert printed([was, now], tmp_path / "page.html", None, markdown=False)
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == text


def test_one_run_as_figures_and_as_a_comment(run_of, tmp_path: Path) -> None:
    folder = run_of()
    before = (folder / "report.html").read_bytes()
    drawn = omegadot("report", folder, "--figures", "figures", folder=tmp_path)
    assert drawn.code == 0, drawn.err
    names = {path.name for path in (tmp_path / "figures").iterdir()}
    assert {"quick-attitude.svg", "quick-attitude.png", "quick-work-precision.svg"} <= names
    assert {Path(line).name for line in drawn.out.splitlines()} == names
    message = printed([folder], None, None, markdown=True)
    assert message.startswith("### omegadot: fly agrees")
    assert (folder / "report.html").read_bytes() == before


def _damaged(folder: Path, whole: Path) -> dict[Path, str]:
    """Folders that are no run, each with what must be reported of it."""
    cut, other = folder / "cut", folder / "other"
    for copy in (cut, other):
        shutil.copytree(whole, copy)
    data = (cut / METRICS).read_bytes()
    (cut / METRICS).write_bytes(data[: len(data) // 2])
    text = (other / "run.json").read_text().replace('"schema": 1', '"schema": 2', 1)
    (other / "run.json").write_text(text)
    return {
        folder / "nowhere": "no such folder",
        folder: "missing",
        cut: "not a readable Parquet file",
        other: "schema is 2",
    }


def test_a_folder_that_is_no_run_is_one_sentence(run_of, tmp_path: Path) -> None:
    for folder, message in _damaged(tmp_path, run_of()).items():
        for was, now in ((run_of(), folder), (folder, run_of())):
            with pytest.raises(RecordError, match=message) as caught:
                compare(was, now)
            assert "\n" not in str(caught.value)
            with pytest.raises(RecordError, match=message):
                printed([was, now], tmp_path / "page.html", None, markdown=False)
    result = omegadot("compare", run_of(), tmp_path / "cut", folder=tmp_path)
    assert (result.code, result.out) == (2, "")
    assert result.err.count("\n") == 1
    assert not (tmp_path / "page.html").exists()


@pytest.mark.parametrize(
    ("folders", "options", "message"),
    [
        (3, (None, None, False), "3 runs are given"),
        (2, (None, Path("x"), False), "--figures draws one run"),
        (1, (Path("x"), None, True), "leave out --out"),
    ],
)
def test_wrong_usage_is_one_sentence(folders, options, message) -> None:
    with pytest.raises(UsageError, match=message) as caught:
        printed([Path("nowhere")] * folders, *options)
    assert "\n" not in str(caught.value)


def test_a_run_that_is_left_out_is_wrong_usage(tmp_path: Path) -> None:
    result = omegadot("compare", "a", folder=tmp_path)
    assert result.code == 2
    assert result.err.startswith("omegadot: Missing argument")
