"""What a scheme is: one way of taking a step, and how fast its errors shrink with the step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from omegadot.reference_impl.system import Acceleration, Array, State, System

AccelerationOf = Callable[[State], Acceleration]
"""Accelerations of a state under all loads, the reference's or an engine's.

It must broadcast over leading axes, as everything here does: schemes may ask for several states
at once.
"""


class Step(Protocol):
    """How a scheme is called."""

    def __call__(self, acceleration: AccelerationOf, state: State, dt: float | Array) -> State:
        """One step of `dt` s, a float or an array that broadcasts over the state's lanes."""
        ...


@dataclass(frozen=True)
class Scheme:
    """A named scheme.

    orders: order of the accumulated error per channel, whatever loads act; smooth motion.
    special: where a simpler system does better, per kind of system (see `kinds_of`); None stands
    for a channel without truncation error, in which only rounding is left.
    solved_to: relative residual at which engines stop solving the step's equation; 0 at rounding.
    """

    name: str
    title: str
    step: Step
    orders: dict[str, int]
    special: Mapping[str, Mapping[str, int | None]] = field(default_factory=dict)
    source: str = ""
    solved_to: float = 0.0

    def order(self, channel: str, system: System) -> int | None:
        """The declared order of a channel for this system; None where only rounding is left."""
        found: int | None = self.orders[channel]
        for kind in kinds_of(system):
            found = self.special.get(kind, {}).get(channel, found)
        return found


def kinds_of(system: System) -> tuple[str, ...]:
    """The kinds a system belongs to, the more special later.

    ``free``: no pivot, so the centre of mass falls freely.  ``decoupled``: the torque does not
    depend on the attitude, so omega runs by itself.  ``torque-free``: free and no torque at all,
    so energy and angular momentum are constant.
    """
    load = system.load
    free = load.pivot is None
    decoupled = not np.any(load.torque_world) and (free or not np.any(load.gravity))
    loaded = np.any(load.torque_body) or np.any(load.damping)
    kinds = (("free", free), ("decoupled", decoupled), ("torque-free", decoupled and not loaded))
    return tuple(kind for kind, holds in kinds if holds)


CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")


def every_channel(order: int) -> dict[str, int]:
    """The same order in every channel."""
    return dict.fromkeys(CHANNELS, order)


def per_component(dt: float | Array) -> float | Array:
    """The step, shaped to multiply vectors: (lanes,) becomes (lanes, 1), a float stays one."""
    return dt if isinstance(dt, float) else np.asarray(dt)[..., None]
