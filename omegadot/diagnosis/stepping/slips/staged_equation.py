"""A body's accelerations stage by stage, in lanes in each of which some stages are changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.slips.stage_changes import Change
from omegadot.diagnosis.stepping.slips.stage_sets import Source
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

Stage = dict[str, Array]


@dataclass
class Stages:
    """What every slot is in the stages of this step, and what it was in those of the one before.

    plan: by slot and stage, from where which lanes take it.  now and before: by stage.
    """

    system: System
    changes: Sequence[Change]
    before: list[Stage] = field(default_factory=list)
    now: list[Stage] = field(default_factory=list)
    plan: dict[tuple[str, int], dict[Source, NDArray[np.intp]]] = field(init=False)

    def __post_init__(self) -> None:
        lists: dict[tuple[str, int], dict[Source, list[int]]] = {}
        for lane, change in enumerate(self.changes):
            for stage, source in enumerate(change.sources):
                for slot in change.slots if source != 1.0 else ():
                    lists.setdefault((slot, stage), {}).setdefault(source, []).append(lane)
        self.plan = {
            key: {source: np.array(lanes) for source, lanes in one.items()}
            for key, one in lists.items()
        }
        self._cold = np.array([change.cold for change in self.changes])
        self._inertia = moving_inertia(self.system)
        self._back = inverse(self._inertia)

    def begin(self) -> None:
        """A step begins."""
        self.before, self.now = self.now, []

    def rates(self, rate: Array, q: Array, v: Array, size: int) -> tuple[Array, Array]:
        """Of place and velocities, of the next stage, with the changes.

        rate: of place, its last `size` numbers the attitude's.  q and v: the stage's, q unit.
        """
        self.now.append({"q": q[..., -4:], "w": v[..., -3:]})
        acceleration = self._acceleration(v)
        moved = [self._taken("move", rate[..., :-size]), self._taken("turn", rate[..., -size:])]
        return np.concatenate(moved, axis=-1), acceleration

    def _acceleration(self, v: Array) -> Array:
        load, w, pivoted = self.system.load, v[..., -3:], self.system.load.pivot is not None
        old = self._old("gyroscopic at", "w")
        spun = -cross(old, self._turned("spin at", self._inertia, old))
        torque = self._taken("gyroscopic", spun)
        if np.any(load.damping):
            torque = torque + self._taken("damping", -load.damping * self._old("damping at", "w"))
        if np.any(load.torque_body):
            q, at = self.now[-1]["q"], self._old("body at", "q")
            along = load.torque_body + 0.0 * w
            along = along if at is q else rotate_inverse(q, rotate(at, along))
            torque = torque + self._taken("body", along)
        if np.any(load.torque_world):
            couple = rotate_inverse(self._old("couple at", "q"), load.torque_world)
            torque = torque + self._taken("couple", couple)
        if pivoted and np.any(load.gravity):
            torque = torque + self._taken("weight", self._weight())
        angular = self._taken("angular", self._turned("solve at", self._back, torque))
        linear = v[..., :-3] if pivoted else self._taken("linear", load.gravity + 0.0 * w)
        return np.concatenate((linear, angular), axis=-1)

    def _weight(self) -> Array:
        q, arm = self.now[-1]["q"], lever(self.system)
        force = rotate_inverse(self._old("weight at", "q"), weight(self.system))
        held = self._old("lever at", "q")
        return cross(arm if held is q else rotate_inverse(q, rotate(held, arm)), force)

    def _turned(self, slot: str, matrix: Array, vector: Array) -> Array:
        """The product, where the matrix is held in the world at the attitude of another place."""
        q, old = self.now[-1]["q"], self._old(slot, "q")
        found = apply(matrix, vector)
        if old is q:
            return found
        lanes = np.flatnonzero(np.any(old != q, axis=-1))
        q, old = q[lanes], old[lanes]
        there = rotate_inverse(old, rotate(q, vector[lanes]))
        found[lanes] = rotate_inverse(q, rotate(old, apply(matrix, there)))
        return found

    def _old(self, slot: str, kind: str) -> Array:
        """The attitude or omega of this stage, or of that at which a lane takes it."""
        return self._replaced(slot, kind, self.now[-1][kind])

    def _taken(self, slot: str, value: Array) -> Array:
        """A term or rate of this stage, or what a lane has in its place."""
        self.now[-1][slot] = value
        return self._replaced(slot, slot, value)

    def _replaced(self, slot: str, kind: str, value: Array) -> Array:
        sources = self.plan.get((slot, len(self.now) - 1))
        if not sources:
            return value
        found = value.copy()
        for source, lanes in sources.items():
            if isinstance(source, float):
                found[lanes] *= source
                continue
            earlier, stage = source
            if not earlier:
                found[lanes] = self.now[stage][kind][lanes]
            elif self.before:
                found[lanes] = self.before[stage][kind][lanes]
            else:
                found[lanes[self._cold[lanes]]] = 0.0
        return found
