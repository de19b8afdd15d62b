"""Where the least squares start: the balance of angular momentum, linear in what is sought.

``I w' + w x (I w) + d w = torque``, integrated between pairs of samples, is linear in the six
entries of I and in d. With ``w = y - b``, of a gyro's reading y and its bias b, it is

    I dy + int y x (I y) dt + N int y dt + c dt = torque dt,
    N = d 1 - [b] I + [I b],   c = b x (I b) - d b,

linear in I, N and c, and b and d follow from N. Nothing is differentiated: readings are
interpolated and integrated, so that their noise averages out.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from omegadot.commands.fit.data import Data
from omegadot.commands.fit.parameters import (
    SYMMETRIC,
    Free,
    Parameters,
    inertia_of,
    inside,
)
from omegadot.reference_impl.cross_product import cross, skew
from omegadot.reference_impl.system import Array

TURNS = (0.3, 1.0, 2.5)  # rad between the two samples of a pair: short for fast, long for noise
MOST_PAIRS = 4000
LEAST = 0.02  # the least second moment of a start, of their sum: well inside what bodies can be
# Second moments of bodies to start from where the balance misleads: along each axis the longest.
SHAPES = ((1.0, 1.0, 1.0), (9.0, 3.0, 1.0), (1.0, 9.0, 3.0), (3.0, 1.0, 9.0))


def starts(data: Data, free: Free) -> list[Parameters]:
    """Every start: of the balance over short and long pairs, and a few bodies of all kinds."""
    found = []
    if free.shape and len(data.times) >= 4:
        for turn in TURNS:
            rows = _integrals(data, turn)
            found += [_plain(data, rows, free)] + ([_biased(data, rows)] if free.bias else [])
    zero = np.zeros(3)
    size = _size(data)
    for shape in SHAPES if free.shape else SHAPES[:1]:
        second = np.diag(shape) / sum(shape)
        found.append(_start(data, size * inertia_of(second), zero, 0.0))
    return found


def sized(data: Data) -> Data:
    """With the torque in a unit that makes the trace of the inertia about 2."""
    if not np.any(data.torque):
        return data
    start = starts(data, Free(scale=True))[1]
    return replace(data, torque=2.0 * data.torque / np.trace(start.inertia))


def _start(data: Data, inertia: Array, bias: Array, damping: float) -> Parameters:
    turned = np.array([1.0, 0.0, 0.0, 0.0]) if data.orientation is None else data.orientation[0]
    return Parameters(inertia, data.omega[0] - bias, bias, np.array(damping), turned)


def _size(data: Data) -> float:
    """With a torque, the inertia that it would accelerate as the trace shows; 1 without."""
    if not np.any(data.torque):
        return 1.0
    change = float(np.linalg.norm(data.omega[-1] - data.omega[0]))
    return float(np.linalg.norm(data.torque) * data.times[-1] / max(change, 1e-3))


def _integrals(data: Data, turn: float) -> tuple[Array, Array, Array]:
    """Of pairs of samples: columns of I (m, 3, 6), the integral of y (m, 3) and times (m,)."""
    y, turned = data.omega, data.turned
    apart = max(1, round(turn * (len(y) - 1) / max(turned[-1], turn)))
    first = np.arange(0, len(y) - apart, max(1, (len(y) - apart) // MOST_PAIRS))
    tensors = SYMMETRIC @ y[:, None, :, None]
    gyroscopic = cross(y[:, None], tensors[..., 0])  # (n, 6, 3)
    curves = np.concatenate([gyroscopic.reshape(len(y), 18), y], 1)
    whole = CubicSpline(data.times, curves).antiderivative()(data.times)
    change = whole[first + apart] - whole[first]
    dy = y[first + apart] - y[first]
    columns = (SYMMETRIC @ dy[:, None, :, None])[..., 0] + change[:, :18].reshape(-1, 6, 3)
    times = data.times[first + apart] - data.times[first]
    return np.swapaxes(columns, 1, 2), change[:, 18:], times


def _plain(data: Data, rows: tuple[Array, Array, Array], free: Free) -> Parameters:
    """Without a bias."""
    columns, turned, times = rows
    parts = [columns.reshape(-1, 6)] + ([turned.reshape(-1, 1)] if free.damping else [])
    found = _linear(np.hstack(parts), times, data.torque)
    damping = float(found[6]) if free.damping else 0.0
    return _start(data, inside(_tensor(found), LEAST), np.zeros(3), damping)


def _biased(data: Data, rows: tuple[Array, Array, Array]) -> Parameters:
    """With a bias and damping."""
    columns, turned, times = rows
    products = np.zeros((len(turned), 3, 9))
    for i in range(3):
        products[:, i, 3 * i : 3 * i + 3] = turned
    constant = times[:, None, None] * np.eye(3)
    whole = np.concatenate([columns, products, constant], 2).reshape(-1, 18)
    found = _linear(whole, times, data.torque)
    inertia = _tensor(found)
    mixed = found[6:15]
    unit = np.eye(3)
    of_bias = [skew(inertia @ axis) - skew(axis) @ inertia for axis in unit]
    matrix = np.stack([part.ravel() for part in (*of_bias, unit)], 1)
    solved = np.linalg.lstsq(matrix, mixed, rcond=1e-6)[0]
    return _start(data, inside(inertia, LEAST), solved[:3], float(solved[3]))


def _linear(matrix: Array, times: Array, torque: Array) -> Array:
    """The least squares; without a torque the unit vector that the balance keeps smallest.

    It is scaled so that the inertia has the trace 2 then.
    """
    if np.any(torque):
        return np.asarray(np.linalg.lstsq(matrix, np.kron(times, torque), rcond=1e-9)[0])
    vector = np.linalg.eigh(matrix.T @ matrix)[1][:, 0]
    trace = np.trace(_tensor(vector))
    return np.asarray(2.0 * vector / trace if abs(trace) > 1e-6 else vector)


def _tensor(entries: Array) -> Array:
    return np.asarray(np.tensordot(entries[:6], SYMMETRIC, 1))
