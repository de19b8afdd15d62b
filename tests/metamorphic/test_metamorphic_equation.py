"""omega-dot and the centre of mass's acceleration do not depend on the frame of the request.

Each property names the wrong code that it catches, and is shown to catch it.
"""

from functools import cache

import metamorphic_faults as faults
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_motions import Motion, Wanted, accelerations, equation_gap, random_motion
from relations import (
    galilean,
    offset_origin,
    relabelled,
    reversed_time,
    rotated_body,
    rotated_world,
    scaled_units,
)

from omegadot.adapters.protocol import Adapter
from omegadot.adapters.registry import BUILT_IN, build_adapter

ENGINES = ("reference", "mujoco", "pinocchio", "dart")
FREE = Wanted(pivoted=False)
FAULT_SEEDS = 12
# Relation, the motions that it holds for, and the wrong code that it catches.
RELATIONS = [
    (rotated_world, Wanted(), faults.OmegaDotInWorld),  # an answer in the wrong frame
    (rotated_world, Wanted(), faults.GravityAlwaysDown),  # a world with a preferred direction
    (rotated_body, Wanted(), faults.DiagonalInertia),  # a tensor whose products are dropped
    (relabelled, Wanted(), faults.SortedMoments),  # moments that lost their axes
    (galilean, FREE, faults.AirDrag),  # a medium at rest
    (scaled_units, Wanted(), faults.VelocityClamp),  # a threshold in absolute units
    (offset_origin, Wanted(), faults.InertiaAboutTheOrigin),  # an inertia about the wrong point
    (reversed_time, Wanted(damped=False), faults.BearingFriction),  # friction
]
NAMES = [f"{relation.__name__}-{fault.__name__}" for relation, _, fault in RELATIONS]


@cache
def engine(name: str) -> Adapter:
    """One instance for all: what an earlier load left behind would show."""
    return build_adapter(BUILT_IN[name])


def gap(adapter: Adapter, relation, motion: Motion, seed: int) -> float:
    """How far the engine's answer to the retold motion is from its own answer, retold."""
    retold = relation(motion, np.random.default_rng(seed))
    expected = retold.acceleration(accelerations(adapter, motion))
    found = accelerations(adapter, retold.motion)
    if relation is scaled_units:
        return equation_gap((retold.motion,), expected, found)
    return equation_gap((motion, retold.motion), expected, found)


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize(("relation", "wanted", "fault"), RELATIONS[1:], ids=NAMES[1:])
@given(seed=st.integers(0, 2**32 - 1))
def test_the_equation_is_the_same_in_other_frames(name, relation, wanted, fault, seed: int) -> None:
    assert gap(engine(name), relation, random_motion(seed, wanted), seed) <= 1.0


@pytest.mark.parametrize(("relation", "wanted", "fault"), RELATIONS, ids=NAMES)
def test_each_relation_catches_its_fault(relation, wanted, fault) -> None:
    gaps = [gap(fault(), relation, random_motion(s, wanted), s) for s in range(FAULT_SEEDS)]
    assert max(gaps) > 1.0


@given(seed=st.integers(0, 2**32 - 1))
def test_powers_of_two_change_no_digit_of_the_reference(seed: int) -> None:
    motion = random_motion(seed)
    retold = scaled_units(motion, np.random.default_rng(seed))
    expected = retold.acceleration(accelerations(engine("reference"), motion))
    found = accelerations(engine("reference"), retold.motion)
    np.testing.assert_array_equal(found.angular, expected.angular)
    np.testing.assert_array_equal(found.linear, expected.linear)
