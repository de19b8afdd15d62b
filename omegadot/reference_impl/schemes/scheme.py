"""What a scheme is: one way of taking a step, and how fast its errors shrink with the step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypedDict

import numpy as np

from omegadot.reference_impl.coordinates import Coordinates, canonical
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.system import Array, System

IN_WORLD: tuple[Coordinates, ...] = ("com-world", "origin-world")


# The q and v after one step of h s, a float, or (..., 1) with a step a lane.
Step = Callable[[Motion, Array, Array, float | Array], tuple[Array, Array]]


@dataclass(frozen=True)
class FormulaChange:
    """turn: rad, of a step, at which its formula changes.  jump: rad, what the two differ by there.

    Where a turn is that to rounding, either formula is the scheme's.
    """

    turn: float
    jump: float


@dataclass(frozen=True)
class Scheme:
    """A named scheme.

    orders: order of the accumulated error per channel, whatever loads act; smooth motion.
    special: where a simpler system does better, per kind of system (see `kinds_of`); None stands
    for a channel without truncation error, in which only rounding is left.
    solved_to: relative residual at which engines stop solving the step's equation; 0 at rounding.
    solved_torque: N m, the residual torque at which they stop in any case.
    coordinates: those of one body in which it can be stepped.
    change: of the formula of its turn, where it has two.
    """

    name: str
    title: str
    step: Step
    orders: dict[str, int]
    special: Mapping[str, Mapping[str, int | None]] = field(default_factory=dict)
    source: str = ""
    solved_to: float = 0.0
    solved_torque: float = 0.0
    coordinates: tuple[Coordinates, ...] = (*IN_WORLD, "body-spatial")
    change: FormulaChange | None = None

    def order(
        self, channel: str, system: System, coordinates: Coordinates = "com-world"
    ) -> int | None:
        """The declared order of a channel for this system; None where only rounding is left.

        Where translation is stepped in other coordinates than those of the centre of mass in the
        world, rotation takes part in it, and the scheme's general orders hold for it.
        """
        found: int | None = self.orders[channel]
        if channel in TRANSLATION and canonical(system, coordinates) != "com-world":
            return found
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
TRANSLATION = ("energy", "linear_momentum", "position")


def every_channel(order: int) -> dict[str, int]:
    """The same order in every channel."""
    return dict.fromkeys(CHANNELS, order)


class Orders(TypedDict):
    """Of a scheme: the arguments of `Scheme` that declare orders."""

    orders: dict[str, int]
    special: Mapping[str, Mapping[str, int | None]]


def explicit(order: int) -> Orders:
    """Of an explicit Runge-Kutta method: free fall is exact from order 2 on."""
    exact = {"linear_momentum": None, "position": None} if order > 1 else {"linear_momentum": None}
    return {"orders": every_channel(order), "special": {"free": exact}}
