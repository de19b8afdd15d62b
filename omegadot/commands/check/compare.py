"""The checks that a baseline adds, one for each run and each scenario, and its update."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from omegadot.commands.check.baseline import changes, updated
from omegadot.commands.check.baseline_file import (
    Baseline,
    RunKey,
    ScenarioFigures,
    read_baseline,
    write_baseline,
)
from omegadot.commands.check.generate import Subject
from omegadot.commands.check.meaning import meaning
from omegadot.commands.check.result import PASSED, Check, Result
from omegadot.gates.case import Case

GATE = "baseline"
MOST_LISTED = 3
UPDATE = "look at it, then accept it with --update-baseline"


def _keys_now(subject: Subject, case: Case) -> list[RunKey]:
    finest = min(sweep.timestep for sweep in case.sweeps)
    stepped = subject.name != "exact"
    return [RunKey(), *(RunKey(name, finest) for name in subject.integrators if stepped)]


def _is_chosen(subject: Subject, key: RunKey) -> bool:
    """Whether a stored run belongs to what is checked: an integrator that is gone does."""
    left_out = set(subject.declared) - set(subject.integrators)
    narrowed = bool(left_out)
    return not key.integrator or key.integrator in subject.integrators or not narrowed


def baseline_checks(
    subject: Subject, cases: Sequence[Case], stored: Baseline | None
) -> Iterator[Check]:
    """A check for every run there is and for every one that the baseline remembers."""
    for case in cases:
        keys = dict.fromkeys(_keys_now(subject, case))
        if stored is not None and case.name in stored:
            keys |= dict.fromkeys(k for k in stored[case.name].runs if _is_chosen(subject, k))
        for key in keys:
            yield Check(subject.name, case.name, GATE, key.integrator or None, key.timestep)


def compare(
    check: Check, stored: Baseline | None, now: ScenarioFigures | None, version: str
) -> Result:
    """Compare the figures of one run or one scenario with those that are stored."""
    key = RunKey(check.integrator or "", check.timestep)
    own = now.runs.get(key) if now else None
    was = stored.get(check.scenario) if stored is not None else None
    known = was.runs.get(key) if was is not None else None
    if known is None or was is None:
        if own is None:
            return Result("skip", "no values, and none are stored")
        return Result("fail", "no values are stored for this; write them with --update-baseline.")
    versions = f"{check.engine} {was.version} -> {version}"
    if own is None:
        gone = f"values are stored of {check.engine} {was.version}, and {version} gives none"
        return Result("fail", f"{gone}: {UPDATE}.")
    found = changes(known, own)
    if not found:
        return PASSED
    listed = "; ".join(change.sentence for change in found[:MOST_LISTED])
    more = f"; and {len(found) - MOST_LISTED} more" if len(found) > MOST_LISTED else ""
    why = meaning(known, own, found, was.version == version)
    return Result("fail", f"{versions}: {listed}{more}. Probably {why}. {UPDATE.capitalize()}.")


def store(folder: Path, subjects: Iterable[Subject], figures: dict[str, Baseline]) -> list[Path]:
    """Update the baseline of every engine that gave figures; the files that were written."""
    written = []
    for subject in subjects:
        if subject.name in figures:
            stored = read_baseline(folder, subject.name)
            whole = updated(stored, figures[subject.name], subject)
            written.append(write_baseline(folder, subject.name, whole))
    return written
