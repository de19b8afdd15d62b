"""A search for a cause that ends in an exception takes no verdict with it."""

from __future__ import annotations

from typing import Any

import pytest

import omegadot
from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
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
    message = f"its search ended in ZeroDivisionError in {__file__.rpartition('/')[2]}:"
    # what the first steps show needs no trajectory
    assert all(message in one for one in failed) is (where == "sentences")
