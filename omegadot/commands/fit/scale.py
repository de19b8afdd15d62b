"""What gives the inertia its scale: a torque, a moment that is known, or nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.commands.fit.spread import Spread
from omegadot.commands.score.convention import LARGEST
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.system import Array
from omegadot.written import written

AXES = {"x": 0, "y": 1, "z": 2}
PLACES = {"smallest": 0, "middle": 1, "largest": 2}


@dataclass(frozen=True)
class Known:
    """A moment that is known. name: an axis of the body, or a place among the principal moments.

    value: kg m^2.
    """

    name: str
    value: float


@dataclass(frozen=True)
class Scale:
    """From the fit's inertia to the one that is reported: ``factor * I``.

    slopes: (m,), of the factor by the parameters.  unit: of the inertia; empty of a ratio.
    why: what the scale is.
    """

    factor: float
    slopes: Array
    unit: str
    why: str


def known_of(text: str | None) -> Known | None:
    """``largest=0.0123`` or ``x=0.0123``. Raises UsageError."""
    if text is None:
        return None
    name, _, number = text.partition("=")
    name = name.strip().lower()
    if name not in (*AXES, *PLACES):
        advice = nearest(name, (*AXES, *PLACES))
        raise UsageError(f"--moment {text}: there is no moment {name!r}; {advice}.")
    try:
        value = float(number)
    except ValueError:
        value = np.nan
    if not (np.isfinite(value) and value > 0.0):
        raise UsageError(f"--moment {text}: write a positive number of kg m^2, like {name}=0.0123.")
    return Known(name, value)


def torque_of(given: str | Sequence[float] | None) -> Array:
    """(3,) N m of ``0.1,0,0`` or three numbers; zero of None. Raises UsageError."""
    if given is None:
        return np.zeros(3)
    parts = given.split(",") if isinstance(given, str) else list(given)
    try:
        torque = np.array([float(part) for part in parts])
    except (TypeError, ValueError):
        torque = np.full(3, np.nan)
    if torque.shape != (3,) or not np.all(np.abs(torque) <= LARGEST) or not np.any(torque):
        shown = given if isinstance(given, str) else ",".join(map(str, parts))
        raise UsageError(
            f"--torque {shown}: write three numbers of N m in the body's axes, of at most "
            f"{written(LARGEST)} and not all zero, like 0,0,0.02."
        )
    return torque


def scale_of(spread: Spread, known: Known | None, unit: float, spin: Array | None) -> Scale:
    """The scale of a fit. unit: kg m^2, that of the fit where a torque is given.

    spin: the axis about which the body turns, where no other moment shows.
    """
    still = np.zeros(len(spread.covariance))
    if spread.free.scale:
        return Scale(unit, still, "kg m^2", "the torque that is given")
    _, axes = np.linalg.eigh(spread.one.inertia)
    name, value = ("largest", 1.0) if known is None else (known.name, known.value)
    axis = np.eye(3)[AXES[name]] if name in AXES else axes[:, PLACES[name]]
    if known is None and spin is not None:
        axis = spin
    size = float(axis @ spread.one.inertia @ axis)
    factor = value / size
    slopes = -factor / size * spread.slope_of_entry(axis, axis)
    if known is None:
        which = "the largest moment" if spin is None else "the moment about omega"
        return Scale(factor, slopes, "", f"{which}, which is set to 1")
    return Scale(factor, slopes, "kg m^2", f"the {name} moment that is given")
