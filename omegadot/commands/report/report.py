"""``omegadot.report``: a stored run drawn again, or two side by side."""

from __future__ import annotations

import gc
import os
from pathlib import Path

from omegadot.commands.compare.compare import compare
from omegadot.commands.typed import typed
from omegadot.reports.charts.chart_library import packed_library
from omegadot.reports.record.whole_file import (
    PAGE_MARK,
    as_record_error,
    check_target,
    path_of,
    write_whole,
)

TWO_RUNS = Path("two-runs.html")
PathLike = str | os.PathLike[str]


@typed
def report(run: PathLike, other: PathLike | None = None, *, out: PathLike | None = None) -> Path:
    """Draw the page of a stored run again, or of two runs side by side; where it was written.

    out: the page's file; else ``report.html`` in the run's folder, or, of two runs,
    ``two-runs.html`` in the current one. Raises RecordError.
    """
    file = None if out is None else path_of(out)
    if file is not None:
        from omegadot.reports.record.record import FILES, check_no_record

        if file.name not in FILES:
            check_no_record(file.parent, file.name)
    if other is None:
        return redraw(path_of(run), file)
    from omegadot.reports.two_runs.page import draw_two_runs

    check_target(file or TWO_RUNS, PAGE_MARK)
    return write_whole(file or TWO_RUNS, draw_two_runs(compare(run, other)), PAGE_MARK)


def redraw(folder: Path, out: Path | None = None) -> Path:
    """Draw the page again, into the run's folder or into the file `out`. Raises RecordError.

    A choice of engine that was written into the run's folder is a section of it.
    """
    with as_record_error(folder):
        is_folder = folder.is_dir()
    if is_folder:
        packed_library()  # started first: it has a core to itself
    collecting = gc.isenabled()
    gc.disable()  # nothing that is made here is garbage before the page is whole
    try:
        from omegadot.reports.choice.page import read_choice
        from omegadot.reports.page.page import draw_page
        from omegadot.reports.record.record import PAGE, read_record

        check_target(out or folder / PAGE, PAGE_MARK)
        page = draw_page(read_record(folder), read_choice(folder))
        return write_whole(out or folder / PAGE, page, PAGE_MARK)
    finally:
        if collecting:
            gc.enable()
