"""A body that reads back on the pivot of a system loaded before: what is kept of that one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.all_kept import KEPT
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.kept_parts import Kept
from omegadot.diagnosis.equations.left_over import worded_kept
from omegadot.gates.case import Case
from omegadot.gates.states.model import state_rows
from omegadot.harness.loaded_before import LoadedBefore
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import State

PLACED_BY = {"pivot", "center_of_mass"}  # what the place of a pivoted body is made of


@dataclass(frozen=True)
class _Seen:
    """One scenario: the state that was set, what read back, and what had been loaded before it."""

    case: Case
    requested: State
    back: State
    before: LoadedBefore
    eps: float

    @property
    def wrong(self) -> bool:
        """Whether it is not what was set."""
        return self._differ(self.requested)

    def explained(self, one: Kept) -> bool:
        """Whether what reads back is what was set, placed by what is kept."""
        donor = one.donor(self.case.system, self.before)
        if donor is None:
            return not self.wrong
        made = place_on_pivot(one.part.put(self.case.system, donor), self.requested)
        return not self._differ(made)

    def _differ(self, made: State) -> bool:
        rows = state_rows(self.case, made, self.back, self.eps)
        return any(row.verdict == "fail" for row in rows)


def kept_place(scenes: Sequence[Scene], case: Case, eps: float) -> str:
    """What is kept of a system loaded before, if it makes all states as they read back; else "".

    It must be so on two scenarios, with two values. case: any of the run.
    """
    seen = [
        _Seen(replace(case, system=s.system), *s.states, before, eps)
        for s in scenes
        if s.states is not None and (before := s.loaded_before("")) is not None
    ]
    wrong = [one for one in seen if one.wrong]
    if not wrong:
        return ""
    tried = [k for k in KEPT if not k.of_form and PLACED_BY & {*k.part.attributes}]
    # what is wrong rules out most of them
    fits = [k for k in tried if all(one.explained(k) for one in (*wrong, *seen))]
    return worded_kept([k for k in fits if _several(k, wrong)])


def _several(one: Kept, wrong: Sequence[_Seen]) -> bool:
    """Whether what is kept has two values: a wrong constant is no other system's."""
    values = [one.value(s.case.system, s.before) for s in wrong]
    return any(not np.array_equal(value, values[0]) for value in values[1:])
