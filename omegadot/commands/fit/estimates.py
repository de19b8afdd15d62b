"""The numbers of a fit with their standard errors, in SI units and in the scale that is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from omegadot.commands.fit.scale import Scale
from omegadot.commands.fit.spread import Spread
from omegadot.reference_impl.system import Array

# A standard error above this means that the data determine nothing.
MOST_MOMENT = 0.25  # of the largest moment: all that bodies have is within 0 and 1
MOST_TURN = 0.35  # rad, of an axis: a quarter of a right angle
MOST_SIZE = 0.5  # relative, of the inertia where a torque is given
TINY = 1e-300
MOST_BIAS = 0.5  # of the size of omega
MOST_DAMPING = 0.5  # of the largest moment times the size of omega


@dataclass(frozen=True, eq=False)
class Estimates:
    """What was fitted, and standard errors.

    inertia: (3, 3), in the trace's body axes.  moments: (3,), the principal ones, each next to the
    body axis that its own is nearest to.  axes: (3, 3), their axes as columns.
    axis_errors: (3,) rad, of the direction of each.
    omega: (3,) rad/s at the first sample, of the body.  bias: (3,) rad/s.  damping: N m s/rad, or
    in the inertia's unit over s.  orientation: (4,), and its errors (3,) rad about the body's axes.
    size_known: whether a torque that is given shows in omega.
    """

    inertia: Array
    inertia_errors: Array
    moments: Array
    moment_errors: Array
    axes: Array
    axis_errors: Array
    omega: Array
    omega_errors: Array
    bias: Array
    bias_errors: Array
    damping: float
    damping_error: float
    orientation: Array | None
    orientation_errors: Array | None
    size_known: bool

    @property
    def moments_known(self) -> NDArray[np.bool_]:
        """(3,): whether the data determine each moment."""
        return self.size_known & np.less(self.moment_errors, MOST_MOMENT * np.max(self.moments))

    @property
    def axes_known(self) -> NDArray[np.bool_]:
        """(3,): whether the data determine each principal axis."""
        return np.less(self.axis_errors, MOST_TURN)


def estimates_of(spread: Spread, scale: Scale, size: float) -> Estimates:
    """The numbers of a fit. size: rad/s, the unit of omega."""
    one, free = spread.one, spread.free
    tensor, tensor_slopes = _tensor(spread, scale)
    moments, axes = principal(one.inertia)
    moment_slopes = np.stack([_entry(spread, scale, axis, axis) for axis in axes.T])
    turns = _turns(spread, moments, axes)
    errors = spread.error(moment_slopes)
    if not free.shape:
        errors, turns = np.full(3, np.nan), np.full(3, np.nan)
    damping = scale.factor * size * float(one.damping)
    damping_error = 0.0
    if free.damping:
        slopes = scale.factor * spread.slopes_of("damping")[0] + float(one.damping) * scale.slopes
        damping_error = size * float(spread.error(slopes))
    still = np.zeros(3)
    size_slopes = sum(spread.slope_of_entry(axis, axis) for axis in np.eye(3))
    size_error = float(spread.error(np.asarray(size_slopes))) / float(np.trace(one.inertia))
    return Estimates(
        inertia=tensor,
        inertia_errors=spread.error(tensor_slopes),
        moments=scale.factor * moments,
        moment_errors=errors,
        axes=axes,
        axis_errors=turns,
        omega=size * one.omega,
        omega_errors=size * spread.error(spread.slopes_of("omega")),
        bias=size * one.bias,
        bias_errors=size * spread.error(spread.slopes_of("bias")) if free.bias else still,
        damping=damping,
        damping_error=damping_error,
        orientation=one.orientation if free.orientation else None,
        orientation_errors=(
            spread.error(spread.slopes_of("orientation")) if free.orientation else None
        ),
        size_known=not free.scale or size_error < MOST_SIZE,
    )


def principal(inertia: Array) -> tuple[Array, Array]:
    """Moments (3,) and axes as columns (3, 3), right-handed, each by the axis it is nearest to."""
    moments, axes = np.linalg.eigh(inertia)
    order = linear_sum_assignment(-np.abs(axes))[1]
    moments, axes = moments[order], axes[:, order]
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] *= -1.0
    return moments, axes


def _entry(spread: Spread, scale: Scale, left: Array, right: Array) -> Array:
    """(m,): the slopes of ``left . I right`` in the scale that is reported."""
    value = left @ spread.one.inertia @ right
    return np.asarray(scale.factor * spread.slope_of_entry(left, right) + value * scale.slopes)


def _tensor(spread: Spread, scale: Scale) -> tuple[Array, Array]:
    """The tensor (3, 3), and its slopes (3, 3, m)."""
    unit = np.eye(3)
    slopes = [[_entry(spread, scale, a, b) for b in unit] for a in unit]
    return scale.factor * spread.one.inertia, np.array(slopes)


def _turns(spread: Spread, moments: Array, axes: Array) -> Array:
    """(3,) rad: the standard errors of the directions of the principal axes.

    A change dI turns the axes i and j by ``e_i . dI e_j / (m_j - m_i)`` in their plane.
    """
    squares = np.zeros(3)
    for i, j in ((1, 2), (2, 0), (0, 1)):
        moved = float(spread.error(spread.slope_of_entry(axes[:, i], axes[:, j])))
        turn = moved / max(abs(moments[j] - moments[i]), TINY)
        squares[[i, j]] += min(turn, np.pi) ** 2
    return np.sqrt(squares)


def open_directions(spread: Spread) -> list[Array]:
    """Of the bias: unit vectors along which the data do not determine it."""
    block = spread.places("bias")
    values, axes = np.linalg.eigh(spread.covariance[block, block])
    return [axes[:, k] for k in range(len(values)) if values[k] > MOST_BIAS**2]
