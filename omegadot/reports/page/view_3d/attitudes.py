"""The stored attitudes of every run next to the exact ones: what the 3-D view shows."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import polars as pl

from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array

# A run with more samples is thinned to so many; every number reported is of all its samples.
FRAMES = 300
# A run diverges where its attitude is farther than this from the exact one, rad.
DIVERGED = math.radians(1.0)
_RUN = ("engine", "setup", "integrator", "timestep", "accuracy")
_STATE = ("qw", "qx", "qy", "qz", "wx", "wy", "wz")
_EXACT = pl.col("engine") == "exact"
_PREFERRED_TRUTH = ("closed-form", "series")


@dataclass(frozen=True)
class RunAttitudes:
    """One run. frames: (n,) its samples' places in the exact solution's times.

    error: (n, 3) rad, the rotation from the exact attitude to its own, body axes; spin: (n, 3)
    rad/s, its omega less the exact one.  diverges: s, its first sample farther than DIVERGED from
    the exact one, None where there is none.  largest: rad.  end: s, its last sample.
    """

    engine: str
    setup: str
    integrator: str
    timestep: float | None
    accuracy: float | None
    frames: Array
    error: Array
    spin: Array
    diverges: float | None
    largest: float
    end: float


@dataclass(frozen=True)
class Attitudes:
    """A scenario. time: (n,) s; orientation: (n, 4); angular_velocity: (n, 3), both exact.

    truth: which exact solution it is, `closed-form` or `series`.
    """

    truth: str
    time: Array
    orientation: Array
    angular_velocity: Array
    runs: tuple[RunAttitudes, ...]

    @property
    def coarse(self) -> bool:
        """Whether the body turns by more than a right angle between samples: a picture between
        them, turned the short way round, may then mislead.
        """
        speed = np.sqrt(np.sum(self.angular_velocity**2, axis=-1))
        turned = np.diff(self.time) * np.maximum(speed[1:], speed[:-1])
        return bool(np.any(turned > 0.5 * np.pi))


def attitudes_of(trajectories: pl.DataFrame) -> dict[str, Attitudes]:
    """Every scenario that has an exact solution and a run to compare with it, by name."""
    found = {}
    columns = trajectories.select("scenario", *_RUN, "time", *_STATE)
    for (name,), rows in columns.partition_by("scenario", as_dict=True).items():
        exact, others = (rows.filter(side) for side in (_EXACT, ~_EXACT))
        names = exact.get_column("integrator").unique(maintain_order=True).to_list()
        for truth in [name for name in _PREFERRED_TRUTH if name in names] + names[:1]:
            deviation = _trajectory(exact.filter(pl.col("integrator") == truth))
            if len(deviation[0]) > 1 and (runs := tuple(_runs(others, *deviation))):
                found[str(name)] = _thinned(truth, *deviation, runs)
                break
    return found


def _trajectory(rows: pl.DataFrame) -> tuple[Array, Array, Array]:
    """Times, attitudes and omegas of an exact solution, in order of time."""
    values = rows.select("time", *_STATE).sort("time").unique("time", maintain_order=True)
    table = values.to_numpy()
    table = table[np.isfinite(table).all(axis=-1)]
    return table[:, 0], table[:, 1:5], table[:, 5:]


def _runs(rows: pl.DataFrame, time: Array, q: Array, w: Array) -> Iterator[RunAttitudes]:
    rows = rows.sort(*_RUN, "time")
    places = np.minimum(np.searchsorted(time, rows.get_column("time").to_numpy()), len(time) - 1)
    matched = time[places] == rows.get_column("time").to_numpy()
    rows, frames = rows.filter(matched), places[matched]
    if rows.is_empty():
        return
    table = rows.select("time", *_STATE).to_numpy()
    with np.errstate(all="ignore"):  # a run that blew up is cut where it did, below
        length = np.sqrt(np.sum(table[:, 1:5] ** 2, axis=-1, keepdims=True))
        error = rotation_between(q[frames], table[:, 1:5] / length)
        spin = table[:, 5:] - w[frames]
    sound = np.isfinite(error).all(axis=-1) & np.isfinite(spin).all(axis=-1)
    counts = rows.group_by(_RUN, maintain_order=True).len()
    stops = np.cumsum(counts.get_column("len").to_numpy().astype(int))
    for key, start, stop in zip(
        counts.select(_RUN).iter_rows(), [0, *stops[:-1]], stops, strict=True
    ):
        bad = np.flatnonzero(~sound[start:stop])
        stop = start + bad[0] if len(bad) else stop
        if stop - start < 2:
            continue
        angle = np.sqrt(np.sum(error[start:stop] ** 2, axis=-1))
        over = np.flatnonzero(angle > DIVERGED)
        own = start + _places(stop - start)
        yield RunAttitudes(
            **dict(zip(_RUN, key, strict=True)),
            frames=frames[own],
            error=error[own],
            spin=spin[own],
            diverges=float(table[start + over[0], 0]) if len(over) else None,
            largest=float(angle.max()),
            end=float(table[stop - 1, 0]),
        )


@cache
def _places(count: int) -> Array:
    """At most FRAMES places of `count`, even, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, FRAMES)).round().astype(int))


def _thinned(
    truth: str, time: Array, q: Array, w: Array, runs: tuple[RunAttitudes, ...]
) -> Attitudes:
    """The exact frames at which a run has a sample, and some more: no other is kept."""
    kept = np.unique(np.concatenate([_places(len(time)), *(run.frames for run in runs)]))
    place = np.zeros(len(time), dtype=int)
    place[kept] = np.arange(len(kept))
    moved = tuple(replace(run, frames=place[run.frames]) for run in runs)
    return Attitudes(truth, time[kept], q[kept], w[kept], moved)
