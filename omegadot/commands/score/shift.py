"""Right but late: the shift in time that fits a trace best, found on the exact trajectory itself.

The exact trajectory can be had at any time, so nothing is interpolated and samples may stand
anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.measured import Measured
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.runs.phase import FARTHEST, MOST_ITERATIONS
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, normalize, rotation_between
from omegadot.reference_impl.system import Array
from omegadot.written import written

MOST_COMPARED = 400  # samples, and as many shifts to either side, when a first shift is sought
# A shift that leaves a tenth of the error or less is what was wrong; more left, and more was.
EXPLAINS = 0.1


@dataclass(frozen=True)
class Shift:
    """The trace at t is nearest to the exact trajectory at t + seconds; negative is late.

    open: s, the resolution of the shift by digits and rounding.  before, after: the largest error,
    rad/s of omega, or rad of attitude where no omega is given.
    left: (m, 3), the remaining error at the samples.
    attitude_after: rad, the largest attitude error that is left; None where it is not given.
    bound: what digits and rounding account for of `after`.  of: "omega" or "attitude".
    first: the sample from which on the trace is shifted; those before are on time.
    """

    of: str
    seconds: float
    open: float
    before: float
    after: float
    bound: float
    left: Array
    attitude_after: float | None
    first: int = 0

    @property
    def seen(self) -> bool:
        """Whether it is larger than its resolution."""
        return abs(self.seconds) > self.open

    @property
    def explains(self) -> bool:
        """Whether the error is that of being late or early, and little else."""
        return self.seen and self.after <= max(EXPLAINS * self.before, self.bound)

    @property
    def as_text(self) -> str:
        """``late by 0.00032 s``."""
        text = f"{'late' if self.seconds < 0.0 else 'early'} by {written(abs(self.seconds), 4)} s"
        if not self.first:
            return text
        number = f"{self.first + 1}th" if self.first > 2 else ("second", "third")[self.first - 1]
        alone = "the first alone is" if self.first == 1 else "those before are"
        return f"{text} from the {number} sample on; {alone} on time"

    @property
    def note(self) -> str:
        """The same, or that it cannot be seen."""
        return self.as_text if self.seen else "neither late nor early"


def shift_of(found: Measured) -> Shift | None:
    """By omega; by the attitude where no omega is given, or where it is constant."""
    for of in ("omega", "attitude"):
        if of in found.error and (shift := _of_samples(found, of)) is not None:
            return shift
    return None


def _of_samples(found: Measured, of: str) -> Shift | None:
    """The shift of all samples, or of those behind the first ones that are on time.

    A simulator may log its initial state apart: its first sample is then on time, and all others
    are not.
    """
    whole = _best(found, of, 0)
    if whole is None or whole.explains or found.trace.times[0] > found.trace.open["times"][0]:
        return whole
    late = np.flatnonzero(found.error[of] > found.bound[of])
    first = max(1, int(late[0])) if len(late) else 0
    if not first or len(found.trace.times) - first < 3:
        return whole
    rest = _best(found, of, first)
    return rest if rest is not None and rest.explains else whole


def _residual(found: Measured, of: str, shift: float, first: int) -> tuple[Array, Array]:
    """(m, 3): trace minus exact at the samples that a shift leaves inside, and the rate of change.

    Of omega, or of the attitude as a rotation vector in body axes. Zero, both, in components that
    the trace does not give.
    """
    times = found.trace.times[first:] + shift
    inside = times >= 0.0
    exact = found.trajectory(times[inside])
    if of == "omega" and found.trace.angular_velocity is not None:
        slope = forward_dynamics(found.case.system, exact).angular
        own = found.trace.angular_velocity[first:][inside]
        known = ~np.isnan(own)
        gap = np.where(known, own - exact.angular_velocity, 0.0)
        return gap, np.where(known, slope, 0.0)
    own = normalize(found.state.orientation[first:][inside])
    return rotation_between(exact.orientation, own), exact.angular_velocity


def _start(found: Measured, omega: Array, first: int, open_gap: float) -> float:
    """A shift to begin with: the smallest that fits as well as any, half a gap allowed for."""
    trace = found.trace
    known = ~np.isnan(omega[0])
    rows = np.unique(np.linspace(first, len(trace.times) - 1, MOST_COMPARED).round().astype(int))
    times, duration = trace.times[rows], float(trace.times[-1])
    gap = max(FARTHEST * duration / MOST_COMPARED, open_gap)
    shifts = gap * np.arange(-MOST_COMPARED, MOST_COMPARED + 1)
    grid = gap * np.arange(int(np.ceil(1.25 * duration / gap)) + 2)
    exact = found.trajectory(grid).angular_velocity[:, known]
    wanted = times[None, :] + shifts[:, None]
    inside = wanted >= 0.0
    place = np.clip(wanted / gap, 0.0, len(grid) - 2.0)
    left = place.astype(int)
    share = (place - left)[..., None]
    value = (1.0 - share) * exact[left] + share * exact[left + 1]
    gaps = np.sum((omega[rows][:, known] - value) ** 2, axis=-1)
    counts = np.maximum(np.sum(inside, axis=1), 1)
    squares = np.sum(np.where(inside, gaps, 0.0), axis=1) / counts
    rates = np.diff(exact, axis=0) / gap
    allowed = 0.25 * gap**2 * float(np.mean(np.sum(rates * rates, axis=-1)))
    fitting = shifts[squares <= float(np.min(squares)) + allowed]
    return float(fitting[np.argmin(np.abs(fitting))])


def _best(found: Measured, of: str, first: int) -> Shift | None:
    """The shift that minimises the squares, by Gauss-Newton; None where nothing changes in time."""
    trace, unit = found.trace, found.rate if of == "omega" else 1.0
    limit = unit * float(np.max(found.bound[of][first:]))
    before, slope = _residual(found, of, 0.0, first)
    change = float(np.sqrt(np.mean(np.sum(slope * slope, axis=-1))))
    duration = float(trace.times[-1])
    if not change * duration > limit or len(trace.times) < 3:
        return None
    farthest, omega = FARTHEST * duration, trace.angular_velocity
    by_omega = of == "omega" and omega is not None
    shift = _start(found, omega, first, EPS * duration) if by_omega else 0.0  # type: ignore[arg-type]
    step = farthest / MOST_COMPARED
    for _ in range(2 * MOST_ITERATIONS):
        residual, slope = _residual(found, of, shift, first)
        more = float(np.sum(residual * slope) / np.sum(slope * slope))
        more = float(np.clip(more, -step, step))
        if not abs(shift + more) <= farthest or abs(more) <= EPS * duration:
            break
        shift += more
    left, slope = _residual(found, of, shift, first)
    # What is left moves the fit as well: four standard errors of it.
    spread = 4.0 * float(np.sqrt(np.mean(left * left) / np.sum(slope * slope)))
    attitude = _attitude_left(found, shift, first)
    largest, after = float(np.max(norm(before))), float(np.max(norm(left)))
    open_shift = limit / change + spread
    return Shift(of, shift, open_shift, largest, after, limit, left, attitude, first)


def _attitude_left(found: Measured, shift: float, first: int) -> float | None:
    """Rad, the largest attitude error that a shift leaves."""
    orientation, times = found.trace.orientation, found.trace.times[first:] + shift
    if orientation is None:
        return None
    inside = times >= 0.0
    exact = found.trajectory(times[inside]).orientation
    return float(np.max(attitude_angle(exact, normalize(orientation[first:][inside]))))


def scatter(shift: Shift) -> float | None:
    """The standard deviation of what is left, per axis, if it looks like noise; else None.

    Noise has no memory: the correlation of neighbours is within four standard errors of zero,
    ``4 / sqrt(n)``, and what is left stands above its bound.
    """
    left = shift.left
    if len(left) < 32 or shift.after <= shift.bound:
        return None
    total = float(np.sum(left * left))
    memory = float(np.sum(left[1:] * left[:-1])) / total
    if abs(memory) > 4.0 / np.sqrt(left.size):
        return None
    return float(np.sqrt(total / left.size))
