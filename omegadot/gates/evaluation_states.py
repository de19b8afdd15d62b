"""The states that every engine's equations are evaluated at."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.gates.case import Case
from omegadot.gates.equation import random_acceleration, random_states
from omegadot.gates.truth import Truth, path_states
from omegadot.reference_impl.system import Acceleration, Array, State

RANDOM_STATES = 200
PATH_STATES = 200


@dataclass(frozen=True)
class EvaluationStates:
    """Where an engine's equations are evaluated: at random, and along the exact trajectory.

    acceleration: at the random states, for inverse dynamics.
    """

    random: State
    path: State
    acceleration: Acceleration


@dataclass(frozen=True)
class Probe:
    """States (m, ...) to take one step from, and the steps (m, k) in s to try there."""

    states: State
    timesteps: Array


def evaluation_states_of(case: Case, truth: Truth, seed: int) -> EvaluationStates:
    """The states of a case, the same for every engine and every run."""
    own = [seed, *case.name.encode()]
    states = random_states(case, RANDOM_STATES, own)
    path = path_states(case, truth, PATH_STATES)
    return EvaluationStates(states, path, random_acceleration(case.system, states, own))
