"""A record is written whole or not at all, and comes back as it was."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pyarrow.parquet as pq
import pytest
from polars.testing import assert_frame_equal
from synthetic_record import build, with_metrics

from omegadot.reports.record import record as record_module
from omegadot.reports.record.record import FILES, Record, check_folder, read_record, write_record
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.record.schema import METRICS, TRAJECTORIES, RecordError, conform


@pytest.fixture
def folder(tmp_path, record):
    write_record(record, tmp_path / "run", "<p>page</p>")
    return tmp_path / "run"


def one_sentence(error: pytest.ExceptionInfo) -> str:
    text = str(error.value)
    assert "\n" not in text
    assert text.endswith(".")
    return text


def test_a_record_comes_back_as_it_was(folder, record):
    back = read_record(folder)
    assert back.run == record.run
    assert_frame_equal(back.metrics, record.metrics)
    assert_frame_equal(back.trajectories, record.trajectories)
    assert sorted(os.listdir(folder)) == sorted(FILES)
    assert (folder / "report.html").read_text() == "<p>page</p>"


def test_units_stand_in_the_column_metadata(folder):
    schema = pq.read_schema(folder / "trajectories.parquet")
    assert schema.names == list(TRAJECTORIES)
    units = {
        name: schema.field(name).metadata[b"unit"] for name in ("time", "wx", "az", "py", "vz")
    }
    assert units == {
        "time": b"s",
        "wx": b"rad/s",
        "az": b"rad/s^2",
        "py": b"m",
        "vz": b"m/s",
    }
    assert pq.read_schema(folder / "metrics.parquet").names == list(METRICS)


def test_values_that_are_not_finite_survive(tmp_path, record):
    columns = pl.when(pl.col("time") > 1.0).then(float("nan")).otherwise("wx").alias("wx")
    broken = Record(record.run, record.metrics, record.trajectories.with_columns(columns))
    write_record(broken, tmp_path / "run", "")
    assert read_record(tmp_path / "run").trajectories.get_column("wx").is_nan().any()


@pytest.mark.parametrize("step", ["write_table", "replace"])
def test_a_write_that_fails_leaves_the_earlier_record(folder, monkeypatch, step):
    before = {name: (folder / name).read_bytes() for name in FILES}

    def refuse(*_args, **_more):
        raise OSError(28, "No space left on device")

    real = os.replace

    def refuse_the_new(source, target):
        if Path(source).suffix == ".new":
            refuse()
        real(source, target)

    if step == "write_table":
        monkeypatch.setattr(pq, "write_table", refuse)
    else:
        monkeypatch.setattr(record_module, "_exchange", lambda *_: False)  # as on macOS
        monkeypatch.setattr(record_module.os, "replace", refuse_the_new)
    with pytest.raises(RecordError, match="No space left") as error:
        write_record(build(("other",)), folder, "new")
    one_sentence(error)
    assert {name: (folder / name).read_bytes() for name in FILES} == before
    assert os.listdir(folder.parent) == ["run"]


def test_an_interrupted_write_leaves_nothing(tmp_path, monkeypatch, record):
    def interrupt(*_args, **_more):
        raise KeyboardInterrupt

    monkeypatch.setattr(pq, "write_table", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_record(record, tmp_path / "run", "")
    assert os.listdir(tmp_path) == []


def test_an_earlier_record_is_replaced_whole(folder):
    write_record(build(("other",)), folder, "new")
    assert [entry["name"] for entry in read_record(folder).run["scenarios"]] == ["other"]
    assert (folder / "report.html").read_text() == "new"
    assert os.listdir(folder.parent) == ["run"]


def test_an_empty_folder_and_missing_parents_are_fine(tmp_path, record):
    (tmp_path / "empty").mkdir()
    write_record(record, tmp_path / "empty", "")
    write_record(record, tmp_path / "a" / "b", "")
    assert (tmp_path / "empty" / "run.json").is_file()
    assert (tmp_path / "a" / "b" / "run.json").is_file()


@pytest.mark.parametrize("kept", [["thesis.tex"], ["run.json", "thesis.tex"], ["metrics.parquet"]])
def test_what_is_not_a_record_is_never_touched(tmp_path, record, kept):
    for name in kept:
        (tmp_path / name).write_text("precious")
    with pytest.raises(RecordError) as error:
        write_record(record, tmp_path, "")
    assert str(tmp_path) in one_sentence(error)
    assert sorted(os.listdir(tmp_path)) == sorted(kept)


def test_a_file_and_the_current_folder_are_refused(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordError, match="is a file"):
        check_folder(tmp_path / "file")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    with pytest.raises(RecordError, match="current directory"):
        check_folder(Path())
    with pytest.raises(RecordError, match="current directory"):
        check_folder(tmp_path)


@pytest.mark.parametrize("name", ["run.json", "metrics.parquet", "trajectories.parquet"])
@pytest.mark.parametrize("share", [0.0, 0.02, 0.5, 0.999])
def test_a_truncated_file_is_one_sentence(folder, name, share):
    data = (folder / name).read_bytes()
    (folder / name).write_bytes(data[: int(share * (len(data) - 2))])
    with pytest.raises(RecordError) as error:
        read_record(folder)
    assert name in one_sentence(error)


@pytest.mark.parametrize("name", ["metrics.parquet", "trajectories.parquet"])
def test_damage_in_the_middle_is_one_sentence(folder, name):
    data = bytearray((folder / name).read_bytes())
    data[8 : len(data) // 2] = bytes(len(data) // 2 - 8)
    (folder / name).write_bytes(data)
    with pytest.raises(RecordError) as error:
        read_record(folder)
    assert name in one_sentence(error)


@pytest.mark.parametrize("name", ["run.json", "metrics.parquet", "trajectories.parquet"])
def test_a_missing_file_and_folder_are_named(folder, name):
    (folder / name).unlink()
    with pytest.raises(RecordError, match=name):
        read_record(folder)
    with pytest.raises(RecordError, match="no such folder"):
        read_record(folder / "nowhere")


WHOLE = '{"schema": 1, "engines": [], "scenarios": [], "tasks": [], "clusters": %s}'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[]", "not an omegadot record"),
        ("{}", "not an omegadot record"),
        ('{"schema": 2}', "schema is 2"),
        ('{"schema": NaN}', "NaN"),
        ('{"schema": 1, "engines": [], "scenarios": []}', "tasks"),
        ('{"schema": 1, "engines": [{}], "scenarios": [], "tasks": []}', r"engines\[0\].name"),
        ('{"schema": 1, "engines": [], "scenarios": [], "tasks": [{}]}', r"tasks\[0\].scenario"),
        (WHOLE % "7", "clusters is 7, expected a valid list"),
        (WHOLE % "[7]", r"clusters\[0\]"),
        (WHOLE % '[{"scenario": "s", "timestep": 1, "members": [3]}]', r"clusters\[0\]"),
        ("[" * 100_000, "JSON"),
        ("\xff", "run.json"),
    ],
)
def test_a_wrong_run_file_is_one_sentence(folder, text, message):
    (folder / "run.json").write_bytes(text.encode("latin-1"))
    with pytest.raises(RecordError, match=message) as error:
        read_record(folder)
    one_sentence(error)


def test_values_outside_the_contract_are_refused(folder, tmp_path, record):
    run = json.loads((folder / "run.json").read_text())
    run["tasks"][3]["outcome"] = "green"
    (folder / "run.json").write_text(json.dumps(run))
    with pytest.raises(RecordError, match=r"tasks\[3\].outcome is 'green'"):
        read_record(folder)
    row = {**record.metrics.row(0, named=True), "verdict": "skipped"}
    with pytest.raises(RecordError, match="'skipped'"):
        with_metrics(record, row)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.drop("qz"), "'qz' is missing"),
        (lambda t: t.with_columns(wx=pl.lit("fast")), "type"),
        (lambda t: t.with_columns(engine=pl.lit(None, pl.String)), "'engine' has empty values"),
        (lambda t: t.with_columns(setup=pl.lit("tuned")), "'tuned'"),
    ],
)
def test_tables_that_break_the_contract_are_not_written(tmp_path, record, change, message):
    wrong = Record(record.run, record.metrics, change(record.trajectories))
    with pytest.raises(RecordError, match=message) as error:
        write_record(wrong, tmp_path / "run", "")
    one_sentence(error)
    assert os.listdir(tmp_path) == []


def test_columns_of_nulls_and_of_another_order_are_cast(record):
    loose = record.metrics.with_columns(pl.lit(None).alias("accuracy")).select(
        sorted(record.metrics.columns)
    )
    assert_frame_equal(conform(loose, METRICS, "metrics"), record.metrics)


def test_json_is_strict_and_takes_what_numpy_gives():
    given = {"a": np.float64("nan"), "b": [float("inf"), np.arange(2)], "c": frozenset("yx")}
    assert json.loads(dump_json(given)) == {"a": None, "b": [None, [0, 1]], "c": ["x", "y"]}


@pytest.mark.parametrize("killed", ["between", "before"])
def test_what_a_killed_process_left_is_recovered(folder, monkeypatch, killed):
    """Killed between the two renames, the earlier record is put back; before them, it stands."""
    gone = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, check=True
    )
    name = f".{folder.name}.{int(gone.stdout)}-{'0' * 12}"
    before = (folder / "run.json").read_bytes()
    if killed == "between":
        folder.rename(folder.with_name(f"{name}.old"))
    folder.with_name(f"{name}.new").mkdir()
    strange = folder.with_name(f".{folder.name}.mine")
    strange.mkdir()
    check_folder(folder)  # it may be being written
    assert folder.with_name(f"{name}.new").exists()
    monkeypatch.setattr(record_module, "SECONDS_TO_WRITE", 0.0)
    check_folder(folder)
    assert (folder / "run.json").read_bytes() == before
    assert {path.name for path in folder.parent.iterdir()} == {folder.name, strange.name}
