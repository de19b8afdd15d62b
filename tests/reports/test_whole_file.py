"""What is replaced: a file of the same kind that omegadot wrote, and nothing else."""

import os
import tempfile
from pathlib import Path

import pytest

from omegadot.commands.report.command import printed
from omegadot.commands.report.report import report
from omegadot.commands.run.result import result_of
from omegadot.reports.record.interrupted import place_of_interrupted, written_in
from omegadot.reports.record.record import FILES, Record, check_folder, read_record, write_record
from omegadot.reports.record.schema import RecordError
from omegadot.reports.record.whole_file import PAGE_MARK, write_whole
from omegadot.reports.run_record import RunRecord

PAGE = f"<!doctype html>{PAGE_MARK} report</title>"


def refused(target: Path) -> str:
    with pytest.raises(RecordError) as error:
        write_whole(target, PAGE, PAGE_MARK)
    text = str(error.value)
    assert text.startswith(f"{target}: ")
    assert text.endswith(".")
    assert "\n" not in text
    return text


def test_a_page_takes_the_place_of_a_page(tmp_path: Path) -> None:
    target = tmp_path / "page.html"
    for text in (PAGE, f"{PAGE} again"):
        assert write_whole(target, text, PAGE_MARK) == target
        assert target.read_text() == text
    assert os.listdir(tmp_path) == ["page.html"]


@pytest.mark.parametrize("text", ["", "my notes", '{"schema": 1}', " " * 5000 + PAGE])
def test_a_file_of_another_kind_stays(tmp_path: Path, text: str) -> None:
    target = tmp_path / "notes.html"
    target.write_text(text)
    assert "not replaced" in refused(target)
    assert target.read_text() == text


def test_links_devices_and_folders_stay(tmp_path: Path) -> None:
    page, link, gap, pipe = (tmp_path / name for name in ("page.html", "link", "gap", "pipe"))
    page.write_text(PAGE)
    link.symlink_to(page)
    gap.symlink_to(tmp_path / "nothing")
    os.mkfifo(pipe)
    for target in (link, gap, pipe, Path(os.devnull)):
        assert "is a link or a device" in refused(target)
    assert link.is_symlink()
    assert gap.is_symlink()
    assert pipe.is_fifo()
    assert "is a folder" in refused(tmp_path)


def test_a_report_does_not_destroy_its_record(tmp_path: Path, record) -> None:  # type: ignore[no-untyped-def]
    folder = tmp_path / "run"
    write_record(record, folder, PAGE)
    before = {name: (folder / name).read_bytes() for name in FILES}
    for name in ("run.json", "metrics.parquet", "trajectories.parquet"):
        with pytest.raises(RecordError, match="not replaced"):
            report(folder, out=folder / name)
        with pytest.raises(RecordError, match="not replaced"):
            report(folder, folder, out=folder / name)
    assert {name: (folder / name).read_bytes() for name in FILES} == before


def interrupted(record: Record, finished: int) -> Record:
    """The same, interrupted after so many tasks."""
    tasks = [
        task if k < finished else {**task, "outcome": "interrupted", "gates": {}}
        for k, task in enumerate(record.run["tasks"])
    ]
    rows = len(record.metrics) // len(tasks) * finished  # each task has as many
    run = {**record.run, "complete": False, "tasks": tasks}
    return Record(run, record.metrics.head(rows), record.trajectories)


def test_one_interrupted_run_is_kept_beside_a_record(tmp_path: Path, record) -> None:  # type: ignore[no-untyped-def]
    """Caught: folders that pile up, and a longer interrupted run that a shorter one replaces."""
    folder, beside = tmp_path / "run", tmp_path / "run-interrupted"
    short, long = interrupted(record, 1), interrupted(record, 2)

    def place(one: Record) -> Path | None:
        found, note = place_of_interrupted(one.run, folder)
        assert (note == "") == (found == folder)
        return found

    assert place(short) == folder
    write_record(short, folder, PAGE)
    assert place(short) == place(long) == folder
    write_record(long, folder, PAGE)
    assert (place(short), place(long)) == (beside, folder)
    write_record(record, folder, PAGE)
    assert place(long) == beside
    write_record(long, beside, PAGE)
    assert (place(short), place(long)) == (None, beside)
    write_record(record, beside, PAGE)
    assert place(long) is None


def test_a_record_in_a_record_is_refused_before_the_run(tmp_path: Path, record) -> None:  # type: ignore[no-untyped-def]
    outer, inner = tmp_path / "run", tmp_path / "run" / "a" / "sub"
    write_record(record, outer, PAGE)
    with pytest.raises(RecordError, match=r"lies in the record .*run, which no run could"):
        check_folder(inner)
    assert sorted(os.listdir(outer)) == sorted(FILES)
    write_record(record, tmp_path / "new" / "sub", PAGE)
    with pytest.raises(RecordError, match="new: holds 'sub', which is another record"):
        check_folder(tmp_path / "new")


def test_a_path_is_printed_on_one_line(tmp_path: Path, record) -> None:  # type: ignore[no-untyped-def]
    """Caught: a name with a newline, or with what steers a terminal, printed as it is."""
    write_record(record, tmp_path / "run", PAGE)
    text = printed([tmp_path / "run"], tmp_path / "a\nb\x1b[31m.html", None, False)
    assert text == f"{tmp_path}/a\\nb\\x1b[31m.html"
    assert (tmp_path / "a\nb\x1b[31m.html").is_file()


@pytest.mark.parametrize("inside", [".", "figures", "link"])
def test_nothing_is_drawn_into_a_record(tmp_path: Path, record, inside: str) -> None:  # type: ignore[no-untyped-def]
    """Caught: charts or a second page in a record's folder, which no run replaces from then on."""
    folder = tmp_path / "run"
    write_record(record, folder, PAGE)
    (tmp_path / "link").symlink_to(folder)
    target = tmp_path / "link" if inside == "link" else folder / inside
    with pytest.raises(RecordError, match=r"which no run could replace with figures in it; name"):
        RunRecord.of(read_record(folder)).figures(target)
    with pytest.raises(RecordError, match=r"could replace with page.html in it; name another"):
        report(folder, out=target / "page.html")
    with pytest.raises(RecordError, match=r"could replace with two.html in it; name another"):
        report(folder, folder, out=target / "two.html")
    assert sorted(os.listdir(folder)) == sorted(FILES)
    check_folder(folder)


def test_a_shorter_interrupted_run_is_kept_out_of_the_way(  # type: ignore[no-untyped-def]
    tmp_path: Path, record, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: a run that finds no place beside longer ones, and is lost."""
    monkeypatch.setattr(RunRecord, "page", lambda _: PAGE)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    folder = tmp_path / "run"
    write_record(record, folder, PAGE)
    write_record(interrupted(record, 2), tmp_path / "run-interrupted", PAGE)
    result = result_of(RunRecord.of(interrupted(record, 1)), (), folder, written_in(folder))
    assert result.folder is not None
    assert not read_record(result.folder).run["complete"]
    assert "interrupted after 2 tasks, this one after 1." in result.note
    assert result.note.endswith(f"This run's record is in {result.folder}.")


def test_the_second_of_two_runs_into_one_folder_keeps_the_first(  # type: ignore[no-untyped-def]
    tmp_path: Path, record, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: two runs at once, of which the first to end is lost without a word."""
    monkeypatch.setattr(RunRecord, "page", lambda _: PAGE)
    folder = tmp_path / "run"
    earlier = written_in(folder)
    of = RunRecord.of(record)
    first = result_of(of, (), folder, earlier)
    assert (first.folder, first.note) == (folder, "")
    second, third = (result_of(of, (), folder, earlier) for _ in range(2))
    assert (second.folder, third.folder) == (tmp_path / "run-2", tmp_path / "run-3")
    assert second.note == (
        f"The record in {folder} is kept: another run wrote it during this one. "
        f"This run's record is in {tmp_path / 'run-2'}."
    )
    assert result_of(of, (), folder, written_in(folder)).folder == folder  # an earlier one


def test_a_link_to_nothing_is_no_place_for_a_record(tmp_path: Path) -> None:
    """Caught: folders made where the link leads to."""
    (tmp_path / "link").symlink_to(tmp_path / "elsewhere" / "record")
    for folder in (tmp_path / "link", tmp_path / "link" / "run"):
        with pytest.raises(RecordError, match="link: is a symbolic link to nothing"):
            check_folder(folder)
    assert not (tmp_path / "elsewhere").exists()
