"""On which scenarios a step ends wrongly, by all runs of an integrator."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from test_over_runs import CASES, STEPS
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.diagnosis.stepping.loads.whole_substeps import substepped
from omegadot.diagnosis.stepping.slips.other_schemes import ENDS
from omegadot.diagnosis.stepping.step_ends import kept_ends, with_end
from omegadot.diagnosis.stepping.where_stepped import makes_runs, where_stepped
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.case import Case, Sweep
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.stepping import step_body

NAME = "semi-implicit-euler"
TEXT = "the attitude's change in body axes is multiplied from the left"
MORE = (
    case("free", {}, 1.1),
    case("free-driven", {"torque": BODY_TORQUE}, 0.7),
    case("top-light", {"gravity": GRAVITY, "pivot": PIVOT}, 0.6),
    case("top-damped", {"gravity": GRAVITY, "pivot": PIVOT, "damping": 0.2}, 1.9),
    case("damped-light", {"damping": 0.1}, 0.5),
    case("weightless", {"pivot": PIVOT}, 0.8),
    case("falling", {"gravity": GRAVITY}, 1.2),
)
EVERY = (*CASES, *MORE)


def run_of(one: Case, wrong: bool) -> KeptRun:
    scheme = SCHEMES[NAME]
    scheme = with_end(scheme, ENDS[TEXT]) if wrong else scheme
    sweep = Sweep(0.02, STEPS, 1)
    _, state = step_body(scheme, one.system, one.initial, sweep.timestep, STEPS, 1)
    bounds = {c: np.full(STEPS, 1e-13) for c in ("omega", "attitude", "velocity", "position")}
    return KeptRun(one.name, one.system, sweep, sweep.times, state, bounds, wrong)


def where(wrong: set[str], text: str = TEXT) -> str:
    runs = [run_of(one, one.name in wrong) for one in EVERY]
    features = {one.name: features_of(one.system, one.initial) for one in EVERY}
    integrator = Integrator("own", NAME, dict.fromkeys(CHANNELS, 1))
    return where_stepped(text, integrator, runs, features)


def test_what_acts_on_one_kind_of_scenarios_is_said_to() -> None:
    """Caught: a sentence on every step, of steps that are sound on half of the scenarios."""
    pivoted = {one.name for one in EVERY if one.system.load.pivot is not None}
    assert where(pivoted) == f"{TEXT}, but only where the body is pivoted"


def test_where_no_condition_sorts_the_others_are_counted() -> None:
    assert where({"driven", "top", "free"}) == f"{TEXT}, not on 9 others that would show it"


def test_what_acts_everywhere_and_other_causes_are_left_as_they_are() -> None:
    assert where({one.name for one in EVERY}) == TEXT
    tail = f"{TEXT}, at steps of 0.02 s and longer; steps of 0.01 s fail no gate"
    assert where({one.name for one in EVERY}, tail) == tail
    assert where({"driven"}, "the gyroscopic term is missing") == "the gyroscopic term is missing"


def test_a_body_at_rest_shows_nothing_of_what_scales_omega() -> None:
    """Caught: a body at rest counted as one that would show it, where zero is divided by zero."""
    text = "omega is rescaled after each step, so that its size stays the same"
    one = EVERY[0]
    still = replace(one.initial, angular_velocity=np.zeros(3))
    end = kept_ends(one.system)[text](still, still, 0.01)
    assert np.array_equal(end.angular_velocity, np.zeros(3))


def test_the_cause_of_others_is_that_of_a_run_which_it_makes() -> None:
    """Caught: "on N other scenarios: X; here: the attitude is off", where X makes what is here."""
    integrator = Integrator("own", NAME, dict.fromkeys(CHANNELS, 1))
    first, second = EVERY[:2]
    wrong, sound, beside = run_of(first, True), run_of(first, False), run_of(second, False)

    def made(text: str, *runs: KeptRun, how: Integrator = integrator) -> bool:
        return makes_runs(text, how, [*runs, beside], first.name)

    assert made(TEXT, wrong)
    assert made(TEXT, wrong, how=replace(integrator, scheme=None))
    assert made(f"{TEXT} (free; other numbers on 2 more)", wrong)
    other = "it is stepped by lie-rk4, though semi-implicit-euler is declared"
    slip = f"it is stepped by {NAME}, but the attitude moves by the omega of the step's start"
    for text in (other, slip, "damping is ignored", f"either {TEXT}, or {slip}"):
        assert not made(text, wrong)
    assert not made(TEXT, sound)  # which does not fail
    assert not made(TEXT, replace(sound, fails=True))
    assert not made(TEXT, wrong, sound)  # one without it
    lie = SCHEMES["lie-rk4"]
    _, state = step_body(lie, first.system, first.initial, 0.02, STEPS, 1)
    assert made(other, replace(wrong, state=state))
    two = substepped(SCHEMES[NAME], 2)
    _, state = step_body(two, first.system, first.initial, 0.02, STEPS, 1)
    assert made(f"each step is taken in two equal substeps of {NAME}", replace(wrong, state=state))
