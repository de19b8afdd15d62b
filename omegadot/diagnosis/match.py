"""Whether an engine's accelerations are those of a candidate equation, and at which states."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.equation import BOUND
from omegadot.gates.scales import BodyScale, body_scale, linear_size, norm, torque_size
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Acceleration, Array, State, System

# So many states on either side at least: the odds that chance sorts them are then below 1 in 20.
LEAST = 3


class Match:
    """Whether accelerations at given states are the engine's, within the gate's own bounds."""

    def __init__(self, system: System, states: State, found: Acceleration) -> None:
        self.system, self.states, self.found = system, states, found
        self.true = forward_dynamics(system, states)
        self.angular_bound, self.linear_bound = self._bounds(self.true)

    def _bounds(self, acceleration: Acceleration) -> tuple[Array, Array]:
        """(n,) rad/s^2 and m/s^2: what rounding may make of accelerations of this size."""
        scale: BodyScale = body_scale(self.system)
        angular = torque_size(self.system, self.states, acceleration) / scale.smallest
        return BOUND * angular, BOUND * linear_size(self.system, self.states, acceleration)

    @property
    def sound(self) -> NDArray[np.bool_]:
        """(n,): the states at which the engine's acceleration is the true one."""
        angular = norm(self.found.angular - self.true.angular) <= self.angular_bound
        linear = norm(self.found.linear - self.true.linear) <= self.linear_bound
        return np.asarray(angular & linear)

    def fits(self, candidate: Acceleration, slack: float = 1.0) -> bool:
        """Within `slack` times the bounds. A candidate's own terms may be larger: they count."""
        angular = norm(self.found.angular - candidate.angular)
        linear = norm(self.found.linear - candidate.linear)
        own_angular, own_linear = self._bounds(candidate)
        return bool(
            np.all(angular <= slack * np.maximum(self.angular_bound, own_angular))
            and np.all(linear <= slack * np.maximum(self.linear_bound, own_linear))
        )


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
