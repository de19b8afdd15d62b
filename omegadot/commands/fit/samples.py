"""The samples that are fitted: omega and attitude of a trace, within a window."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.fit.data import Data
from omegadot.commands.score.settings import Reading
from omegadot.commands.score.table import TraceError
from omegadot.commands.score.trace import Trace, trace_of
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array, Body, System
from omegadot.written import written

LEAST_SAMPLES = 6  # 18 numbers, for the 8 to 12 that are fitted
MOST_TURNED = 5000.0  # rad; an evaluation of the motion takes seconds then
_ANY = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),))  # a trace of omega needs no body


class TooFastError(TraceError):
    """The body turns further from sample to sample than samples show; the advice is to be added."""


@dataclass(frozen=True)
class Samples:
    """What is fitted. file: its name.  times: (n,) s, of the trace.  omega: (n, 3) rad/s, body.

    orientation: (n, 4), or None.  digits: rad/s and rad, the resolution of a component.
    tick: s, what is open of a time.
    """

    file: str
    times: Array
    omega: Array
    orientation: Array | None
    digits: tuple[float, float]
    tick: float

    @property
    def size(self) -> float:
        """rad/s, the root-mean-square length of omega: its unit in the fit."""
        return float(np.sqrt(np.mean(np.sum(self.omega**2, axis=1))))

    def data(self, torque: Array) -> Data:
        """In the units of the fit. torque: N m, of any length there."""
        times = (self.times - self.times[0]) * self.size
        unit = float(np.linalg.norm(torque)) or 1.0
        return Data(times, self.omega / self.size, self.orientation, torque / unit)

    def inertia_unit(self, torque: Array, fitted: Array) -> float:
        """The unit of inertia, kg m^2, in which a torque (N m) is `fitted`; 1 without one."""
        length = float(np.linalg.norm(fitted))
        return float(np.linalg.norm(torque)) / (length * self.size**2) if length else 1.0


def samples_of(reading: Reading) -> Samples:
    """The samples of a trace. Raises TraceError where they cannot be fitted, as by TooFastError."""
    trace = trace_of(reading, _ANY)
    file, omega = reading.table.file, trace.angular_velocity
    if omega is None or np.any(np.isnan(omega)):
        raise TraceError(
            f"{file}: no column is an angular velocity, which a fit needs in three axes; map it, "
            "like --column w=A,B,C."
        )
    turned = None if trace.orientation is None else normalize(trace.orientation)
    tick = float(np.max(reading.stamps.open) + 2.0 * EPS * np.max(np.abs(trace.times)))
    found = Samples(file, trace.times, omega, turned, _digits(trace), tick)
    _check(found, reading)
    return found


def units_of(reading: Reading) -> str:
    """Those of omega and of the times, and where each is from."""
    time = reading.origin("time_unit") if reading.timed else "s"
    return f"{reading.origin('rate_unit')} and {time}"


def _digits(trace: Trace) -> tuple[float, float]:
    """The root-mean-square rounding of a component: a third of the half unit of a vector's length.

    Of a component rounded to within u, it is ``u / sqrt(3)``; the vector's resolution is
    ``sqrt(3) u``.
    """
    opened = [trace.open.get(name) for name in ("angular_velocity", "orientation")]
    omega, turn = (0.0 if one is None else float(np.sqrt(np.mean(one**2))) / 3.0 for one in opened)
    return omega, turn


def _check(found: Samples, reading: Reading) -> None:
    """Raise TraceError where nothing can be fitted, TooFastError where the units show it."""
    count = len(found.times)
    if count < LEAST_SAMPLES:
        raise TraceError(
            f"{found.file}: {count} samples are given; a fit needs at least {LEAST_SAMPLES}."
        )
    if not found.size > 3.0 * found.digits[0]:
        raise TraceError(
            f"{found.file}: omega is zero to the digits that are given; a body at rest shows none "
            "of its moments, so give a trace of one that turns."
        )
    turned = float(found.data(np.zeros(3)).turned[-1])
    if turned > np.pi * (count - 1):
        raise TooFastError(
            f"{found.file}: read in {units_of(reading)}, the body turns by "
            f"{written(turned / (count - 1), 3)} rad from sample to sample, more than samples can "
            "show"
        )
    if turned > MOST_TURNED:
        raise TraceError(
            f"{found.file}: the body turns by {turned:.0f} rad; fit a part of at most "
            f"{MOST_TURNED:.0f} rad, with --from and --to."
        )
