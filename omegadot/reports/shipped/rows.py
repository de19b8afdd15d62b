"""The table "As shipped": an engine in both setups, and the single setting that mends most."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import polars as pl

from omegadot.reports.charts.divergence import STATE, states_of, system_from
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import SETUPS, YARDSTICKS
from omegadot.reports.shipped.figures import Figures, figures_of, restored
from omegadot.reports.summary.flips import Flipping, Flips, flips_of, turned_over

PREFERRED = "t-handle"
LESS = 0.995  # nearer to 1 a ratio is 1 in two digits
AS_SHIPPED = SETUPS[1]
Knob = TypeVar("Knob")
Run = tuple[str, str, float | None, float | None]


@dataclass(frozen=True)
class ShippedRow:
    """An engine's integrator, with one step or accuracy, in both setups.

    settings: by the name of a setting, the run as shipped with this one mended.
    exact_flips: those of the exact motion; None where it has none, or a torque acts.
    """

    scenario: str
    engine: str
    integrator: str
    timestep: float | None
    accuracy: float | None
    physics: Figures
    as_shipped: Figures
    settings: Mapping[str, Figures] = field(default_factory=dict)
    exact_flips: Flips | None = None

    def flipping(self, run: Figures) -> Flipping | None:
        """Whether one of its runs flips as the exact motion does; None where there is no answer."""
        if self.exact_flips is None or run.until is None:
            return None
        return turned_over(run.flips, run.until, self.exact_flips)

    def ratio(self, run: Figures) -> float | None:
        """A run's mean attitude error in parts of that as shipped."""
        own, whole = run.attitude_mean, self.as_shipped.attitude_mean
        return None if own is None or not whole else own / whole

    @property
    def mends_most(self) -> tuple[str, float] | None:
        """The setting with the least ratio, below 1 in two digits, and that ratio, if any has."""
        ratios = {name: self.ratio(run) for name, run in self.settings.items()}
        known = {
            name: ratio for name, ratio in ratios.items() if ratio is not None and ratio < LESS
        }
        return min(known.items(), key=lambda pair: pair[1]) if known else None

    @property
    def alike(self) -> bool:
        """Whether the mean attitude errors of both setups are equal in two digits."""
        ratio = self.ratio(self.physics)
        return LESS <= ratio <= 1.0 / LESS if ratio is not None else self.physics == self.as_shipped


def middle(values: Iterable[Knob], key: Any = None) -> Knob:
    """Of steps or accuracies the middle one, of two the larger: that of the table."""
    found = sorted(values, key=key)
    return found[len(found) // 2]


def scenario_of(names: Iterable[str]) -> str:
    """The scenario of the table: the T-handle, or else the first."""
    found = list(names)
    return PREFERRED if PREFERRED in found else found[0]


def shipped_rows(record: Record) -> tuple[ShippedRow, ...]:
    """A row an engine and integrator, at the middle step or accuracy; () of a run in one setup."""
    tasks = [task for task in record.run["tasks"] if task["engine"] not in YARDSTICKS]
    if {task.get("setup") for task in tasks} != set(SETUPS):
        return ()
    scenario = scenario_of(entry["name"] for entry in record.run["scenarios"])
    runs = _runs(tasks, scenario)
    measured = _Measured(record, scenario)
    found = []
    for engine, integrator in dict.fromkeys(key[:2] for key in runs[AS_SHIPPED]):
        knobs = [key[2:] for key in runs[AS_SHIPPED] if key[:2] == (engine, integrator)]
        key: Run = (engine, integrator, *middle(knobs, lambda pair: pair[0] or pair[1] or 0.0))
        physics, shipped = (
            measured.figures(setup, key, runs[setup].get(key, "–")) for setup in SETUPS
        )
        singles = _settings(record.run.get("single_settings") or (), scenario, key)
        flips = measured.exact_flips
        found.append(ShippedRow(scenario, *key, physics, shipped, singles, flips))
    return tuple(found)


def _runs(tasks: Iterable[Mapping[str, Any]], scenario: str) -> dict[str, dict[Run, str]]:
    """By setup and run of this scenario its outcome."""
    found: dict[str, dict[Run, str]] = {setup: {} for setup in SETUPS}
    for task in tasks:
        if task["scenario"] == scenario and task.get("integrator"):
            key = task["engine"], task["integrator"], task.get("timestep"), task.get("accuracy")
            found[task["setup"]][key] = task["outcome"]
    return found


class _Measured:
    """The trajectories of a record's scenario, measured beside the exact one."""

    def __init__(self, record: Record, scenario: str) -> None:
        entries = {entry["name"]: entry.get("system") for entry in record.run["scenarios"]}
        samples = record.trajectories.filter(scenario=scenario)
        self._system = system_from(entries[scenario]) if entries[scenario] else None
        self._exact = samples.filter(engine="exact").unique("time").select("time", *STATE)
        self._samples = samples.filter(pl.col("engine") != "exact")
        self.exact_flips: Flips | None = None
        if self._system and len(self._exact):
            exact = self._exact.sort("time")
            times, omega = exact.get_column("time").to_numpy(), states_of(exact).angular_velocity
            found = flips_of(times, omega, self._system)
            self.exact_flips = found if found and found.flips else None

    def figures(self, setup: str, run: Run, outcome: str) -> Figures:
        """Those of one run, or its outcome alone where it has no samples at exact times."""
        names = ("engine", "integrator", "timestep", "accuracy")
        own = [pl.col(name).eq_missing(value) for name, value in zip(names, run, strict=True)]
        found = self._samples.filter(pl.col("setup") == setup, *own)
        both = found.join(self._exact, on="time", how="inner", suffix="_exact").sort("time")
        if outcome != "ok" or self._system is None or both.is_empty():
            return Figures(outcome)
        times = both.get_column("time").to_numpy()
        return figures_of(self._system, times, states_of(both), states_of(both, "_exact"))


def _settings(entries: Iterable[Mapping[str, Any]], scenario: str, run: Run) -> dict[str, Figures]:
    """By setting the run as shipped with this one mended."""
    names = ("engine", "integrator", "timestep", "accuracy")
    own = (scenario, *run)
    return {
        entry["setting"]: restored(entry)
        for entry in entries
        if (entry["scenario"], *(entry.get(name) for name in names)) == own
    }
