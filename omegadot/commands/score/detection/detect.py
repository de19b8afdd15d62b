"""``omegadot.detect``: which conventions a trace follows, by trying all plausible ones.

A reading is chosen only where it fits ten times better than any other; else all that fit as well
are named.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from omegadot.commands.score.detection.candidates import Attitude, attitudes, omegas
from omegadot.commands.score.detection.clocks import Timed, clocks_of
from omegadot.commands.score.detection.numbers import AXES, SAME, Numbers, Rotated, rotations
from omegadot.commands.score.detection.reading import Clock, Reading, unlike
from omegadot.commands.score.exact_trajectory import exact_trajectory
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.score import case_given
from omegadot.commands.score.settings import GivenColumns, settings_of
from omegadot.commands.score.table import Table, TraceError, bare, find_column
from omegadot.commands.typed import typed
from omegadot.gates.case import Case
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.system import Array
from omegadot.reports.record.whole_file import path_of
from omegadot.scenarios import ScenarioLike

MOST_SAMPLES = 60
# Settings of a map that change the numbers of a trace and are not sought.
_CHANGING = {"omega-bias", "world-rate", "world-origin"}
BETTER = 10.0
KINDS = {"q": "quaternion", "e": "Euler angles", "r": "matrix", "w": "omega"}
# Below this a misfit is rounding, of a median over a chain of them.
ROUNDING = 1024 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Detected:
    """fitting: the readings that fit best and alike, the plainest first.

    others: the next best, worse by more than ten times, the nearest first.  turn: rad, how far the
    body turns, one at most.
    """

    fitting: list[Reading]
    others: list[Reading]
    turn: float


@typed
def detect(
    trace: str | os.PathLike[str],
    scenario: ScenarioLike,
    *,
    columns: GivenColumns = (),
    map_file: str | os.PathLike[str] | None = None,
    rate: float | None = None,
    from_time: float | str | None = None,
    to_time: float | str | None = None,
) -> Detected:
    """Which conventions a trace can be read in so that it is the scenario's motion.

    ``fitting`` holds one reading where the conventions are found; its ``arguments()`` are those to
    score with, ``score(trace, scenario, **reading.arguments())``.
    columns, map_file, rate, from_time, to_time: as of `score`; of columns that are named, these
    alone are tried, and as the group that they are named for.
    Raises UsageError, TraceError (a UsageError) and ScenarioError.
    """
    case, table = case_given(scenario), read_table(path_of(trace))
    own = {"rate": rate, "from": from_time, "to": to_time}
    assigned, settings = settings_of(columns, path_of(map_file) if map_file else None, own)
    for key in _CHANGING & settings.keys():
        raise UsageError(
            f"--map {map_file}: {key} is nothing that a search for conventions takes; leave it out."
        )
    declared = {key: settings[key] for key in own if key in settings}
    column, names = _looked_at(table, assigned, "rate" in declared)
    clocks = clocks_of(table, column, declared, case.scenario.run.duration)
    by_clock = _next_to(case, table, clocks, [name for name in names if name != column])
    groups = _groups(table, assigned)
    found: list[Reading] = []
    # Turned axes are tried only where the trace can be read more wholly with them.
    for axes in (SAME + 1, len(AXES)):
        if not any(len(reading.parts) == 2 for reading in found):
            more = [r for pair in by_clock for r in _readings(*pair, axes) if _as_named(r, groups)]
            most = max((len(reading.parts) for reading in found), default=0)
            found = found + [reading for reading in more if len(reading.parts) > most]
    turn = by_clock[0][1].turn if by_clock else 0.0
    if not found:
        return Detected([], [], turn)
    most = max(len(reading.parts) for reading in found)
    whole = [reading for reading in found if len(reading.parts) == most]
    limit = BETTER * max(min(reading.misfit for reading in whole), ROUNDING)
    fitting = unlike(sorted((r for r in whole if r.misfit <= limit), key=lambda r: r.plainness))
    others = [r for r in whole if r.misfit > limit] + _next_best(fitting[0], dict(by_clock))
    others = [reading for reading in others if reading.misfit > limit]
    return Detected(fitting, sorted(others, key=lambda r: r.misfit), turn)


def _looked_at(
    table: Table, mapped: Sequence[tuple[str, Sequence[str]]], counted: bool
) -> tuple[str | None, Sequence[str]]:
    """The time's column, and the others to try: those that are named, if any are; else all.

    The time is in the column named so, one called so, or the first that rises. Raises TraceError.
    counted: whether there is none, the samples come at a rate.
    """
    named = {role.lower(): [find_column(table, n, role) for n in names] for role, names in mapped}
    times = named.pop("t", []) + named.pop("time", [])
    others = {name for names in named.values() for name in names}
    tried = [name for name in table.names if name in others] if others else table.names
    if counted:
        return None, tried
    for name in table.names:
        folded = bare(name)
        if folded in ("t", "sec") or folded.startswith(("time", "t ")):
            times.append(name)
    times = times or [name for name in table.names if _rises(table, name)]
    if not times:
        raise TraceError(
            f"{table.file}: no column rises from sample to sample like a time; name it with "
            "--column t=NAME, or give --rate."
        )
    return times[0], tried


def _rises(table: Table, name: str) -> bool:
    with suppress(TraceError):
        return bool(np.all(np.diff(table.times(name)[0].values) > 0.0))
    return False


def _groups(table: Table, mapped: Sequence[tuple[str, Sequence[str]]]) -> dict[str, set[str]]:
    """The columns of each group that is named whole."""
    groups = {role.lower(): names for role, names in mapped}
    return {
        group: {find_column(table, name, group) for name in names}
        for group, names in groups.items()
        if group in KINDS
    }


def _as_named(reading: Reading, groups: dict[str, set[str]]) -> bool:
    """Whether columns that are named as a group are read as that."""
    attitude, omega = reading.attitude, reading.omega
    kinds = {group: KINDS[group] for group in groups if group != "w"}
    if attitude is not None and kinds:
        plain = {"quaternion wxyz": "q", "quaternion xyzw": "q", "matrix": "r"}
        group = plain.get(attitude.kind, "e")
        if group not in kinds or set(attitude.columns) != groups[group]:
            return False
    return omega is None or "w" not in groups or set(omega.columns) == groups["w"]


def _next_to(
    case: Case,
    table: Table,
    clocks: Sequence[Timed],
    names: Sequence[str],
) -> list[tuple[Clock, Numbers]]:
    """The trace's numbers next to the exact trajectory, once for every clock."""
    trajectory = exact_trajectory(case.system, case.initial)
    found, read = [], dict[bytes, tuple[dict[str, Array], list[tuple[Rotated, Array]]]]()
    for clock, inside, times in clocks:
        rows = np.unique(np.linspace(0, len(times) - 1, MOST_SAMPLES).round().astype(int))
        key = inside.tobytes()
        if key not in read:
            part, columns = table.part(inside), dict[str, Array]()
            for name in names:
                with suppress(TraceError):  # one of texts or with gaps is passed over
                    columns[name] = part.column(name).values[rows]
            read[key] = (
                columns,
                [(rotated, rotated.read(columns)) for rotated in rotations(columns)],
            )
        columns, turned = read[key]
        exact = trajectory(np.maximum(times[rows], 0.0))
        found.append((clock, Numbers(columns, exact.orientation, exact.angular_velocity, turned)))
    return found


def _readings(clock: Clock, numbers: Numbers, axes: int) -> list[Reading]:
    turned = attitudes(numbers, axes)
    if turned:
        best = min(one.misfit for one in turned)
        turned = [one for one in turned if one.misfit <= BETTER * BETTER * max(best, ROUNDING)]
    found = []
    read: list[Attitude | None] = [*turned] or [None]
    for attitude in read:
        taken = set(attitude.columns) if attitude else set()
        free = [o for o in omegas(numbers, attitude, axes) if not taken & set(o.columns)]
        found += [Reading(clock, attitude, omega) for omega in free]
        found += [Reading(clock, attitude, None)] if attitude and not free else []
    return found


def _next_best(best: Reading, by_clock: dict[Clock, Numbers]) -> list[Reading]:
    """The same with another attitude or another omega, however far off, in the plain axes."""
    numbers, how = by_clock[best.clock], (SAME + 1, float("inf"))
    turned = attitudes(numbers, *how) if best.attitude else []
    spins = omegas(numbers, best.attitude, *how) if best.omega else []
    found = [replace(best, attitude=one) for one in turned]
    return found + [replace(best, omega=one) for one in spins]
