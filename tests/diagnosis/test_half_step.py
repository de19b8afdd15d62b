"""The linear velocity of half a step before or after, in a run that is sound but for it."""

from __future__ import annotations

from dataclasses import replace

import pytest
from in_process import answers_of, declared, truth_of
from wrong_equations import GRAVITY, PIVOT, case

from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.diagnosis.runs import run_causes
from omegadot.gates.case import Case
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.runs import judge_case
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import State

SCHEME = "semi-implicit-euler"
LOADS = {"falling": {"gravity": GRAVITY}, "top": {"gravity": GRAVITY, "pivot": PIVOT}}


def causes(one: Case, steps: float) -> tuple[str, ...]:
    """Of a run whose velocity, but for the start, is that of so many steps after."""
    truth, runs = truth_of(one, (SCHEME,)), {}
    for h, answer in answers_of(one, ReferenceAdapter(), SCHEME).items():
        state = State(**answer.result["state"])
        moved = state.linear_velocity + steps * h * forward_dynamics(one.system, state).linear
        moved[0] = state.linear_velocity[0]
        other = vars(replace(state, linear_velocity=moved))
        runs[SCHEME, h] = replace(answer, result={**answer.result, "state": other})
    result = CaseResult((declared(SCHEME, SCHEME, 1),), runs=runs)
    return run_causes(one, truth, result, judge_case(truth, one, result, {})).texts


@pytest.mark.parametrize(("steps", "when"), [(-0.5, "before"), (0.5, "after")])
@pytest.mark.parametrize("load", LOADS)
def test_a_velocity_of_half_a_step_before_or_after_is_named_alone(
    load: str, steps: float, when: str
) -> None:
    """Caught: in a fall the constant difference, or a mean of two samples, beside what makes it."""
    one = case(load, LOADS[load])
    short = replace(one, sweeps=one.sweeps[:1])
    assert causes(short, steps) == (f"the linear velocity is reported as of half a step {when}",)


def test_a_velocity_that_is_off_by_another_share_of_a_step_is_still_stated_so() -> None:
    one = case("falling", LOADS["falling"])
    texts = causes(replace(one, sweeps=one.sweeps[:1]), -0.3)
    assert any("the same at every sample" in text for text in texts)
    assert not any("half a step" in text for text in texts)
