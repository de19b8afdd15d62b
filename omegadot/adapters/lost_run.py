"""Runs of engines in single precision from states that it cannot hold."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.system import State


def is_finite(state: State) -> bool:
    """Whether a state is finite in single precision."""
    with np.errstate(over="ignore"):
        return all(np.all(np.isfinite(np.float32(part))) for part in vars(state).values())


def lost(initial: State, samples: int) -> State:
    """A state that the engine cannot take, and NaN after it."""
    parts = []
    for part in vars(initial).values():
        rows = np.full((samples, len(part)), np.nan)
        rows[0] = part
        parts.append(rows)
    return State(*parts)
