"""A torque less its value of the run's start, or with that of each sample until the next."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from test_over_runs import Step, causes, euler

from omegadot.diagnosis.equations.operators.operands import gyroscopic
from omegadot.reference_impl.coordinates import from_coordinates
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import gravity_torque
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System

Torque = Callable[[System, State], Array]


def of_world(system: System, state: State) -> Array:
    return rotate_inverse(state.orientation, system.load.torque_world)


def tared(torque: Torque, world: bool = False, share: float = 1.0) -> Step:
    """A step with so much of the torque of the run's start less."""
    kept = dict[str, State]()

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        state = from_coordinates(system, q, v, "com-world")
        start = kept.setdefault("start", state) if n else state
        kept["start"] = start
        less = torque(system, start)
        if world:
            less = rotate_inverse(state.orientation, rotate(start.orientation, less))
        return euler(motion, q, v, h, -share * apply(inverse(moving_inertia(system)), less))

    return step


@pytest.mark.parametrize("world", [False, True])
@pytest.mark.parametrize(
    ("torque", "what"),
    [
        (gravity_torque, "the torque of gravity"),
        (gyroscopic, "the gyroscopic term"),
    ],
)
def test_a_torque_less_that_of_the_start_is_named(torque: Torque, what: str, world: bool) -> None:
    """Caught: "at the start of a run, the torque of gravity is missing"."""
    plans = ((0.02, 1), (0.009, 2), (0.005, 3))
    (text,) = causes(tared(torque, world), plans=plans)
    axes = ", in world axes," if world else ""
    assert text == f"in a run, {what} has that of the run's start{axes} subtracted from it"


def test_a_torque_in_world_axes_is_told_from_that_of_all_loads() -> None:
    (text,) = causes(tared(of_world))
    assert (
        text == "in a run, the torque in world axes has that of the run's start subtracted from it"
    )


def test_a_part_of_the_torque_of_the_start_is_no_whole_one() -> None:
    assert not any("subtracted" in text for text in causes(tared(gyroscopic, share=0.5)))
    assert not np.any(["subtracted" in text for text in causes(tared(gyroscopic, share=0.0))])


def held(torque: Torque, every: int, world: bool = False) -> Step:
    """A step with the torque of the sample before it, of which each `every`-th step is one."""
    kept = dict[str, State]()

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        state = from_coordinates(system, q, v, "com-world")
        kept["sample"] = kept.get("sample", state) if n % every else state
        own = torque(system, kept["sample"])
        if world:
            own = rotate_inverse(state.orientation, rotate(kept["sample"].orientation, own))
        more = own - torque(system, state)
        return euler(motion, q, v, h, apply(inverse(moving_inertia(system)), more))

    return step


def of_both(system: System, state: State) -> Array:
    return of_world(system, state) + gravity_torque(system, state)


@pytest.mark.parametrize(
    ("torque", "world", "what"),
    [
        (of_both, False, "the torque of gravity and in world axes keeps its value of each sample"),
        (gravity_torque, False, "the torque of gravity keeps its value of each sample"),
        (gyroscopic, True, "the gyroscopic term keeps its value of each sample, in world axes,"),
    ],
)
def test_a_torque_that_is_formed_at_samples_alone_is_named(
    torque: Torque, world: bool, what: str
) -> None:
    """Caught: loads that are turned once an interval, named by the order that steps lose."""
    (text,) = causes(held(torque, 3, world), plans=((0.02, 3), (0.009, 3)))
    assert text == f"in a run, {what} until the next"
