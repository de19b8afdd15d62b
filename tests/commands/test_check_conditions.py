"""A check finds by experiment on which condition an engine is wrong, from one scenario alone."""

from __future__ import annotations

from pathlib import Path

import pytest

import omegadot
from omegadot.diagnosis import diagnose

FILE = Path(__file__).parent.parent / "wrong_engines" / "conditional.py"


def test_the_condition_is_found_from_one_scenario() -> None:
    """Caught: "the gyroscopic term is missing", which it is not where any torque acts."""
    found = omegadot.check(f"{FILE}:EarlyReturn", scenarios="t-handle", random=0, shrink=False)
    (message,) = {r.message for i, r in found.failures.items() if i.endswith("equation")}
    cause = message.partition("Likely cause: ")[2]
    assert "the gyroscopic term is missing" in cause
    assert "only where no torque acts (applied, of damping or of the weight)" in cause


def test_a_check_that_passes_costs_no_experiment(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise AssertionError("nothing has failed")

    monkeypatch.setattr(diagnose, "conditions_of", refused)
    assert omegadot.check("reference", scenarios="t-handle", random=0, shrink=False).passed


def test_wrong_inverse_dynamics_alone_end_in_a_cause() -> None:
    """Caught: an error in the search for a condition, of forward dynamics that are not there."""
    found = omegadot.check(f"{FILE}:InverseAlone", scenarios="t-handle", random=0, shrink=False)
    (message,) = found.failures.values()
    assert "inverse dynamics" in message.message
    assert "gyroscopic term" in message.message


def test_an_omega_dot_that_changes_by_itself_has_no_other_cause() -> None:
    """Caught: a term, or what is left over, named of an engine that answers at random."""
    found = omegadot.check(f"{FILE}:Unsteady", scenarios="t-handle", random=0, shrink=False)
    (message,) = {r.message for i, r in found.failures.items() if i.endswith("equation")}
    cause = message.partition("Likely cause: ")[2]
    assert cause.startswith("omega-dot of the same states is another when it is requested again")
