"""Gate 1, model: the engine holds the body and the state that it was given."""

from __future__ import annotations

import numpy as np

from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_OF_A_READER,
    ROUNDINGS_PER_EVALUATION,
    body_scale,
    norm,
)
from omegadot.gates.case import Case
from omegadot.gates.rows import Row, within
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import Array, Body, State

GATE = "model"
# Reading a number back takes at most a change of frame there and back.
ROUNDINGS = 32


def _largest(values: Array) -> float:
    return float(np.max(np.abs(values)))


def _spectral_norm(matrix: Array) -> float:
    # Where an entry is NaN or infinite the singular values are not found; it is no number then.
    return float(np.linalg.norm(matrix, 2)) if np.all(np.isfinite(matrix)) else float("nan")


def body_rows(case: Case, body: Body, eps: float = EPS) -> list[Row]:
    """Mass, centre of mass and inertia read back, against what was requested.

    The inertia's bound counts an eigendecomposition and its inverse, at the size of the tensor.
    """
    requested, scale = case.system.body, body_scale(case.system)
    mass = abs(float(body.mass) - scale.mass) / scale.mass
    offset = float(norm(np.asarray(body.center_of_mass) - requested.center_of_mass))
    size = _spectral_norm(requested.inertia)
    inertia = _spectral_norm(np.asarray(body.inertia) - requested.inertia) / size
    return [
        within(GATE, "model", "mass", mass, "1", ROUNDINGS * eps),
        within(GATE, "model", "center_of_mass", offset, "m", ROUNDINGS * eps * scale.lever),
        within(GATE, "model", "inertia", inertia, "1", ROUNDINGS_PER_EVALUATION * eps),
    ]


def of_read_body(row: Row) -> Row:
    """A row of an engine that has read the body from a file: the tensor's rounding adds to it.

    An error of the tensor, relative to its size, is one of the torques relative to their terms, and
    so of omega-dot, whose bound has the condition number already.
    """
    if row.bound is None or row.metric in ("mass", "center_of_mass", "state"):
        return row
    bound = row.bound * (1.0 + ROUNDINGS_OF_A_READER / ROUNDINGS_PER_EVALUATION)
    return within(row.gate, row.channel, row.metric, row.value, row.unit, bound, row.note)


def state_rows(case: Case, requested: State, back: State, eps: float = EPS) -> list[Row]:
    """A state after a round trip through the engine, against what went in."""
    lever = body_scale(case.system).lever
    rate, reach = norm(requested.angular_velocity), norm(requested.position) + lever
    speed = norm(requested.linear_velocity) + rate * lever
    # The angle is blind to a quaternion's length, which is an error of its own.
    length = np.abs(norm(back.orientation) - 1.0)
    turn = np.maximum(attitude_angle(requested.orientation, back.orientation), length)
    values = {
        "attitude": (turn, "rad", np.ones_like(turn)),
        "omega": (norm(back.angular_velocity - requested.angular_velocity), "rad/s", rate),
        "position": (norm(back.position - requested.position), "m", reach),
        "linear_momentum": (norm(back.linear_velocity - requested.linear_velocity), "m/s", speed),
    }
    return [
        within(GATE, channel, "state", _largest(value), unit, ROUNDINGS * eps * _largest(size))
        for channel, (value, unit, size) in values.items()
    ]
