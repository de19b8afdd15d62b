"""The checks that a baseline adds, one for each run and each scenario, and its update."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from omegadot.commands.check.baseline import Change, changes, updated
from omegadot.commands.check.baseline_file import (
    Baseline,
    Figures,
    RunKey,
    ScenarioFigures,
    read_baseline,
    write_baseline,
)
from omegadot.commands.check.generate import Subject
from omegadot.commands.check.result import PASSED, Check, Result
from omegadot.gates.case import Case
from omegadot.reports.text.numbers import short

# Another order of accuracy moves an error by more than this; another setting seldom does.
ANOTHER_INTEGRATOR = 10.0
TRANSLATION = {"position", "linear_momentum", "energy"}


def _channel(change: Change) -> str:
    return change.name.split()[0]


def _of_a_scenario(found: Sequence[Change]) -> str:
    channels = {change.name.split()[1] for change in found}
    if any(change.name.startswith("equation") for change in found):
        if "omega_dot" in channels:
            return "the equation of motion changed: omega-dot is another at identical states"
        part = "inverse dynamics" if "torque" in channels else "the acceleration of the body"
        return f"the equation changed: {part} is another at identical states"
    if "model" in channels:
        return "the engine holds another mass, centre of mass or inertia than before"
    return "states are read back otherwise: a frame or a reference point changed"


def _of_a_run(found: Sequence[Change]) -> str:
    by_channel = {_channel(change): change for change in reversed(found)}
    if set(by_channel) <= TRANSLATION:
        return (
            "the translation is stepped otherwise (at the origin or the centre of mass, or with "
            "another rule), the turning is as before"
        )
    if "omega" not in by_channel:
        return "the update of the attitude changed, that of omega did not"
    factor = by_channel["omega"].factor
    if math.isnan(factor):
        return "the run diverges, or no longer does"
    if not 1.0 / ANOTHER_INTEGRATOR < factor < ANOTHER_INTEGRATOR:
        how = f"grew {short(factor)}x" if factor > 1.0 else f"shrank {short(1.0 / factor)}x"
        how = how if 0.0 < factor < math.inf else "vanished or appeared"
        return f"omega error {how}: the integrator changed"
    return "the order is the same: a default such as a tolerance, a damping or a limit changed"


def meaning(was: Figures, now: Figures, found: Sequence[Change], same_version: bool) -> str:
    """The likeliest reason for some changes, in one clause."""
    if was.scheme != now.scheme and was.scheme:
        message = (
            f"the integrator changed: declared {was.scheme} then, {now.scheme or 'nothing'} now"
        )
    elif any(_channel(change) in ("model", "equation") for change in found):
        message = _of_a_scenario(found)
    else:
        message = _of_a_run(found)
    if same_version:
        return f"{message}; the version is the same, so look at the build or the adapter"
    return message


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
