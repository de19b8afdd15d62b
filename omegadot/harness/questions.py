"""The states that every engine's equations are asked at."""

from __future__ import annotations

from omegadot.harness.drive import Questions
from omegadot.harness.gates.equation import random_acceleration, random_states
from omegadot.harness.plan import Case
from omegadot.harness.truth import Truth, path_states

RANDOM_STATES = 200
PATH_STATES = 200


def questions_of(case: Case, truth: Truth, seed: int) -> Questions:
    """The states that every engine is asked about; the same for all, and for every run."""
    own = [seed, *case.name.encode()]
    states = random_states(case, RANDOM_STATES, own)
    path = path_states(case, truth, PATH_STATES)
    return Questions(states, path, random_acceleration(case.system, states, own))
