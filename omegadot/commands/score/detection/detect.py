"""``omegadot.detect``: which conventions a trace follows, by trying all plausible ones.

A reading is chosen only where it fits ten times better than any other; else all that fit as well
are named.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from omegadot.commands.score.detection.candidates import Attitude, attitudes, omegas
from omegadot.commands.score.detection.numbers import AXES, SAME, Numbers, rotations
from omegadot.commands.score.detection.reading import Clock, Reading, unlike
from omegadot.commands.score.exact_trajectory import exact_trajectory
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.score import case_given
from omegadot.commands.score.settings import GivenColumns, settings_of
from omegadot.commands.score.table import Table, TraceError, find_column
from omegadot.commands.units import UNITS
from omegadot.gates.case import Case
from omegadot.reference_impl.system import Array
from omegadot.scenarios import ScenarioLike

MOST_SAMPLES = 60
BETTER = 10.0
LONGEST = 20.0  # times the scenario's duration
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


def detect(
    trace: str | os.PathLike[str],
    scenario: ScenarioLike,
    *,
    columns: GivenColumns = (),
    map_file: str | os.PathLike[str] | None = None,
) -> Detected:
    """Which conventions a trace can be read in so that it is the scenario's motion.

    ``fitting`` holds one reading where the conventions are found; its ``arguments()`` are those to
    score with, ``score(trace, scenario, **reading.arguments())``.
    columns, map_file: as of `score`; of columns that are named, these alone are tried.
    Raises UsageError, TraceError (a UsageError) and ScenarioError.
    """
    case, table = case_given(scenario), read_table(Path(trace))
    assigned, _ = settings_of(columns, Path(map_file) if map_file else None, {})
    column, names = _looked_at(table, assigned)
    by_clock = _next_to(case, table, column, names)
    found: list[Reading] = []
    # Turned axes are tried only where the trace cannot be read whole without.
    for axes in (SAME + 1, len(AXES)):
        if not any(len(reading.parts) == 2 for reading in found):
            found = [reading for pair in by_clock for reading in _readings(*pair, axes)]
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
    table: Table, mapped: Sequence[tuple[str, Sequence[str]]]
) -> tuple[str, Sequence[str]]:
    """The time's column, and the others to try: those that are named, if any are; else all.

    The time is in the column named so, one called so, or the first that rises. Raises TraceError.
    """
    named = {role.lower(): [find_column(table, n, role) for n in names] for role, names in mapped}
    times = named.pop("t", []) + named.pop("time", [])
    others = {name for names in named.values() for name in names}
    tried = [name for name in table.names if name in others] if others else table.names
    for name in table.names:
        folded = name.casefold().strip()
        if folded in ("t", "sec") or folded.startswith(("time", "t ")):
            times.append(name)
    times = times or [n for n in table.names if np.all(np.diff(table.column(n).values) > 0.0)]
    if not times:
        raise TraceError(f"{table.file}: no column rises from sample to sample like a time.")
    return times[0], tried


def _clocks(raw: Array, column: str, duration: float) -> list[Clock]:
    found = []
    for unit, scale in UNITS["time"].items():
        span, first = scale * float(raw[-1] - raw[0]), scale * float(raw[0])
        if not 0.0 < span <= LONGEST * duration:
            continue
        offsets = [0.0] if 0.0 <= first <= LONGEST * duration else []
        offsets += [first] if first != 0.0 else []
        found += [Clock(column, unit, offset) for offset in offsets]
    return found


def _next_to(
    case: Case, table: Table, column: str, names: Sequence[str]
) -> list[tuple[Clock, Numbers]]:
    """The trace's numbers next to the exact trajectory, once for every clock."""
    raw = table.column(column).values
    if len(raw) < 3 or np.any(np.diff(raw) <= 0.0):
        raise TraceError(f"{table.file}: fewer than three samples, or their time does not rise.")
    rows = np.unique(np.linspace(0, len(raw) - 1, MOST_SAMPLES).round().astype(int))
    columns: dict[str, Array] = {}
    for name in (name for name in names if name != column):
        with suppress(TraceError):  # one of texts or with gaps is passed over
            columns[name] = table.column(name).values[rows]
    trajectory = exact_trajectory(case.system, case.initial)
    turned = [(rotated, rotated.read(columns)) for rotated in rotations(columns)]
    found = []
    for clock in _clocks(raw, column, case.scenario.run.duration):
        exact = trajectory(np.maximum(UNITS["time"][clock.unit] * raw[rows] - clock.offset, 0.0))
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
