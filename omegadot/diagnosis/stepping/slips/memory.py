"""A body's motion that remembers: operands of the step before, of the run's start, of a stage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

BEFORE, FIRST, LAST, START = "the step before", "the run's start", "the stage before", "its start"
EARLIER = "the start of the step before"
PLACES = (BEFORE, EARLIER, FIRST, LAST, START)
OWN_FIRST = f"{EARLIER} (in a run's first step, of its own start)"
# Of a step that solves an equation, whose stages are guesses at one and the same middle.
PLACES_OF_SOLVED = (BEFORE, EARLIER, OWN_FIRST, FIRST, START)


@dataclass
class Memory:
    """What was evaluated in this step, in the one before, and first: lists of (lanes, ...).

    solves: whether a step solves an equation. What it evaluates are then guesses, of which the last
    is its middle; its start is known by itself.
    """

    system: System
    lanes: Sequence[tuple[tuple[str, ...], str]]
    now: dict[str, list[Array]] = field(default_factory=dict)
    before: dict[str, list[Array]] = field(default_factory=dict)
    first: dict[str, Array] = field(default_factory=dict)
    start: Array | None = None
    earlier: Array | None = None
    timestep: float | Array = 0.0
    solves: bool = False
    starts: list[dict[str, Array]] = field(default_factory=list)

    def begin(self, q: Array, v: Array, h: float | Array) -> None:
        """A step begins, of h s at this place and these velocities."""
        self.before, self.now = self.now, {}
        own = {"q": normalize(q[..., -4:]), "w": np.array(v[..., -3:])}
        self.starts = [self.starts[0], self.starts[-1], own] if self.starts else [own]
        self.earlier = np.array(v) if self.start is None else self.start
        self.start, self.timestep = np.array(v), h

    def kept(self, kind: str, value: Array) -> dict[str, Array]:
        """The value and those of the other places, by place; its own where there is none."""
        value = np.array(value)
        earlier, known = self.now.setdefault(kind, []), self.before.get(kind, [])
        if self.solves and kind in self.starts[-1]:
            earlier.append(value)
            return self._solved(kind, value, known)
        place = len(earlier)
        first = self.first.setdefault(kind, value)
        found = {
            "": value,
            BEFORE: known[place] if place < len(known) else value,
            EARLIER: known[0] if known else earlier[0] if earlier else value,
            FIRST: first,
            LAST: earlier[-1] if earlier else value,
            START: earlier[0] if earlier else value,
        }
        earlier.append(value)
        return found

    def _solved(self, kind: str, value: Array, known: Sequence[Array]) -> dict[str, Array]:
        """Of a step's equation: its own value in the run's first step, where there is none."""
        first, start = self.starts[0][kind], self.starts[-1][kind]
        again = self.starts[-2][kind] if len(self.starts) > 1 else None
        return {
            "": value,
            BEFORE: known[-1] if known else value,
            EARLIER: value if again is None else again,
            OWN_FIRST: start if again is None else again,
            FIRST: first,
            START: start,
        }

    def taken(self, slot: str, values: dict[str, Array]) -> Array:
        """What an operand is in each lane."""
        found = values[""]
        old = [k for k, (slots, _) in enumerate(self.lanes) if slot in slots]
        if old:
            found = found.copy()
            for k in old:
                found[k] = values[self.lanes[k][1]][k]
        return found

    def motion(self) -> Motion:
        """The body's motion, with old operands."""
        exact, system = body_motion(self.system, "com-world"), self.system
        inertia = moving_inertia(system)
        back, load, arm = inverse(inertia), system.load, lever(system)
        pulled = load.pivot is not None and np.any(load.gravity)

        def acceleration(q: Array, v: Array) -> Array:
            q = exact.normalize(q)
            turns, rates = self.kept("q", q[..., -4:]), self.kept("w", v[..., -3:])
            turn = turns[""]

            def to_old(slot: str, vector: Array) -> Array:
                """From the body's axes to those of the old attitude."""
                return rotate_inverse(self.taken(slot, turns), rotate(turn, vector))

            def from_old(slot: str, vector: Array) -> Array:
                return rotate_inverse(turn, rotate(self.taken(slot, turns), vector))

            w = self.taken("gyroscopic", rates)
            spun = from_old("spin", apply(inertia, to_old("spin", w)))
            torque = -cross(w, spun)
            if np.any(load.damping):
                torque = torque - load.damping * self.taken("damping", rates)
            if np.any(load.torque_body):
                torque = torque + from_old("body", load.torque_body + 0.0 * w)
            if np.any(load.torque_world):
                torque = torque + rotate_inverse(self.taken("couple", turns), load.torque_world)
            if pulled:
                old = rotate_inverse(self.taken("weight", turns), weight(system))
                torque = torque + cross(arm, old)
            angular = from_old("solve", apply(back, to_old("solve", torque)))
            angular = self.taken("angular", self.kept("a", angular))
            linear = 0.0 * v[..., :-3] + load.gravity if v.shape[-1] > 3 else v[..., :-3]
            return np.concatenate((linear, angular), axis=-1)

        def moved(kind: str, u: Array) -> Array:
            both = self.kept(kind, u)
            if self.earlier is not None:
                both[EARLIER] = self.earlier * (self.timestep if kind == "u" else 1.0)
            turn, move = self.taken("turn", both), self.taken("move", both)
            return np.concatenate((move[..., :-3], turn[..., -3:]), axis=-1)

        return replace(
            exact,
            acceleration=acceleration,
            retract=lambda q, u: exact.retract(q, moved("u", u)),
            coordinate_rate=lambda q, v: exact.coordinate_rate(q, moved("rate", v)),
        )
