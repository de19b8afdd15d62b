"""What ``omegadot report`` prints: the files that it wrote, or a summary in Markdown."""

from __future__ import annotations

from pathlib import Path

from omegadot.commands.report.report import report
from omegadot.harness.usage import UsageError


def printed(runs: list[Path], out: Path | None, figures: Path | None, markdown: bool) -> str:
    """What is to be printed. Raises RecordError and UsageError."""
    if len(runs) > 2:
        raise UsageError(f"{len(runs)} runs are given; give one, or two to hold side by side.")
    if markdown and (out is not None or figures is not None):
        raise UsageError("--markdown prints and writes no file; leave out --out and --figures.")
    if len(runs) == 2 and figures is not None:
        raise UsageError("--figures draws one run; give one run alone.")
    if markdown:
        return _markdown(runs)
    if figures is None:
        return str(report(*runs, out=out))
    from omegadot.reports.run_record import read_record

    written = [report(runs[0], out=out)] if out is not None else []
    return "\n".join(map(str, [*written, *read_record(runs[0]).figures(figures)]))


def _markdown(runs: list[Path]) -> str:
    if len(runs) == 1:
        from omegadot.reports.run_record import read_record

        return read_record(runs[0]).markdown()
    from omegadot.commands.compare.compare import compare
    from omegadot.reports.two_runs.text import as_markdown

    return as_markdown(compare(*runs)).rstrip("\n")
