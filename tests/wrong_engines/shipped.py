"""An engine whose defaults disturb the motion, some more than others, and one without settings."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError, mends
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product
from omegadot.reference_impl.system import Array, Body, State, System

ORDERS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")


class BrakedAdapter:
    """As shipped it has no gyroscopic term, and loses a twentieth of omega a second.

    A third setting does nothing to a free body.
    """

    settings: tuple[str, ...] = ("gyroscopic", "damping", "sleeping")

    def __init__(self, setup: str = "physics") -> None:
        self._gyroscopic = mends(setup, "gyroscopic")
        self._damping = 0.0 if mends(setup, "damping") else 0.05

    @property
    def description(self) -> Description:
        step = Integrator("step", None, dict.fromkeys(ORDERS, 1))
        features = frozenset({"free", "full_inertia"})
        return Description("braked", "1.0", (step,), features=features, settings=self.settings)

    def load(self, system: System) -> None:
        load = system.load
        loads = (load.gravity, load.torque_body, load.torque_world)
        if load.pivot is not None or load.damping or np.any(loads):
            raise UnsupportedError("free bodies without loads only")
        self._body = system.body

    def model(self) -> tuple[Body, ...]:
        return (self._body,)

    def set_state(self, state: State) -> None:
        self._state = state

    def get_state(self) -> State:
        return self._state

    def _after(self, w: Array, h: float) -> Array:
        inertia = self._body.inertia
        if self._gyroscopic:
            w = w - h * np.linalg.solve(inertia, np.cross(w, inertia @ w))
        return w * (1.0 - h * self._damping)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        q, w, place = initial.orientation, initial.angular_velocity, initial.position
        kept: list[int] = []
        rows: list[Any] = []
        for step in range(steps + 1):
            if step % every == 0 or step == steps:
                kept.append(step)
                now = place + step * timestep * initial.linear_velocity
                rows.append((q, w, now, initial.linear_velocity))
            w = self._after(w, timestep)
            q = quaternion_product(q, exp_quaternion(timestep * w))
        columns = zip(*rows, strict=True)
        return Trajectory(timestep * np.array(kept), State(*map(np.array, columns)))


class PlainAdapter(BrakedAdapter):
    """It knows the two setups alone, and steps alike in both."""

    settings = ()

    def __init__(self, setup: str = "physics") -> None:
        assert setup in ("physics", "as-shipped")
        super().__init__("physics")

    @property
    def description(self) -> Description:
        return replace(super().description, name="plain")
