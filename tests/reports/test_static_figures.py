"""Pictures for papers: what they show is the record's, and a record gives the same bytes."""

from __future__ import annotations

import hashlib
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import matplotlib as mpl
import numpy as np
import polars as pl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.colors import to_hex
from synthetic_record import build, metric, with_metrics

from omegadot.reports.charts.bounds import Limits
from omegadot.reports.charts.palette import colours
from omegadot.reports.charts.static.charts import charts_of
from omegadot.reports.charts.static.deviations import draw, shown
from omegadot.reports.charts.static.legend import Entry, blocks_of
from omegadot.reports.charts.static.style import RC, SOFT
from omegadot.reports.charts.static.sweeps import draw_convergence, draw_work_precision
from omegadot.reports.charts.static.write import file_stems, write_figures
from omegadot.reports.record.schema import RecordError

CHARTS = {
    "omega-dot",
    "energy",
    "angular-momentum",
    "attitude",
    "convergence",
    "work-precision",
}
HOSTILE = ("../../etc/passwd", "$\\frac{", "con", "</svg><script>", "a\nb\x00", "ΑΒΓ", "漢字")


@pytest.fixture(scope="module")
def record():
    made = build(scenarios=("sphere",), samples=20)
    floor = {"unit": "rad", "bound": None, "verdict": "info"}
    key = ("sphere", "exact", "closed-form", None, "trajectory", "attitude", "resolvable_floor")
    return with_metrics(made, metric(*key, 3e-9, **floor))


@pytest.fixture(scope="module")
def charts(record):
    return charts_of(record)[0]


@pytest.fixture(autouse=True)
def _style():
    with mpl.rc_context(RC):
        yield


def lines_of(figure):
    return [line for line in figure.axes[0].get_lines() if len(line.get_xdata())]


def texts_of(figure):
    found = [text.get_text() for text in figure.texts]
    for legend in figure.legends:
        found += [text.get_text() for text in legend.get_texts()]
    return found


def test_every_chart_is_written_twice_and_always_the_same(tmp_path: Path) -> None:
    engines = {"mujoco": {"Euler": 1, "RK4": 4}}
    record = build(scenarios=("sphere",), engines=engines, steps=(0.02, 0.01), samples=8)
    written = write_figures(record, tmp_path / "one")
    again = write_figures(record, tmp_path / "two")
    names = [path.name for path in written]
    assert {re.fullmatch(r"sphere-(.*)\.(svg|png)", name)[1] for name in names} == CHARTS
    assert sorted(path.name for path in (tmp_path / "one").iterdir()) == sorted(names)
    assert len(names) == 2 * len(CHARTS)
    for one, two in zip(written, again, strict=True):
        data = one.read_bytes()
        assert hashlib.sha256(data).digest() == hashlib.sha256(two.read_bytes()).digest()
        if one.suffix == ".svg":
            root = ElementTree.fromstring(data)
            assert root.tag.endswith("svg")
            assert b"<dc:date>" not in data
            assert b"<script" not in data
        else:
            assert data.startswith(b"\x89PNG")
            assert b"matplotlib" not in data.lower()


def test_names_of_files_are_plain_and_unique() -> None:
    names = [*HOSTILE, "T-handle", "t handle", "x" * 300, "", " "]
    stems = file_stems(names)
    assert len(set(stems.values())) == len(names)
    for stem in stems.values():
        assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", stem)
        assert len(stem) < 80
    assert stems["con"] != "con"
    assert file_stems(["t-handle", "sphere"]) == {"t-handle": "t-handle", "sphere": "sphere"}


@settings(derandomize=True, max_examples=25)
@given(st.lists(st.text(alphabet="aA-1 x/é", max_size=3), unique=True, max_size=8))
def test_no_two_scenarios_share_a_file(names) -> None:
    stems = file_stems(names).values()
    assert len({stem.casefold() for stem in stems}) == len(names)


def test_a_hostile_name_is_drawn_as_text(tmp_path: Path) -> None:
    """A formula that does not close, letters without a glyph and control characters."""
    engine = {"$\\bad{ engine \n": {"$x": 1, "漢字 <b>": 1}}
    made = build(scenarios=HOSTILE[1:2], engines=engine, steps=(0.02, 0.01), samples=4)
    made.run["scenarios"][0]["title"] = "".join(HOSTILE)
    written = write_figures(made, tmp_path / "figures")
    assert {path.parent for path in written} == {tmp_path / "figures"}
    for path in written:
        if path.suffix == ".svg":
            ElementTree.fromstring(path.read_bytes())


def test_engine_is_colour_and_integrator_is_dash(charts) -> None:
    figure = draw(charts, "attitude")
    expected = colours(["reference", "mujoco", "dart"])
    drawn = lines_of(figure)
    lanes = list(charts.lines.values())
    for line, lane in zip(drawn, lanes, strict=False):
        assert to_hex(line.get_color()) == expected[lane.engine][0]
        assert line.is_dashed() is bool(lane.dash)
    dashes = {lane.dash for lane in lanes if lane.engine == "mujoco"}
    assert len(dashes) == 2


def test_the_values_drawn_are_the_finest_step_s(charts) -> None:
    figure = draw(charts, "attitude")
    assert "step 0.005 s" in figure.axes[0].get_title(loc="left")
    for line, lane in zip(lines_of(figure), charts.lines.values(), strict=False):
        (deviation,) = [
            c
            for c in charts.chart.deviations
            if (c.engine, c.integrator, c.timestep) == (lane.engine, lane.integrator, 0.005)
        ]
        seen = np.asarray(line.get_ydata(), dtype=float)
        known = np.isfinite(seen)
        assert known.any()
        np.testing.assert_array_equal(seen[known], deviation.values["attitude"][known])


def test_no_zero_stands_on_a_logarithmic_axis(charts) -> None:
    for kind in charts.chart.units:
        figure = draw(charts, kind)
        for line in lines_of(figure):
            values = np.asarray(line.get_ydata(), dtype=float)
            assert not np.any(values <= 0.0)
        low, high = figure.axes[0].get_ylim()
        assert 0.0 < low < high
    deviation = charts.finest[0]
    values = np.array([0.0, 1e-18, -1.0, np.nan, np.inf, 1e300, 1e-3])
    odd = type(deviation)(
        **{**vars(deviation), "time": np.arange(7.0), "values": {"energy": values}}
    )
    drawn = shown(odd, "energy")
    assert np.isnan(drawn[:5]).all()
    assert drawn[5] < 1e300
    assert drawn[6] == 1e-3


def test_a_run_without_an_error_is_named_and_not_drawn(charts) -> None:
    """In the synthetic record dart has the exact rate: omega-dot is right to the last digit."""
    figure = draw(charts, "omega_dot")
    assert "dart semi-implicit (≤ 1e-17)" in texts_of(figure)
    colour = colours(["dart"])["dart"][0]
    (line,) = [line for line in lines_of(figure) if to_hex(line.get_color()) == colour]
    assert np.isnan(np.asarray(line.get_ydata(), dtype=float)).all()


def test_round_off_bound_and_floor_are_drawn(charts) -> None:
    figure = draw(charts, "attitude")
    levels = [set(np.asarray(line.get_ydata(), dtype=float)) for line in lines_of(figure)]
    assert {1e-13} in levels  # every bound of the synthetic record
    assert {3e-9} in levels
    assert {"round-off bound", "floor"} <= set(texts_of(figure))
    drift = draw(charts, "angular_momentum")
    assert {1e-13} in [set(np.asarray(x.get_ydata(), dtype=float)) for x in lines_of(drift)]


def test_a_floor_far_below_is_named_and_does_not_flatten_the_rest(charts) -> None:
    far = Limits(charts.limits.bounds, {"attitude": 1e-16})
    figure = draw_convergence(type(charts)(**{**vars(charts), "limits": far}))
    assert "floor 1e-16, below" in texts_of(figure)
    assert figure.axes[0].get_ylim()[0] > 1e-16


def test_convergence_shows_slopes_of_the_declared_orders(charts) -> None:
    figure = draw_convergence(charts)
    message = {text.get_text() for text in figure.axes[0].texts}
    assert {"slope 1", "slope 4"} <= message
    guides = [line for line in lines_of(figure) if to_hex(line.get_color()) == SOFT]
    slopes = set()
    for line in guides:
        steps, errors = (np.log(np.asarray(data, dtype=float)) for data in line.get_data())
        slopes.add(round(float(np.diff(errors)[0] / np.diff(steps)[0]), 9))
    assert slopes == {1.0, 4.0}


def test_the_pareto_front_is_named(record) -> None:
    """mujoco's RK4 is made the cheapest and the most accurate."""
    best = (pl.col("engine") == "mujoco") & (pl.col("integrator") == "RK4")
    cost = pl.col("metric") == "time_per_step"
    error = pl.col("metric") == "error_max"
    value = pl.when(best & cost).then(1e-7).when(best & error).then(1e-8).otherwise("value")
    made = type(record)(record.run, record.metrics.with_columns(value=value), record.trajectories)
    figure = draw_work_precision(charts_of(made)[0])
    message = [text for text in texts_of(figure) if text.startswith("1  ")]
    assert len(message) == 1
    assert message[0].startswith("1  mujoco RK4 at step 0.02 s: 1e-8 rad")
    assert not [text for text in texts_of(figure) if text.startswith("2  ")]


def test_the_legend_has_every_line_once_and_fits(charts) -> None:
    entries = [Entry(line, line.name) for line in charts.lines.values()]
    entries.append(Entry(None, "rounding's bound"))
    blocks = blocks_of(entries)
    assert sorted(p for block in blocks for p in block.places) == list(range(len(entries)))
    figure = draw(charts, "attitude")
    figure.canvas.draw()
    box = figure.bbox
    for legend in figure.legends:
        extent = legend.get_window_extent()
        assert 0.0 <= extent.x0 < extent.x1 <= box.x1
        assert extent.y0 >= 0.0
        assert extent.y1 < figure.axes[0].get_window_extent().y0


def test_without_matplotlib_it_is_one_sentence(record, monkeypatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(RecordError, match=r"install omegadot\[figures\]") as caught:
        write_figures(record, tmp_path / "figures")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "figures").exists()


def test_a_folder_that_cannot_be_written_is_one_sentence(record, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("kept")
    with pytest.raises(RecordError, match="cannot be written"):
        write_figures(record, tmp_path / "file")
    assert (tmp_path / "file").read_text() == "kept"


def test_nothing_half_written_is_left(record, monkeypatch, tmp_path: Path) -> None:
    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("omegadot.reports.charts.static.write.os.replace", fail)
    with pytest.raises(RecordError, match="No space left"):
        write_figures(record, tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_record_without_trajectories_is_one_sentence(record, tmp_path: Path) -> None:
    bare = type(record)(record.run, record.metrics, record.trajectories.clear())
    with pytest.raises(RecordError, match="no trajectories"):
        write_figures(bare, tmp_path)
