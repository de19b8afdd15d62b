"""``omegadot.findings``: every declared finding, measured in records and by its script."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from omegadot.commands.findings.entry import Entry, entries_of
from omegadot.commands.findings.measured import (
    Measured,
    from_records,
    read_measured,
    write_measured,
)
from omegadot.commands.findings.reproduce import reproduce as run_script
from omegadot.commands.findings.verdict import Finding, judged
from omegadot.commands.progress import Count, Reporting, reporting
from omegadot.commands.typed import typed
from omegadot.harness.usage import UsageError, check_number, nearest
from omegadot.reports.record.record import read_record
from omegadot.reports.record.whole_file import path_of

FOLDER = "docs/findings"
TIMEOUT = 300.0  # s, of one script; JAX compiles for many


@dataclass(frozen=True)
class FindingsResult:
    """findings: all, those first that change a motion most.  folder: that of their scripts."""

    findings: tuple[Finding, ...]
    folder: Path

    @property
    def standing(self) -> tuple[Finding, ...]:
        """Those that were reproduced in both ways."""
        return tuple(finding for finding in self.findings if finding.stands)

    @property
    def doubted(self) -> tuple[Finding, ...]:
        """The others."""
        return tuple(finding for finding in self.findings if not finding.stands)

    def __repr__(self) -> str:
        return f"<omegadot findings: {len(self.standing)} of {len(self.findings)} stand>"


@typed
def findings(
    records: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] = (),
    *,
    folder: str | os.PathLike[str] = FOLDER,
    names: str | Sequence[str] = (),
    reproduce: bool = False,
    timeout: float = TIMEOUT,
    progress: Reporting = False,
) -> FindingsResult:
    """Judge every finding by what was measured of it; measure again where that is requested.

    records: folders of runs, whose figures replace what was measured before.  folder: the scripts
    that declare the findings, and ``measured.json``.  names: of findings, alone; without any, all.
    reproduce: run their scripts, each for at most timeout s. What is measured is written to
    ``measured.json``. Raises UsageError and RecordError.
    """
    place = path_of(folder)
    check_number("--timeout", timeout, 0.1)
    chosen = _chosen(entries_of(place), [names] if isinstance(names, str) else list(names))
    before = read_measured(place)
    given = [records] if isinstance(records, str | os.PathLike) else list(records)
    held = [read_record(path_of(one)) for one in given]
    found = {e.name: from_records(e, held, before.get(e.name, Measured())) for e in chosen}
    if reproduce:
        with reporting(progress) as report:
            count = Count(report, "scripts", len(chosen))
            for entry in chosen:
                found[entry.name] = run_script(entry.script, found[entry.name], timeout)
                count.advance()
    if held or reproduce:
        write_measured(place, {**before, **found})
    all_of_them = (judged(entry, found[entry.name]) for entry in chosen)
    return FindingsResult(tuple(sorted(all_of_them, key=lambda one: one.order)), place)


def _chosen(entries: Sequence[Entry], names: Sequence[str]) -> list[Entry]:
    known = [entry.name for entry in entries]
    for name in names:
        if name not in known:
            raise UsageError(f"--name {name}: no such finding; {nearest(name, known)}.")
    return [entry for entry in entries if not names or entry.name in names]
