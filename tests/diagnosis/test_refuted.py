"""An equation of one scenario's runs, held against the steps of the others."""

from __future__ import annotations

from wrong_equations import BODY_TORQUE, CASES, case

from omegadot.diagnosis.equations.evidence import Evidence, of_forward_dynamics
from omegadot.diagnosis.stepping.other_equations import is_refuted
from omegadot.diagnosis.wording.features import Features, in_common, surely_only_where
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration

MISSING = "in the steps, the applied torque is missing"
DRIVEN = case("driven", {"torque": BODY_TORQUE})


def evidence(of: Case, off: float = 0.0) -> Evidence:
    states = random_states(of, 20, [1])
    true = forward_dynamics(of.system, states)
    return of_forward_dynamics(of.system, states, Acceleration(true.angular + off, true.linear))


def test_sound_steps_under_a_torque_refute_that_it_is_missing() -> None:
    """Caught: 1 N m in place of 1e10 N m on one body, named as none on any."""
    assert is_refuted(MISSING, evidence(DRIVEN))
    assert not is_refuted(MISSING, evidence(CASES[0]))  # none acts there
    assert not is_refuted(MISSING, evidence(DRIVEN, off=0.1))  # nothing is known of wrong ones
    assert not is_refuted("the clock drifts", evidence(DRIVEN))


def _some(count: int, pivoted: bool) -> list[Features]:
    kinds = {"the body is pivoted": pivoted, "the body is damped": False}
    return [Features(kinds, {"the mass": (1.0, "kg")})] * count


def test_few_scenarios_have_nothing_in_common_for_sure() -> None:
    """Caught: "but only where the moments are equal", of one scenario in eight that shows it."""
    assert in_common(_some(1, True), _some(7, False)) == ["the body is pivoted"]
    assert surely_only_where("the torque is missing", _some(1, True), _some(7, False)) is None
    found = surely_only_where("the torque is missing", _some(9, True), _some(9, False))
    assert found == "the torque is missing, but only where the body is pivoted"
