"""The attitudes that travel to the page are right to their codes; runs diverge when they do."""

import base64
import gzip
import io
import json
import math
import zipfile
from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from synthetic_record import build, scenario_entry

from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    quaternion_product,
)
from omegadot.reports.charts.chart_library import library_of, packed_three
from omegadot.reports.charts.deviations import chart_deviations
from omegadot.reports.charts.packing import pack_codes
from omegadot.reports.charts.palette import lines_of
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.view_3d import view
from omegadot.reports.page.view_3d.attitudes import DIVERGED, FRAMES, attitudes_of
from omegadot.reports.page.view_3d.view import view_payload

HALF = 0.5 / 32767


def payload_of(record):
    charts = {name: chart for name, chart in chart_deviations(record).items() if chart.units}
    lines = lines_of(charts.values(), record.run["engines"])
    return *view_payload(record, charts, lines), lines


def column(record, engine, integrator, timestep, names):
    rows = record.trajectories.filter(
        (pl.col("scenario") == "spun-again")
        & (pl.col("engine") == engine)
        & (pl.col("integrator") == integrator)
        & (pl.lit(True) if timestep is None else pl.col("timestep") == timestep)
    )
    return rows.select("time", *names).to_numpy()


def with_rows(record, change, **where):
    chosen = pl.all_horizontal(pl.col(name) == value for name, value in where.items())
    rows = record.trajectories.with_columns(
        pl.when(chosen).then(value).otherwise(pl.col(name)).alias(name)
        for name, value in change.items()
    )
    return replace(record, trajectories=rows)


def read_back(codes):
    """As the page's script reads them: differences, high bytes first, two's complement."""
    data = gzip.decompress(base64.b85decode(str(pack_codes(codes)).replace(",", "<")))
    high, low = np.frombuffer(data, np.uint8).reshape(2, -1).astype(np.int64)
    return np.cumsum((high << 8) | low).astype(np.uint16).view(np.int16) / 32767


def test_the_attitudes_that_travel_are_the_stored_ones(record):
    description, codes, lines = payload_of(record)
    values = read_back(codes)
    scenario = description["scenarios"][1]
    assert scenario["name"] == "spun-again"
    count, start = len(scenario["times"]), scenario["start"]
    exact = values[start : start + 4 * count].reshape(4, count).T
    omega = values[start + 4 * count : start + 7 * count].reshape(3, count).T
    assert omega * scenario["fastest"] == pytest.approx(np.tile([0, 0, 2.0], (count, 1)), abs=1e-12)
    exact = exact / np.linalg.norm(exact, axis=-1, keepdims=True)
    for line, _, knob, clock, first, n, *_ in scenario["runs"]:
        engine, integrator = lines[line].engine, lines[line].integrator
        step = float(knob.removeprefix("step ").removesuffix(" s"))
        stored = column(record, engine, integrator, step, ["qw", "qx", "qy", "qz", "wz"])
        frames = scenario["frames"][clock]
        assert np.array(scenario["times"])[frames] == pytest.approx(stored[:, 0], rel=1e-6)
        table = values[first : first + 6 * n].reshape(6, n).T
        shown = quaternion_product(exact[frames], exp_quaternion(np.pi * table[:, :3]))
        # Half a code in each of three angles, and in four parts of a unit quaternion.
        bound = math.sqrt(3) * np.pi * HALF + 2 * 2 * HALF
        assert attitude_angle(shown, stored[:, 1:5]).max() <= bound
        spins = description["spins"] * scenario["fastest"]
        assert np.abs(2.0 + table[:, 5] * spins - stored[:, 5]).max() <= 1.01 * HALF * spins


def test_a_run_diverges_at_its_first_stored_sample_beyond_a_degree(record):
    found = {
        (run.engine, run.integrator, run.timestep): run
        for run in attitudes_of(record.trajectories)["spun-again"].runs
    }
    assert len(found) == 15
    for (engine, integrator, step), run in found.items():
        names = ["qw", "qx", "qy", "qz"]
        stored = column(record, engine, integrator, step, names)
        exact = column(record, "exact", "closed-form", None, names)
        same_times = exact[np.isin(exact[:, 0], stored[:, 0])]
        angle = 2 * np.arccos(
            np.minimum(1.0, np.abs(np.sum(stored * same_times, axis=1) - stored[:, 0] ** 2))
        )
        far = stored[angle > DIVERGED, 0]
        assert run.diverges == (far[0] if len(far) else None)
        # arccos near one is good to the root of rounding.
        assert run.largest == pytest.approx(angle.max(), abs=1e-7)
    # Late by 2 * 0.3 * 0.02 t, and sampled every 0.1 s.
    assert found["dart", "semi-implicit", 0.02].diverges == pytest.approx(1.5)
    assert found["mujoco", "RK4", 0.02].diverges is None


def test_a_long_run_is_thinned_and_its_numbers_are_of_all_samples():
    record = build(engines={"dart": {"semi-implicit": 1}}, steps=(0.002,), samples=1000)
    thinned = attitudes_of(record.trajectories)["spun-again"]
    (run,) = thinned.runs
    assert len(run.frames) == FRAMES
    assert len(thinned.time) == FRAMES
    assert (thinned.time[run.frames[0]], thinned.time[run.frames[-1]]) == (0.0, 4.0)
    jolted = with_rows(
        record, {"qw": 0.0, "qz": 1.0}, scenario="spun-again", engine="dart", time=0.02
    )
    odd = column(jolted, "dart", "semi-implicit", 0.002, ["qw"])
    assert 0.02 in odd[:, 0]
    assert 0.02 not in thinned.time
    (run,) = attitudes_of(jolted.trajectories)["spun-again"].runs
    assert run.diverges == 0.02


def test_a_run_that_blew_up_ends_where_it_did(record):
    broken = record
    for time in (2.0, 3.0):
        where = {"engine": "dart", "scenario": "spun-again", "time": time}
        broken = with_rows(broken, {"qx": float("nan")}, **where)
    runs = attitudes_of(broken.trajectories)["spun-again"].runs
    ends = {run.engine: run.end for run in runs if run.timestep == 0.02}
    assert ends == {"reference": 4.0, "mujoco": 4.0, "dart": pytest.approx(1.9)}


def test_samples_without_an_exact_one_are_not_shown(record):
    moved = with_rows(record, {"time": pl.col("time") + 1e-4}, engine="dart", time=2.0)
    runs = attitudes_of(moved.trajectories)["sphere"].runs
    counts = {run.engine: len(run.frames) for run in runs if run.timestep == 0.02}
    assert counts["dart"] == counts["mujoco"] - 1


def test_the_closed_form_is_preferred_to_the_series(record):
    exact = record.trajectories.filter(pl.col("engine") == "exact")
    series = exact.with_columns(integrator=pl.lit("series"), qw=-pl.col("qz"), qz=pl.col("qw"))
    both = attitudes_of(pl.concat([series, record.trajectories]))
    assert both["sphere"].truth == "closed-form"
    assert max(run.largest for run in both["sphere"].runs) < 0.1
    alone = pl.concat([series, record.trajectories.filter(pl.col("engine") != "exact")])
    assert attitudes_of(alone)["sphere"].truth == "series"


def test_a_body_that_turns_far_between_samples_is_reported(record):
    assert not attitudes_of(record.trajectories)["sphere"].coarse
    fast = with_rows(record, {"wz": pl.lit(20.0)}, engine="exact")
    assert attitudes_of(fast.trajectories)["sphere"].coarse


def test_scenarios_without_truth_or_system_are_left_out(record):
    bare = [{**entry, "system": None} for entry in record.run["scenarios"][:1]]
    record.run["scenarios"] = bare + record.run["scenarios"][1:]
    description, _, _ = payload_of(record)
    assert [scenario["name"] for scenario in description["scenarios"]] == ["spun-again"]
    lone = record.trajectories.filter(pl.col("engine") != "exact")
    assert attitudes_of(lone) == {}


def test_a_page_without_attitudes_has_no_such_part(record):
    page = draw_page(replace(record, trajectories=record.trajectories.clear()))
    assert 'id="view"' not in page
    assert 'href="#view"' not in page


def viewer_of(page):
    kept = io.BytesIO()
    with zipfile.ZipFile(kept, "w") as archive:
        archive.writestr("viewer.html.template", page)
    return kept.getvalue()


def test_the_library_is_the_first_script_of_trimeshs_viewer_alone():
    build = 'CapsuleGeometry;Object.defineProperty(t,"__esModule",{value:!0})}));'
    packed = library_of(viewer_of(f"<html><script>{build}\nloader();</script><script>x"))
    assert gzip.decompress(base64.b85decode(str(packed).replace(",", "<"))).decode() == build
    library = gzip.decompress(base64.b85decode(str(packed_three()).replace(",", "<"))).decode()
    assert "WebGLRenderer" in library
    assert "GLTFLoader(" not in library
    assert len(packed_three()) < 250_000


@pytest.mark.parametrize(
    "archive",
    [
        b"no archive",
        viewer_of("<script>modern();</script>"),
        viewer_of('<script>old;Object.defineProperty(t,"__esModule",{value:!0})}));</script>'),
    ],
    ids=["broken", "of another kind", "too old"],
)
def test_where_trimesh_ships_no_such_library_the_page_does_without(record, monkeypatch, archive):
    assert library_of(archive) == ""
    monkeypatch.setattr(view, "packed_three", lambda: library_of(archive))
    page = draw_page(record)
    assert "The 3-D view is left out: the installed trimesh ships no three.js" in page
    assert 'id="view-data"' not in page
    assert 'href="#view"' in page


def test_the_page_names_every_scenario_and_escapes_it(record):
    hostile = "</script><b onclick=x>"
    record.run["scenarios"].insert(0, {**scenario_entry(hostile), "title": hostile})
    rows = record.trajectories
    again = rows.filter(pl.col("scenario") == "sphere").with_columns(scenario=pl.lit(hostile))
    page = draw_page(replace(record, trajectories=pl.concat([rows, again])))
    select = page.split('<select id="view-scenario">')[1].split("</select>")[0]
    assert "&lt;/script&gt;&lt;b onclick=x&gt;</option>" in select
    assert "<b" not in select
    data = page.split('id="view-data">')[1].split("</script>")[0]
    names = json.loads(gzip.decompress(base64.b85decode(str(data).replace(",", "<"))))["scenarios"]
    assert [scenario["name"] for scenario in names] == [hostile, "sphere", "spun-again"]


def test_the_same_record_gives_the_same_page(record):
    assert draw_page(record) == draw_page(build())
