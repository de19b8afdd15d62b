"""The film of a motion without friction, run backwards, is a motion too.

Catches friction that was not requested, a torque that is taken a step late, and a scheme that is
called symmetric and is not. The exact solution is reversible always, of the reference's schemes
the implicit midpoint rule.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_motions import STEPS, Motion, Wanted, random_motion, timestep_of, trajectory
from test_metamorphic_equation import engine

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.system import State, System

FRICTIONLESS = Wanted(damped=False)
SEEDS = st.integers(0, 2**32 - 1)
few = settings(max_examples=max(4, settings().max_examples // 2))


def reversed_state(state: State) -> State:
    return replace(
        state,
        angular_velocity=-state.angular_velocity,
        linear_velocity=-state.linear_velocity,
    )


def last(states: State) -> State:
    return State(*(values[-1] for values in vars(states).values()))


def exact_gap(motion: Motion, of: System | None = None) -> float:
    """How far the exact trajectory there and back ends from its start, over what doubles resolve.

    Either way the answer is off by its floor, and what was off on the way there grows on the way
    back. of: the system that is solved instead of the motion's own.
    """
    system, first = of or motion.system, motion.first
    times = np.linspace(0.0, STEPS * timestep_of(motion), 5)
    there = exact_solution(system, first, times)
    back = exact_solution(system, reversed_state(last(there.state)), times)
    end = reversed_state(last(back.state))
    yardstick = Yardstick(motion.system, times, there.state)
    growth = float(growth_along(motion.system, times, back.state, yardstick.rate)[-1])
    off = float(there.floor.angular_velocity[-1] / yardstick.rate + there.floor.attitude[-1])
    off = growth * (off + EPS) + float(
        back.floor.angular_velocity[-1] / yardstick.rate + back.floor.attitude[-1]
    )
    omega = float(yardstick.distance("omega", end, first))
    attitude = float(attitude_angle(end.orientation, first.orientation))
    return max(omega, attitude) / (FLOORS * off)


# A floor is what an eps of the inputs does; a solution takes some tens of roundings.
FLOORS = 16


@few
@given(SEEDS)
def test_the_exact_trajectory_comes_back(seed: int) -> None:
    assert exact_gap(random_motion(seed, FRICTIONLESS)) <= 1.0


def test_a_hidden_friction_does_not_come_back() -> None:
    motion = random_motion(1, Wanted(pivoted=False, damped=False))
    damping = 1e-9 * float(np.trace(motion.system.body.inertia)) * np.ones(())
    load = replace(motion.system.load, damping=damping)
    assert exact_gap(motion, replace(motion.system, load=load)) > 1.0


def scheme_gap(motion: Motion, scheme: str) -> float:
    """How far a scheme's trajectory there and back ends from its start, over rounding's bound."""
    reference, step = engine("reference"), timestep_of(motion)
    there = trajectory(reference, motion, scheme, step)
    start = reversed_state(last(there))
    back = Motion(motion.system, State(*(v[None] for v in vars(start).values())))
    again = trajectory(reference, back, scheme, step)
    times = step * np.arange(STEPS + 1)
    yardstick = Yardstick(motion.system, times, there)
    growth = growth_along(motion.system, times, again, yardstick.rate)
    bound = yardstick.round_off(step, np.arange(STEPS + 1.0), growth)
    gaps = []
    for channel in ("omega", "attitude", "position"):
        end = yardstick.distance(channel, reversed_state(last(again)), motion.first)
        gaps.append(float(end / (2.0 * bound[channel][-1])))
    return max(gaps)


@few
@given(SEEDS)
def test_the_midpoint_rule_comes_back(seed: int) -> None:
    assert scheme_gap(random_motion(seed, FRICTIONLESS), "implicit-midpoint") <= 1.0


@pytest.mark.parametrize("scheme", ["semi-implicit-euler", "linearly-implicit-euler"])
def test_a_scheme_that_is_not_symmetric_does_not_come_back(scheme: str) -> None:
    assert scheme_gap(random_motion(1, FRICTIONLESS), scheme) > 1.0
