"""What is fitted, in the units of the fit, and its vector for the solver.

In these units the trace's root-mean-square omega is 1 rad per unit of time, and the trace of the
inertia is 2 unless a torque gives it a scale. Every number is then of the order of one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product
from omegadot.reference_impl.system import Array

LOWER = np.tril_indices(3)


def _symmetric() -> Array:
    """(6, 3, 3), an orthonormal basis: the size first, then the five of no trace."""
    one, half, sixth = 1.0 / np.sqrt(3.0), np.sqrt(0.5), 1.0 / np.sqrt(6.0)
    basis = np.zeros((6, 3, 3))
    basis[0] = one * np.eye(3)
    basis[1] = np.diag([half, -half, 0.0])
    basis[2] = np.diag([sixth, sixth, -2.0 * sixth])
    for k, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)), 3):
        basis[k, i, j] = basis[k, j, i] = half
    return basis


SYMMETRIC = _symmetric()


@dataclass(frozen=True)
class Parameters:
    """A motion to compare with a trace. Leading axes are lanes, of all fields alike.

    inertia: (..., 3, 3).  omega: (..., 3), at the first sample.  bias: (..., 3), added to omega by
    the gyro.  damping: (...), of the torque ``-damping * omega``.  orientation: (..., 4), at the
    first sample.
    """

    inertia: Array
    omega: Array
    bias: Array
    damping: Array
    orientation: Array


@dataclass(frozen=True)
class Free:
    """Which parameters are fitted besides the first omega.

    shape: ratios and axes of the inertia.  scale: its size, where a torque is known.
    """

    shape: bool = True
    scale: bool = False
    bias: bool = False
    damping: bool = False
    orientation: bool = False

    def directions(self, inertia: Array) -> Array:
        """(k, 3, 3): along which the inertia is fitted."""
        if self.shape:
            return SYMMETRIC if self.scale else SYMMETRIC[1:]
        return inertia[None][: int(self.scale)]

    @property
    def tail(self) -> int:
        """How many numbers come after the inertia and omega."""
        return 3 * self.bias + self.damping + 3 * self.orientation

    @property
    def count(self) -> int:
        """How many numbers are fitted."""
        return 3 + 5 * self.shape + self.scale + self.tail


def second_moments(inertia: Array) -> Array:
    """``G = tr(I)/2 1 - I``, the integral of ``r r^T dm``: of any body positive semidefinite."""
    half = 0.5 * np.trace(inertia, axis1=-2, axis2=-1)
    return np.asarray(half[..., None, None] * np.eye(3) - inertia)


def inertia_of(moments: Array) -> Array:
    """``I = tr(G) 1 - G``."""
    whole = np.trace(moments, axis1=-2, axis2=-1)
    return np.asarray(whole[..., None, None] * np.eye(3) - moments)


def inside(inertia: Array, least: float) -> Array:
    """The nearest inertia of which each second moment is at least so much of their sum."""
    values, axes = np.linalg.eigh(second_moments(inertia))
    whole = float(np.sum(np.maximum(values, 0.0))) or 1.0
    return inertia_of(axes @ np.diag(np.maximum(values, least * whole)) @ axes.T)


def tail_of(one: Parameters, free: Free) -> Array:
    """The vector of what comes after the inertia: omega, then what is free; a turn of zero."""
    parts = [one.omega]
    parts += [one.bias] if free.bias else []
    parts += [np.atleast_1d(one.damping)] if free.damping else []
    parts += [np.zeros(3)] if free.orientation else []
    return np.concatenate(parts)


def moved(one: Parameters, steps: Array, free: Free) -> Parameters:
    """(k, m) lanes: `one` moved along the directions of the inertia and the other parameters.

    Linear in the inertia, so that least squares go straight; but it may leave what bodies can be.
    """
    directions = free.directions(one.inertia)
    head = len(directions)
    inertia = one.inertia + np.tensordot(steps[..., :head], directions, 1)
    return _tail(replace(one, inertia=inertia), steps[..., head:] + tail_of(one, free), free)


def factor_of(one: Parameters, free: Free) -> Array:
    """The vector of a body's factor, ``G = L L^T``, and of what comes after."""
    factor = np.linalg.cholesky(second_moments(one.inertia))
    return np.concatenate([factor[LOWER], tail_of(one, free)])


def factored(one: Parameters, vectors: Array, free: Free) -> Parameters:
    """(k, m) lanes from such vectors. Any factor gives a body that can exist.

    Without a scale, factors of any size give one inertia, of trace 2.
    """
    factor = np.zeros((*vectors.shape[:-1], 3, 3))
    factor[..., LOWER[0], LOWER[1]] = vectors[..., :6]
    second = factor @ np.swapaxes(factor, -1, -2)
    if not free.scale:
        second = second / np.trace(second, axis1=-2, axis2=-1)[..., None, None]
    return _tail(replace(one, inertia=inertia_of(second)), vectors[..., 6:], free)


def _tail(base: Parameters, others: Array, free: Free) -> Parameters:
    """`base` with omega, and what is free of bias, damping and a turn of its orientation."""
    lanes, at = others.shape[:-1], 3
    bias, damping, orientation = base.bias, base.damping, base.orientation
    if free.bias:
        bias, at = others[..., at : at + 3], at + 3
    if free.damping:
        damping, at = others[..., at], at + 1
    if free.orientation:
        turn = exp_quaternion(others[..., at : at + 3])
        orientation = quaternion_product(np.broadcast_to(orientation, turn.shape), turn)
    return Parameters(
        base.inertia,
        others[..., :3],
        np.broadcast_to(bias, (*lanes, 3)),
        np.broadcast_to(damping, lanes),
        np.broadcast_to(orientation, (*lanes, 4)),
    )
