"""Old operands in the equation of an implicit midpoint step; and silence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from test_over_runs import CASES, kept

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

MIDPOINT = "implicit-midpoint"
Change = Callable[[System, Motion, Array, Array, Array], Array]


def inverted_at(system: System, motion: Motion, old: Array, q: Array, v: Array) -> Array:
    """omega-dot by the inverse inertia in the world of an old attitude."""
    torque = apply(moving_inertia(system), motion.acceleration(q, v)[-3:])
    there = rotate_inverse(old[-4:], rotate(q[-4:], torque))
    found = apply(inverse(moving_inertia(system)), there)
    return rotate_inverse(q[-4:], rotate(old[-4:], found))


def inertia_at(system: System, motion: Motion, old: Array, q: Array, v: Array) -> Array:
    """omega-dot by the inertia in the world of an old attitude, in both its terms."""
    inertia, w = moving_inertia(system), v[-3:]

    def turned(matrix: Array, vector: Array) -> Array:
        there = rotate_inverse(old[-4:], rotate(q[-4:], vector))
        return rotate_inverse(q[-4:], rotate(old[-4:], apply(matrix, there)))

    right = apply(inertia, motion.acceleration(q, v)[-3:])
    torque = right + cross(w, apply(inertia, w) - turned(inertia, w))
    return turned(inverse(inertia), torque)


def loads_at(system: System, motion: Motion, old: Array, q: Array, v: Array) -> Array:
    """omega-dot with all torques at an old attitude."""
    place = np.concatenate((q[:-4], old[-4:]))
    return motion.acceleration(place, v)[-3:]


@dataclass
class Engine:
    """Its equation is solved by fixed-point iteration. since: of which the old attitude is.

    change: omega-dot, of an old attitude, a stage's place and its velocities.
    """

    change: Change
    since: str
    starts: list[Array] = field(default_factory=list)

    def __call__(
        self, system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        self.starts = [*(self.starts if n else []), q]
        mean = v
        for _ in range(80):
            at = motion.retract(q, 0.5 * motion.cayley(h * mean))
            own = q if self.since.endswith("own") else at
            old = {
                "start": q,
                "first": self.starts[0],
                "middle": at,
            }.get(self.since, self.starts[-2] if n else own)
            push = motion.acceleration(at, mean)
            push[-3:] = self.change(system, motion, old, at, mean)
            mean = v + 0.5 * h * push
        return motion.retract(q, motion.cayley(h * mean)), 2.0 * mean - v


def causes(engine: Engine) -> list[str]:
    runs = [kept(one, engine, *plan) for one in CASES for plan in ((0.02, 1), (0.009, 2))]
    by = SchemeOf(SCHEMES[MIDPOINT], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", MIDPOINT, dict.fromkeys(CHANNELS, 2)), runs)


@pytest.mark.parametrize(
    ("engine", "text"),
    [
        (
            Engine(inverted_at, "before"),
            "the inertia in world axes is inverted at the attitude of the start of the step before",
        ),
        (
            Engine(inverted_at, "before or own"),
            "the inertia in world axes is inverted at the attitude of the start of the step before "
            "(in a run's first step, of its own start)",
        ),
        (
            Engine(inertia_at, "first"),
            "the inertia in world axes is that of the attitude of the run's start",
        ),
        (
            Engine(loads_at, "start"),
            "the torques of gravity and in world axes are taken at the attitude of its start",
        ),
    ],
)
def test_an_old_operand_of_the_equation_is_named(engine: Engine, text: str) -> None:
    """Caught: an omega that is off from the second step on."""
    assert causes(engine) == [f"in each step {text}"]


def test_operands_of_the_middle_have_no_cause() -> None:
    """Caught: a guess of the equation that is taken for an old operand."""
    for change in (inverted_at, inertia_at, loads_at):
        assert causes(Engine(change, "middle")) == []
