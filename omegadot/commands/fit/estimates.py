"""The numbers of a fit with their standard errors, in SI units and in the scale that is known."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from omegadot.commands.fit.scale import Scale
from omegadot.commands.fit.spread import Spread
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array

# A standard error above this means that the data determine nothing.
MOST_MOMENT = 0.25  # of the largest moment: all that bodies have is within 0 and 1
MOST_TURN = 0.35  # rad, of an axis: a quarter of a right angle
MOST_SIZE = 0.5  # relative, of the inertia where a torque is given
TINY = 1e-300
SET = 64.0 * float(np.finfo(float).eps)  # relative: a number with such an error is set, not fitted
MOST_OMEGA = 0.25  # of the size of omega, which its first value and a bias lie within
MOST_DAMPING = 0.25  # of the largest moment times the size of omega


@dataclass(frozen=True, eq=False)
class Estimates:
    """What was fitted, and standard errors.

    inertia: (3, 3), in the trace's body axes.  moments: (3,), the principal ones, each next to the
    body axis that its own is nearest to.  axes: (3, 3), their axes as columns.
    axis_errors: (3,) rad, of the direction of each.
    omega: (3,) rad/s at the first sample, of the body.  reading: the same with the bias, as the
    gyro gives it.  bias: (3,) rad/s.  damping: N m s/rad, or in the inertia's unit over s.
    orientation: (4,), and its errors (3,) rad about the body's axes.
    size_known: whether a torque that is given shows in omega.  size: rad/s, of omega.
    """

    inertia: Array
    inertia_errors: Array
    moments: Array
    moment_errors: Array
    axes: Array
    axis_errors: Array
    omega: Array
    omega_errors: Array
    reading: Array
    reading_errors: Array
    bias: Array
    bias_errors: Array
    damping: float
    damping_error: float
    orientation: Array | None
    orientation_errors: Array | None
    size_known: bool
    size: float

    @property
    def moments_known(self) -> NDArray[np.bool_]:
        """(3,): whether the data determine each moment."""
        return self.size_known & np.less(self.moment_errors, MOST_MOMENT * np.max(self.moments))

    @property
    def shape_known(self) -> bool:
        """Whether any moment is determined that is not set."""
        fitted = self.moment_errors > SET * self.moments
        return bool(np.any(self.moments_known & fitted))

    @property
    def axes_known(self) -> NDArray[np.bool_]:
        """(3,): whether the data determine each principal axis."""
        return np.less(self.axis_errors, MOST_TURN)

    @property
    def omega_known(self) -> NDArray[np.bool_]:
        """(3,): whether the data determine each component of the body's first omega."""
        return np.less(self.omega_errors, MOST_OMEGA * self.size)

    @property
    def bias_known(self) -> NDArray[np.bool_]:
        """(3,): whether the data determine each component of the bias."""
        return np.less(self.bias_errors, MOST_OMEGA * self.size)

    @property
    def damping_known(self) -> bool:
        """Whether the data determine the damping."""
        most = MOST_DAMPING * float(np.max(self.moments)) * self.size
        return self.damping_error < most and (self.size_known or self.damping_error == 0.0)


def estimates_of(spread: Spread, scale: Scale, size: float, spin: Array | None) -> Estimates:
    """The numbers of a fit. size: rad/s, the unit of omega.  spin: as of `scale_of`."""
    one, free = spread.one, spread.free
    tensor, tensor_slopes = _tensor(spread, scale)
    moments, axes = principal(one.inertia)
    moment_slopes = np.stack([_entry(spread, scale, axis, axis) for axis in axes.T])
    turns = _turns(spread, moments, axes)
    errors = spread.error(moment_slopes)
    damping = scale.factor * size * float(one.damping)
    damping_error = 0.0
    if free.damping:
        slopes = scale.factor * spread.slopes_of("damping")[0] + float(one.damping) * scale.slopes
        damping_error = size * float(spread.error(slopes))
    still = np.zeros(3)
    both = spread.slopes_of("omega")
    if free.bias:
        both = both + spread.slopes_of("bias")
    about = np.eye(3) if spin is None else spin[None]
    size_slopes = np.sum([spread.slope_of_entry(axis, axis) for axis in about], axis=0)
    whole = float(np.sum([axis @ one.inertia @ axis for axis in about]))
    size_error = float(spread.error(size_slopes)) / whole
    return Estimates(
        inertia=tensor,
        inertia_errors=spread.error(tensor_slopes),
        moments=scale.factor * moments,
        moment_errors=errors,
        axes=axes,
        axis_errors=turns,
        omega=size * one.omega,
        omega_errors=size * spread.error(spread.slopes_of("omega")),
        reading=size * (one.omega + one.bias),
        reading_errors=size * spread.error(both),
        bias=size * one.bias,
        bias_errors=size * spread.error(spread.slopes_of("bias")) if free.bias else still,
        damping=damping,
        damping_error=damping_error,
        orientation=one.orientation if free.orientation else None,
        orientation_errors=(
            spread.error(spread.slopes_of("orientation")) if free.orientation else None
        ),
        size_known=not free.scale or size_error < MOST_SIZE,
        size=size,
    )


def widened(own: Estimates, others: list[Estimates]) -> Estimates:
    """The same numbers, with errors that hold whichever of the fits is the truth.

    ``e^2 = max_k (e_k^2 + (x_k - x)^2)`` over the fits k that the data allow.
    """
    found = own
    for other in others:
        same = linear_sum_assignment(-np.abs(own.axes.T @ other.axes))[1]
        sines = np.linalg.norm(cross(own.axes.T, other.axes.T[same]), axis=1)
        turns = np.arcsin(np.minimum(sines, 1.0))
        apart = {
            "inertia_errors": (other.inertia_errors, other.inertia - own.inertia),
            "moment_errors": (other.moment_errors[same], other.moments[same] - own.moments),
            "axis_errors": (other.axis_errors[same], turns),
            "omega_errors": (other.omega_errors, other.omega - own.omega),
            "reading_errors": (other.reading_errors, other.reading - own.reading),
            "bias_errors": (other.bias_errors, other.bias - own.bias),
            "damping_error": (other.damping_error, other.damping - own.damping),
        }
        if own.orientation is not None and other.orientation is not None:
            turn = rotation_between(own.orientation, other.orientation)
            apart["orientation_errors"] = (other.orientation_errors, turn)
        wider: dict[str, Any] = {
            name: np.maximum(getattr(found, name), np.hypot(error, difference))
            for name, (error, difference) in apart.items()
        }
        found = replace(found, **wider, size_known=found.size_known and other.size_known)
    return replace(found, damping_error=float(found.damping_error))


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


def open_directions(spreads: list[Spread]) -> list[Array]:
    """Of the bias: unit vectors along which the data do not determine it.

    spreads: of the fits that the data allow, the one that is reported first.
    """
    squares = []
    for spread in spreads:
        block, apart = spread.places("bias"), spread.one.bias - spreads[0].one.bias
        squares.append(spread.covariance[block, block] + np.outer(apart, apart))
    values, axes = np.linalg.eigh(max(squares, key=lambda square: float(np.trace(square))))
    return [axes[:, k] for k in range(len(values)) if values[k] > MOST_OMEGA**2]
