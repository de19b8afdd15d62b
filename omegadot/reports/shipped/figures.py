"""What one run comes to: its flips, the energy that it loses, how far its attitude is off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from omegadot.reference_impl.energy import kinetic_energy, total_energy
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import Array, State, System
from omegadot.reports.summary.flips import flips_of


@dataclass(frozen=True)
class Figures:
    """Of one run; None where it has no such number, as of a run that failed.

    outcome: that of its task.  flips, until: s, the times of its flips, and its last finite sample;
    where flips are counted (`reports.summary.flips`).
    energy_lost: at the end, below the exact one, in parts of the largest exact kinetic energy.
    attitude_end, attitude_mean: rad, the attitude error of the last sample, and over all.
    """

    outcome: str
    flips: tuple[float, ...] = ()
    until: float | None = None
    energy_lost: float | None = None
    attitude_end: float | None = None
    attitude_mean: float | None = None


def figures_of(system: System, time: Array, found: State, exact: State) -> Figures:
    """The figures of the samples of a run beside the exact ones at the same times, (n,) each."""
    with np.errstate(all="ignore"):  # a run that blew up has no numbers
        error = attitude_angle(found.orientation, exact.orientation)
        lost = total_energy(system, exact[-1]) - total_energy(system, found[-1])
        size = float(np.max(kinetic_energy(system, exact)))
        mean = float(np.mean(error))
    flips = flips_of(time, found.angular_velocity, system)
    share = _number(float(lost) / size) if size else None
    turning = (flips.times, _number(flips.until)) if flips else ((), None)
    return Figures("ok", *turning, share, _number(float(error[-1])), _number(mean))


def stored(figures: Figures) -> dict[str, Any]:
    """As ``run.json`` holds them."""
    return {**vars(figures), "flips": list(figures.flips)}


def restored(entry: Mapping[str, Any]) -> Figures:
    """Those of an entry of ``run.json``."""
    names = ("until", "energy_lost", "attitude_end", "attitude_mean")
    numbers = {name: entry.get(name) for name in names}
    return Figures(entry["outcome"], tuple(entry.get("flips") or ()), **numbers)


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None
