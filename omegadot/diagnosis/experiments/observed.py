"""Observations: systems in states, and whether a fault shows there, drawn or requested."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.experiments.traits import Traits, traits_of
from omegadot.reference_impl.system import Array, State, System

Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Trial:
    """One system in states (n,).

    wrong: where the fault shows.  known: where it would show if it acted, and either does or does
    not.  base: what this differs from in one thing, with as many states; None of what was drawn.
    """

    system: System
    states: State
    wrong: Flags
    known: Flags
    base: Trial | None = None

    @cached_property
    def traits(self) -> Traits:
        """Of its states."""
        return traits_of(self.system, self.states)

    @property
    def fails(self) -> bool:
        """Whether the fault shows at every state that would show it."""
        return bool(np.any(self.known) and np.all(self.wrong[self.known]))

    @property
    def passes(self) -> bool:
        """Whether it shows at none, and would."""
        return bool(np.any(self.known) and not np.any(self.wrong[self.known]))


class Observations:
    """All of one fault, as a table: a row a state."""

    def __init__(self, trials: list[Trial]) -> None:
        self.trials = [one for one in trials if np.any(one.known)]

    @cached_property
    def wrong(self) -> Flags:
        """(n,): whether the fault shows."""
        return np.concatenate([one.wrong[one.known] for one in self.trials])

    def column(self, of: Callable[[Traits], Array]) -> Array:
        """(n,): a column of the table."""
        return np.concatenate([of(one.traits)[one.known] for one in self.trials])

    def decided_by_one_change(self, of: Callable[[Traits], Array]) -> bool:
        """Whether a change of this alone has once made the fault appear, or vanish."""
        for one in self.trials:
            if one.base is None:
                continue
            both = one.known & one.base.known & (one.wrong != one.base.wrong)
            here, there = of(one.traits), of(one.base.traits)
            if np.any(both & (here != there) & ~np.isnan(here) & ~np.isnan(there)):
                return True
        return False
