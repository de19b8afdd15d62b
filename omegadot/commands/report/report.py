"""``omegadot report``: a stored run drawn again, as a page, as figures, or as text; or two."""

from __future__ import annotations

import gc
from pathlib import Path

from omegadot.harness.usage import UsageError
from omegadot.reports.charts.chart_library import packed_library
from omegadot.reports.record.whole_file import write_whole

TWO_RUNS = Path("two-runs.html")


def report_of(folders: list[Path], out: Path | None, figures: Path | None, markdown: bool) -> str:
    """What is to be printed: what was written, or words. Raises RecordError, UsageError."""
    if len(folders) > 2:
        raise UsageError(f"{len(folders)} runs are given; give one, or two to hold side by side.")
    if markdown and (out is not None or figures is not None):
        raise UsageError("--markdown prints and writes no file; leave out --out and --figures.")
    if len(folders) == 2:
        return _of_two(folders[0], folders[1], out, figures, markdown)
    if not markdown and figures is None:
        return str(redraw(folders[0], out))
    from omegadot.reports.record.record import read_record

    if markdown:
        from omegadot.reports.text.markdown import markdown_of

        return markdown_of(read_record(folders[0])).rstrip("\n")
    from omegadot.reports.charts.static import write_figures

    assert figures is not None
    written = [redraw(folders[0], out)] if out is not None else []
    return "\n".join(map(str, [*written, *write_figures(read_record(folders[0]), figures)]))


def redraw(folder: Path, out: Path | None = None) -> Path:
    """Draw the page again, into the run's folder or where `out` states. Raises RecordError.

    A choice of engine that was written into the run's folder is a section of it.
    """
    if folder.is_dir():
        packed_library()  # begun before anything else is imported or read: it has a core to itself
    collecting = gc.isenabled()
    gc.disable()  # nothing that is made here is garbage before the page is whole
    try:
        from omegadot.reports.choice.files import read_choice
        from omegadot.reports.page.page import draw_page
        from omegadot.reports.record.record import PAGE, read_record

        page = draw_page(read_record(folder), read_choice(folder))
        return write_whole(out or folder / PAGE, page)
    finally:
        if collecting:
            gc.enable()


def _of_two(was: Path, now: Path, out: Path | None, figures: Path | None, markdown: bool) -> str:
    from omegadot.reports.record.record import read_record
    from omegadot.reports.two_runs import compare_records
    from omegadot.reports.two_runs.page import draw_two_runs
    from omegadot.reports.two_runs.text import as_markdown

    if figures is not None:
        raise UsageError("--figures draws one run; give one run alone.")
    records = read_record(was), read_record(now)
    comparison = compare_records(*records, (was.as_posix(), now.as_posix()))
    if markdown:
        return as_markdown(comparison).rstrip("\n")
    return str(write_whole(out or TWO_RUNS, draw_two_runs(comparison)))
