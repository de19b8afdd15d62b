"""A search for a cause that ends in an exception takes no verdict with it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import omegadot
from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.diagnosis.defect import first_found, kept_apart
from omegadot.diagnosis.integrator import IntegratorCauses
from omegadot.reference_impl.system import State


class LateAdapter(ReferenceAdapter):
    """Runs twice as slowly as it reports."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, 0.5 * timestep, steps, every)
        return Trajectory(2.0 * found.time, found.state)


@pytest.mark.parametrize("where", ["release", "sentences"])
def test_a_defect_of_the_search_is_reported_beside_the_failure(
    where: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: a traceback in place of every verdict, the sound ones among them."""

    def ended(self: IntegratorCauses, *_: Any, **__: Any) -> list[str]:
        return [str(1 / 0)]

    monkeypatch.setattr(IntegratorCauses, where, ended)
    found = omegadot.check(LateAdapter, scenarios="sphere", integrators="lie-rk4", shrink=False)
    failed = [one.message for one in found.failures.values() if one.verdict == "fail"]
    assert failed
    message = "its search ended in ZeroDivisionError in case_causes.py:"
    # what the first steps show needs no trajectory
    assert all(message in one for one in failed) is (where == "sentences")


def test_one_search_that_ends_in_an_exception_costs_no_other() -> None:
    """Caught: a cause that a later search names, lost by an error in an earlier one."""

    def ends() -> list[str]:
        return [str(np.linalg.inv(np.zeros((2, 2))))]

    assert first_found((ends, list, lambda: ["named"])) == ["named"]
    assert first_found((list, list)) == []
    defects = list[str]()
    with kept_apart(defects):
        first_found((ends, list))
    # the place is one of the project's own, or else the caller's, not a line of a library
    assert "LinAlgError in defect.py" in defects[0]
