"""What sets the states apart at which an engine is wrong from those at which it is sound."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.scales import norm
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import State

# So many states on either side at least: the odds that chance sorts them are then below 1 in 20.
LEAST = 3


def only_where(states: State, sound: NDArray[np.bool_]) -> str:
    """The condition that holds at every wrong state and at no sound one; "" where none does."""
    if np.count_nonzero(sound) < LEAST or np.count_nonzero(~sound) < LEAST:
        return ""
    w, q = states.angular_velocity, normalize(states.orientation)
    turned = 2.0 * np.arccos(np.clip(np.abs(q[:, 0]), 0.0, 1.0))
    features = {"|omega|": (norm(w), "rad/s"), "the angle from the identity": (turned, "rad")}
    features |= {f"omega_{axis}": (w[:, k], "rad/s") for k, axis in enumerate("xyz")}
    for text, (values, unit) in features.items():
        low, high = values[sound], values[~sound]
        for term, a, b in (("above", low, high), ("below", high, low)):
            if np.max(a) < np.min(b):
                between = f"{np.max(a):.4g} to {np.min(b):.4g} {unit}"
                return f"{text} is {term} a limit that lies at {between}"
    return ""
