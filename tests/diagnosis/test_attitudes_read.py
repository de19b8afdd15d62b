"""One convention of attitudes that are read back and of the samples of runs; and silence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from test_read_out import BRANCH, by_branch
from test_starts import CASES

from omegadot.diagnosis.models.attitudes_read import (
    IN_BOTH,
    IN_RUNS,
    attitudes_read,
    in_both,
)
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import State

DRAW = np.random.default_rng(11)
CONVENTION = BRANCH.removeprefix(IN_RUNS)


def drawn(count: int) -> State:
    turns = normalize(DRAW.normal(size=(count, 4)))
    return State(turns, *DRAW.normal(size=(3, count, 3)))


LIMITS = [(one, by_branch(one)) for one in (drawn(30) for _ in CASES)]
SET = [State(*(field[0] for field in vars(drawn(1)).values())) for _ in range(12)]


def test_few_states_that_read_back_wrong_have_the_convention_of_the_samples() -> None:
    """Caught: a second sentence, that no cause is known, of the same attitudes."""
    assert attitudes_read([(one, by_branch(one)) for one in SET], LIMITS) == CONVENTION
    assert in_both(BRANCH, CONVENTION) == f"{IN_BOTH}{CONVENTION}"


def test_states_that_read_back_right_or_otherwise_have_not() -> None:
    assert attitudes_read([(one, one) for one in SET], LIMITS) == ""
    other = [(one, replace(one, orientation=normalize(one.orientation + 0.1))) for one in SET]
    assert attitudes_read(other, LIMITS) == ""
    assert in_both(BRANCH, "") == BRANCH
