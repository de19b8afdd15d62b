"""Runs whose last sample alone is the state of the step after its time, or before it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.ends.last_samples import RunEnd
from omegadot.diagnosis.stepping.ends.run_ends import other_ends
from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.gates.case import Case, Sweep
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

CASES = (
    case("free", {}),
    case("driven", {"torque": BODY_TORQUE}),
    case("top", {"gravity": GRAVITY, "pivot": PIVOT}),
)
SCHEME, H = "semi-implicit-euler", 0.02
OWN = Integrator("own", SCHEME, dict.fromkeys(CHANNELS, 1))
PLANS = ((18, 3), (17, 3), (12, 1))  # steps, and of which each one is a sample
BOUND = 1e-11
FURTHER = "the last sample of every run is the state one step further than its time"


def run_of(one: Case, plan: tuple[int, int], shift: int, last: str = "") -> tuple[KeptRun, RunEnd]:
    """last: the scheme of the last step, where it is another."""
    steps, every = plan
    sweep = Sweep(H, steps, every)
    _, states = step_body(SCHEMES[SCHEME], one.system, one.initial, H, steps + 3, 1)
    numbers = sweep.sample_steps.copy()
    numbers[-1] += shift
    state = states[numbers]
    if last:
        end = step_body(SCHEMES[last], one.system, states[steps - 1], H, 1, 1)[1][-1]
        pairs = zip(vars(state).values(), vars(end).values(), strict=True)
        state = State(*(np.concatenate((f[:-1], e[None])) for f, e in pairs))
    count = len(numbers) - int(np.diff(sweep.sample_steps)[-1] != every)
    names = ("omega", "attitude", "velocity", "position")
    bounds = {c: np.full(count - 1, BOUND) for c in names}
    last = int(np.diff(sweep.sample_steps)[-1])
    end = RunEnd(one.name, one.system, sweep, state[-2:], last, dict.fromkeys(names, BOUND), True)
    kept = state[:count]
    return KeptRun(one.name, one.system, sweep, sweep.times[:count], kept, bounds, True), end


def found(*shifts: int, spoiled: str = "", last: str = "") -> tuple[str, set[str]]:
    """Of runs whose last samples are this many steps off, in turn, with one scenario spoiled.

    last: the scheme of the last step of every run, where it is another.
    """
    plans = [(one, plan) for one in CASES for plan in PLANS]
    pairs = [run_of(*how, shifts[k % len(shifts)], last) for k, how in enumerate(plans)]
    kept = [pair[0] for pair in pairs]
    for place, run in enumerate(kept):
        if run.name == spoiled:
            w = run.state.angular_velocity.copy()
            w[2] += 1e-3
            kept[place] = replace(run, state=State(**{**vars(run.state), "angular_velocity": w}))
    ends = other_ends(OWN, [pair[1] for pair in pairs], kept)
    return ("", set()) if ends is None else (ends.statement, set(ends.names))


@pytest.mark.parametrize(
    ("shift", "text"),
    [
        (1, FURTHER),
        (-1, "the last step is missing: the end is the state one step before"),
        (3, "the last sample of every run is the state three steps further than its time"),
        (-2, "the last sample of every run is the state two steps before its time"),
    ],
)
def test_another_step_at_the_end_of_every_run_is_one_cause(shift: int, text: str) -> None:
    """Caught: of an interval one step short, "the last interval is stepped in full"."""
    assert found(shift) == (text, {"free", "driven", "top"})


FIELDS = {
    "orientation": "attitude",
    "angular_velocity": "omega",
    "position": "position",
    "linear_velocity": "linear velocity",
}


@pytest.mark.parametrize("field", FIELDS)
def test_one_field_of_another_step_at_the_end_is_one_cause(field: str) -> None:
    """Caught: "the attitude of the last sample alone is wrong", by other numbers in each run."""
    falling = (case("falling", {"gravity": GRAVITY}), case("thrown", {"gravity": [0.3, 2.0, 0.0]}))
    plans = [(one, plan) for one in (*CASES, *falling) for plan in PLANS]
    pairs = [(run_of(*how, 0), run_of(*how, -1)[1]) for how in plans]
    ends = [_with(run[1], field, before) for run, before in pairs]
    cause = other_ends(OWN, ends, [run[0] for run, _ in pairs])
    assert cause is not None
    text = (
        f"the {FIELDS[field]} of the last sample of every run is that of the step before its time"
    )
    assert cause.statement == text
    assert cause.names >= {"falling", "thrown"}


def _with(end: RunEnd, field: str, other: RunEnd) -> RunEnd:
    """With one field of another run's last sample; on a pivot the others follow from it."""
    state = State(**{**vars(end.state), field: getattr(other.state, field)})
    return replace(end, state=place_on_pivot(end.system, state))


@pytest.mark.parametrize(("shift", "off"), [(1, "further than"), (-1, "before")])
def test_another_step_after_a_short_interval_alone_is_one_cause(shift: int, off: str) -> None:
    """Caught: no cause, as the runs that end with a whole interval are right."""
    text = f"after an interval shorter than the others, is the state one step {off} its time"
    assert found(0, shift, 0) == (f"the last sample, {text}", {"free", "driven", "top"})


def test_what_is_not_so_of_every_run_is_not_named() -> None:
    """Caught: an end of another step named where runs of another length are right."""
    assert found(0) == ("", set())
    assert found(1, 0, 0) == ("", set())
    assert found(1, -1, 1) == ("", set())


def test_a_scenario_that_is_wrong_before_its_end_is_left_to_other_causes() -> None:
    assert found(1, spoiled="driven") == (FURTHER, {"free", "top"})


def test_a_last_step_by_another_scheme_is_one_cause() -> None:
    """Caught: "something is left over", as a run of fewer steps ends otherwise."""
    text = f"the last step of every run is by rk4-quaternion, not by {SCHEME}"
    assert found(0, last="rk4-quaternion") == (text, {"free", "driven", "top"})
