"""Units that a trace was not in, recognised by the motion: in another unit it is a body's.

``I w' = -w x (I w)`` holds for ``c w(c t)`` if it does for ``w(t)``, and the attitude goes with it:
only the product of the units of rate and time shows, so that two units may fit alike.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import fdtrc

from omegadot.commands.fit.compared import ALLOWED, Terms
from omegadot.commands.fit.models import nearest_fits
from omegadot.commands.fit.noise import Noise, noise_of
from omegadot.commands.fit.samples import Samples, TooFastError, samples_of, units_of
from omegadot.commands.fit.start import sized
from omegadot.commands.score.clock import GROSS, NEARER
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.table import TraceError
from omegadot.commands.units import UNITS
from omegadot.reference_impl.system import Array
from omegadot.written import written

Unit = tuple[str, str]
"""A kind, ``rate`` or ``time``, and a unit of it."""
_WHAT = {"rate": "omega", "time": "the time"}
MOST_NUMBERS = 16  # of the richest model
_SAME = 1e-9  # relative: the factors of two units are one, but for rounding


@dataclass(frozen=True)
class Other:
    """The nearest motion in another unit. misfit: of omega, what it leaves.  units: that fit alike.

    white: whether that is noise, or less than the digits show.
    """

    misfit: float
    units: list[Unit]
    white: bool


def samples_in_units(reading: Reading, torque: Array, terms: Terms) -> Samples:
    """The samples; where the body would turn too fast in the units, TraceError with the likely one.

    Likely is a unit in which a body's motion leaves noise alone, and NEARER times less than by any
    other factor.
    """
    try:
        return samples_of(reading)
    except TooFastError as error:
        found = sorted(_others(reading, torque, terms), key=lambda other: other.misfit)
        alone = found and all(other.misfit > NEARER * found[0].misfit for other in found[1:])
        likely = alone and found[0].white and found[0].misfit < GROSS
        advice = _likely(reading, found[0].units) if likely else _open_advice(reading)
        raise TraceError(f"{error}; {advice}.") from None


def check_fit(noise: Noise, reading: Reading, torque: Array, terms: Terms) -> None:
    """Raise TraceError where the fit leaves more than noise, and in another unit it is far nearer.

    That is NEARER times, or where noise alone is left, by more than chance: an F-test of the two.
    """
    own, spare = _size(noise, reading), max(3 * len(reading.times) - MOST_NUMBERS, 1)
    if not (noise.seen and noise.correlation > 0.0):
        return
    found = list(_others(reading, torque, terms))
    best = min(found, key=lambda other: other.misfit, default=None)
    if best is None or best.misfit >= GROSS:
        return
    chance = float(fdtrc(spare, spare, (own / best.misfit) ** 2)) * len(found)
    if (best.white and chance < ALLOWED) or best.misfit * NEARER < own:
        raise TraceError(
            f"{reading.table.file}: read in {units_of(reading)}, no motion of a body is nearer "
            f"than {written(100.0 * own, 2)} % of omega, and {written(100.0 * best.misfit, 2)} % "
            f"in another unit; {_likely(reading, best.units)}."
        )


def _others(reading: Reading, torque: Array, terms: Terms) -> Iterator[Other]:
    """The nearest motion in every other unit in which the trace can be fitted."""
    for units in _alike(reading):
        kind, unit = units[0]
        try:
            samples = samples_of(_in_unit(reading, kind, unit))
        except TraceError:
            continue
        data = sized(samples.data(torque))
        digits = (samples.digits[0] / samples.size, samples.digits[1])
        noise = noise_of(data, nearest_fits(data, terms)[1], digits)
        yield Other(_size(noise, reading), units, not (noise.seen and noise.correlation > 0.0))


def _size(noise: Noise, reading: Reading) -> float:
    """Of what is left, relative to omega; with an attitude that in rad too."""
    turning = {"qw", "e1", "r11"} & set(reading.columns)
    return float(np.hypot(noise.omega, noise.turn)) if turning else noise.omega


def _in_unit(reading: Reading, kind: str, unit: str) -> Reading:
    changed: dict[str, Any] = {f"{kind}_unit": unit}
    return replace(reading, how=replace(reading.how, **changed))


def _alike(reading: Reading) -> list[list[Unit]]:
    """The other units of rate and time; together those that no motion tells apart."""
    found: list[tuple[float, list[Unit]]] = []
    for kind in ("rate", "time") if reading.timed else ("rate",):
        for unit, value in UNITS[kind].items():
            factor = value / reading.how.scale_of(kind)
            same = [units for other, units in found if abs(other / factor - 1.0) < _SAME]
            if abs(factor - 1.0) < _SAME:
                continue
            if same:
                same[0].append((kind, unit))
            else:
                found.append((factor, [(kind, unit)]))
    return [units for _, units in found]


def _likely(reading: Reading, units: list[Unit]) -> str:
    """What it looks like and what to give; of two that fit the one that is not declared."""
    assumed = [unit for unit in units if _is_default(reading, unit[0])] or units
    looks = " or ".join(f"{_WHAT[kind]} looks like {unit}" for kind, unit in assumed)
    advice = " or ".join(reading.advice(f"{kind}_unit", unit) for kind, unit in assumed)
    return f"{looks}; {advice}"


def _open_advice(reading: Reading) -> str:
    """What to do where no single other unit fits."""
    kinds = ["rate", "time"] if reading.timed else ["rate"]
    options = [f"--{kind}-unit" for kind in kinds if f"{kind}-unit" not in reading.named]
    names = [
        repr(reading.named[f"{kind}-unit"]) for kind in kinds if f"{kind}-unit" in reading.named
    ]
    parts = [f"give the units of the file with {' and '.join(options)}"] if options else []
    parts += [f"correct the unit in the name of column {' and '.join(names)}"] if names else []
    return ", or ".join(parts)


def _is_default(reading: Reading, kind: str) -> bool:
    return f"{kind}-unit" not in {*reading.named, *reading.declared}
