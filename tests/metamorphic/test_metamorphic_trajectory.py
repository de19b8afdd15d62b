"""The trajectory of a motion does not depend on the frame it is reported in, step by step.

Catches, over what the equation shows: an update of the attitude in the wrong frame (rotated world
and body), a body put to sleep below so many rad/s (scaled units) or m/s (Galilean shift). The
errors of a scheme are the same in all frames.
"""

from dataclasses import replace

import metamorphic_faults as faults
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_motions import (
    STEPS,
    Motion,
    Wanted,
    random_motion,
    timestep_of,
    trajectory,
    trajectory_gap,
)
from relations import elsewhere, galilean, relabelled, rotated_body, rotated_world, scaled_units
from test_metamorphic_equation import ENGINES, engine

from omegadot.adapters.protocol import Adapter, Trajectory
from omegadot.reference_impl.rotations import turn_in_world
from omegadot.reference_impl.system import State

FAULT_SEEDS = 100
FREE = Wanted(pivoted=False)


class TurnsInTheWorld(faults.Wrong):
    """Turns the attitude about omega as if omega were in the world frame."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        q = [initial.orientation]
        for omega in found.state.angular_velocity[1:]:
            q.append(turn_in_world(q[-1], omega, every * timestep))
        return Trajectory(found.time, replace(found.state, orientation=np.array(q)))


class StopsWhenSlow(faults.Wrong):
    """Stops a body that moves slower than 1 m/s."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        v = found.state.linear_velocity
        kept = np.where(np.linalg.norm(v, axis=-1, keepdims=True) < 1.0, 0.0, v)
        return Trajectory(found.time, replace(found.state, linear_velocity=kept))


class StaysInABox(faults.Wrong):
    """Holds the centre of mass within 5 m of the world's origin."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        kept = np.clip(found.state.position, -5.0, 5.0)
        return Trajectory(found.time, replace(found.state, position=kept))


RELATIONS = [
    (rotated_world, Wanted(), TurnsInTheWorld),
    (rotated_body, Wanted(), faults.DiagonalInertia),
    (relabelled, Wanted(), faults.SortedMoments),
    (galilean, FREE, StopsWhenSlow),
    (elsewhere, FREE, StaysInABox),
    (scaled_units, Wanted(), faults.FallsAsleep),
]
NAMES = [f"{relation.__name__}-{fault.__name__}" for relation, _, fault in RELATIONS]


def gap(adapter: Adapter, relation, motion: Motion, integrator: str, seed: int) -> float:
    """How far the retold motion's trajectory is from the trajectory, retold."""
    retold = relation(motion, np.random.default_rng(seed))
    step = timestep_of(motion)
    expected = retold.state(trajectory(adapter, motion, integrator, step))
    moved = np.arange(STEPS + 1)[:, None] * step * retold.drift
    expected = replace(expected, position=expected.position + moved)
    step *= retold.time
    found = trajectory(adapter, retold.motion, integrator, step)
    return trajectory_gap(
        adapter, retold.motion, integrator, step, expected, found, relation.__name__
    )


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize(("relation", "wanted", "fault"), RELATIONS, ids=NAMES)
@settings(max_examples=max(2, settings().max_examples // 4))
@given(seed=st.integers(0, 2**32 - 1))
def test_the_trajectory_is_the_same_in_other_frames(
    name, relation, wanted, fault, seed: int
) -> None:
    adapter, motion = engine(name), random_motion(seed, wanted)
    integrators = [integrator.name for integrator in adapter.description.integrators]
    integrator = integrators[seed % len(integrators)]
    assert gap(adapter, relation, motion, integrator, seed) <= 1.0, integrator


@pytest.mark.parametrize(("relation", "wanted", "fault"), RELATIONS, ids=NAMES)
def test_each_relation_catches_its_fault(relation, wanted, fault) -> None:
    name = fault().description.integrators[0].name
    gaps = (gap(fault(), relation, random_motion(s, wanted), name, s) for s in range(FAULT_SEEDS))
    assert any(found > 1.0 for found in gaps)
