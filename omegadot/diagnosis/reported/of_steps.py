"""What is logged of a quantity as a recursion of what is stepped: turned, mixed, or filtered.

A filter of the first order, ``r_k = a r_(k-1) + (1 - a) x_k`` at every step, has the time constant
``-h / ln a``: it is the same at every step and on every scenario, or else ``a`` is.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

SLACK = 4.0
MOST_TRIES, GRID = 12, 2.0 ** np.arange(-6.0, 9.0)  # steps in a time constant
NEAR = 1e-6  # a share that is none, or all
DIGITS = 4  # of a time constant
Way = tuple[str, Array, float]  # a cause, what it makes of the quantity, the bounds allowed


def ways_of_steps(reported: ReportedRun, every: State, name: str, what: str) -> Iterator[Way]:
    """Each way, with what it makes of a quantity. every: all steps of the right run."""
    numbers, due, came = (
        reported.sweep.sample_steps,
        getattr(every, name),
        getattr(reported.state, name),
    )
    before = np.maximum(numbers - 1, 0)
    if not (np.isfinite(due).all() and np.isfinite(came).all()):
        return
    if name == "angular_velocity":
        of_world = rotate(every.orientation[numbers], due[numbers])
        turned = rotate_inverse(every.orientation[before], of_world)
        yield f"{what} is reported in the body axes of the step before", turned, SLACK
    share = _share(due, came, numbers)
    if share is not None:
        tau = -reported.sweep.timestep / np.log(share)
        filtered = _filtered(due, share)[numbers]
        text = f"{what} is reported through a low-pass of the first order"
        yield f"{text} with a time constant of {written(tau, DIGITS)} s", filtered, SLACK
        if reported.sweep.every > 1:
            shown = f"that keeps {written(share, DIGITS)} of itself at each step"
            yield f"{text} {shown}", filtered, SLACK
    lines = np.stack([np.ravel(due[numbers[1:]]), np.ravel(due[before[1:]])], axis=-1)
    one, other = np.linalg.lstsq(lines, np.ravel(came[1:]), rcond=None)[0]
    if min(abs(one), abs(other)) > NEAR:
        mixed = np.concatenate((came[:1], one * due[numbers[1:]] + other * due[before[1:]]))
        parts = (number(float(f"{part:.6g}")) for part in (one, other))
        text = " of itself and ".join(parts)
        yield f"{what} is reported as {text} of that of the step before", mixed, SLACK


def _filtered(values: Array, share: float) -> Array:
    """(n, 3): from the first value on, which a filter begins at."""
    from scipy.signal import lfilter  # its import takes longer than all of a command's own

    return np.asarray(
        lfilter([1.0 - share], [1.0, -share], values, axis=0, zi=share * values[:1])[0]
    )


def _share(due: Array, came: Array, numbers: Array) -> float | None:
    """The a of a filter, by Gauss-Newton from the nearest of a few; None where none is found."""
    from scipy.signal import lfilter

    tried = [float(np.exp(-1.0 / steps)) for steps in GRID]
    found = min(tried, key=lambda a: float(np.sum((_filtered(due, a)[numbers] - came) ** 2)))
    best, before = found, np.inf
    for _ in range(MOST_TRIES):
        values = _filtered(due, found)
        off = np.ravel(values[numbers] - came)
        left = float(norm(off))
        if not left < before:
            break
        # the slope is filtered as the values are: d_k = a d_(k-1) + r_(k-1) - x_k
        driven = np.concatenate((0.0 * due[:1], values[:-1] - due[1:]))
        slope = np.ravel(lfilter([1.0], [1.0, -found], driven, axis=0)[numbers])
        size = float(slope @ slope)
        step = float(slope @ off) / size if size > 0.0 else 0.0
        best, before = found, left
        found = min(max(found - step, 0.5 * found), 0.5 * (1.0 + found))
    return best if 0.0 < best < 1.0 and np.isfinite(before) else None
