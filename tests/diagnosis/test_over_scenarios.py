"""One mistake over the scenarios of a run: one cause, chosen by those that distinguish it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from test_causes import causes_over
from wrong_equations import CASES, GRAVITY, PIVOT, case, gyroscopic, with_torque

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.hypotheses import hypotheses
from omegadot.diagnosis.equations.same_cause import same_cause
from omegadot.diagnosis.equations.siblings import AFTER_ANOTHER, Siblings
from omegadot.diagnosis.reported.known_run import Known
from omegadot.diagnosis.stepping.order_lost import OrderLost
from omegadot.diagnosis.wording.features import features_of
from omegadot.diagnosis.wording.kinds import over_run
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.harness.requests.siblings import siblings_of
from omegadot.reference_impl.inertia import moving_inertia, parallel_axis
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import damping_torque, gravity_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration, Body, State, System

TOPS = tuple(
    case(f"top-{k}", {"gravity": GRAVITY, "pivot": [PIVOT[0], PIVOT[1], 0.1 * k]}, 1.0 + k)
    for k in range(3)
)


def at_origin(one: Case) -> Case:
    """With the centre of mass at the origin."""
    body = replace(one.system.body, center_of_mass=np.zeros(3))
    return replace(one, system=replace(one.system, bodies=(body,)))


def by_body(change: Callable[[System], Body]) -> Callable[..., Acceleration]:
    def found(system: System, states: State) -> Acceleration:
        return forward_dynamics(replace(system, bodies=(change(system),)), states)

    return found


def about_origin(system: System, states: State) -> Acceleration:
    """The parallel-axis theorem takes the distance from the origin: of another own inertia."""
    body, pivot = system.body, system.load.pivot
    if pivot is None:
        return forward_dynamics(system, states)
    lever = body.center_of_mass - pivot
    more = parallel_axis(body.mass, body.center_of_mass) - parallel_axis(body.mass, lever)
    other = replace(body, inertia=body.inertia + more)
    return forward_dynamics(replace(system, bodies=(other,)), states)


def test_scenarios_that_distinguish_two_causes_decide_on_the_others_too() -> None:
    """A centre of mass at the origin alone shows as well the inertia about it."""
    first = at_origin(TOPS[0])
    (alone,) = causes_over(about_origin, (first,)).values()
    assert "in the parallel-axis theorem, the centre of mass's distance from the origin" in alone
    assert "the inertia about the centre of mass is taken" in alone
    causes = causes_over(about_origin, (first, *TOPS[1:]))
    assert len(causes) == 3
    (text,) = set(causes.values())
    assert text.startswith("in the parallel-axis theorem, the centre of mass's distance from the ")
    assert "either" not in text


def test_a_cause_at_few_states_is_found_over_all_scenarios() -> None:
    """One state of a scenario fits many causes."""

    def steady(system: System, states: State) -> Acceleration:
        w = states.angular_velocity
        along = ~np.any(w[:, :2], axis=-1, keepdims=True) & (w[:, 2:] != 0.0)
        return with_torque(system, states, np.where(along, -gravity_torque(system, states), 0.0))

    causes = causes_over(steady, (*TOPS, *CASES[:2]))
    assert causes
    found = "the torque of gravity is missing, but only where omega is along z alone"
    assert set(causes.values()) == {found}


def test_a_threshold_is_narrowed_by_all_scenarios() -> None:
    def slow(system: System, states: State) -> Acceleration:
        few = np.sum(states.angular_velocity**2, axis=-1, keepdims=True) < 4.0
        return with_torque(system, states, np.where(few, gyroscopic(system, states), 0.0))

    (text,) = set(causes_over(slow, CASES[:4]).values())
    assert text.startswith("the gyroscopic term is missing, but only where |omega| is below")


def test_a_limited_inertia_is_one_cause() -> None:
    shapes = ([[1.0, 0.1, 0.2], [0.1, 1.6, -0.15], [0.2, -0.15, 2.1]], np.diag([1.0, 1.3, 1.1]))
    large = tuple(
        case(
            f"large-{k}",
            {"gravity": GRAVITY, "pivot": PIVOT, "damping": 4.0},
            1.0 + 3.0 * k,
            tensor.tolist(),
        )
        for k, tensor in enumerate(
            size * np.asarray(shapes[k % 2]) for k, size in enumerate((1.0, 20.0, 500.0, 7000.0))
        )
    )

    def limited(system: System) -> Body:
        body = system.body
        scale = min(1.0, 10.0 / float(np.max(np.diag(body.inertia))))
        return replace(body, inertia=body.inertia * scale)

    causes = causes_over(by_body(limited), large)
    (text,) = set(causes.values())
    assert "scaled so that the largest" in text
    assert text.endswith("comes to 10 kg m^2")


def test_two_wordings_of_one_cause_are_one() -> None:
    def square(system: System, states: State) -> Acceleration:
        w = states.angular_velocity
        size = np.sqrt(np.sum(w * w, axis=-1, keepdims=True))
        return with_torque(system, states, (size - 1.0) * damping_torque(system, states))

    assert not any("either" in text for text in causes_over(square, CASES[2:5]).values())


def test_causes_that_differ_on_a_pivot_alone_are_one_where_there_is_none() -> None:
    known = {h.text.strip(): h for h in hypotheses(CASES[0].system)}
    one, other = (
        Candidate((known[text],))
        for text in ("gravity is missing", "the torque of gravity is missing")
    )
    assert not same_cause(one, other, pivoted=True)
    assert same_cause(one, one, pivoted=True)


def test_a_torque_along_principal_axes_is_named() -> None:
    def turned(system: System, states: State) -> Acceleration:
        axes = np.linalg.eigh(system.body.inertia)[1]
        axes = axes * [1.0, 1.0, np.linalg.det(axes)]
        load = replace(system.load, torque_body=axes @ system.load.torque_body)
        return forward_dynamics(replace(system, load=load), states)

    (text,) = set(causes_over(turned, (CASES[3], CASES[5])).values())
    assert text == "the torque in body axes is taken along the principal axes of inertia"


def test_principal_axes_about_the_pivot_are_not_those_of_the_body() -> None:
    """Caught: the tensor about the centre of mass alone, which has other axes."""

    def turned(system: System, states: State) -> Acceleration:
        axes = np.linalg.eigh(np.asarray(moving_inertia(system), dtype=float))[1]
        load = replace(system.load, torque_body=axes @ system.load.torque_body)
        return forward_dynamics(replace(system, load=load), states)

    driven = [case for case in CASES if np.any(case.system.load.torque_body)]
    assert any(case.system.load.pivot is not None for case in driven)
    (text,) = set(causes_over(turned, tuple(driven)).values())
    assert text.endswith("the principal axes of the inertia about the pivot")


def test_what_is_lost_in_several_channels_is_one_sentence() -> None:
    free = OrderLost({"omega": (1, 2), "position": (1, 2)}, {"omega": "omega moves late"})
    held = OrderLost({"omega": (1, 2), "attitude": (1, 2)})
    assert free.with_others([held]).text == held.with_others([free]).text
    assert "step^2 in omega, the attitude and the position" in held.with_others([free]).text


def test_an_order_that_a_scenario_has_kept_is_not_lost_on_another() -> None:
    driven = OrderLost({"omega": (3, 4), "attitude": (2, 4)})
    free = OrderLost({"attitude": (2, 4)}).over({"omega": 3.99}, {"omega": 4, "attitude": 4})
    assert driven.with_others([free]).text == free.with_others([driven]).text
    assert "omega" not in driven.with_others([free]).text


def test_an_order_that_whole_runs_contradict_is_not_lost() -> None:
    reported = OrderLost({"omega": (1, 4)}).over({"omega": 2.0}, {"omega": 4})
    assert not reported.orders
    assert "omega" in reported.against


def test_a_term_that_steps_hold_explains_every_scenario() -> None:
    """Without loads it is all of omega-dot; where a load acts, it is not."""
    gyroscopic, pulled = "the gyroscopic term", "the torque of gravity"
    free = OrderLost({"omega": (1, 2)}, {}, (frozenset({gyroscopic}), frozenset({gyroscopic})))
    top = OrderLost(
        {"omega": (1, 2)}, {}, (frozenset({gyroscopic, pulled}), frozenset({gyroscopic}))
    )
    late = replace(top, held=(frozenset({gyroscopic, pulled}), frozenset({gyroscopic, pulled})))
    assert "either" in free.with_others([]).text
    for one, other in ((free, top), (top, free)):
        assert one.with_others([other]).text.endswith(
            "gyroscopic term keeps the value of the step's start"
        )
    assert free.with_others([late]).text.endswith("omega moves by omega-dot of the step's start")
    assert "start" not in top.with_others([late]).text
    assert "start" not in free.with_others([top.of_first]).text


def test_what_is_off_is_the_channel_of_the_scenario_itself() -> None:
    """Caught: "omega is off" where it equals a sound engine's to the last bit."""
    late = Known("position", frozenset("z"), 1.0, 2.0)
    first = Known("omega", frozenset("xz"), 1.0, None)
    other = Known("omega", frozenset("y"), 2.0, None)
    assert late.with_others([first, other]).text == late.text
    assert first.with_others([late, other]).text == "omega is off"
    assert first.text.startswith("omega is off in x and z of the body alone")


def test_numbers_of_other_scenarios_make_no_other_cause() -> None:
    over = {"a": ["steps are 2 % too long"], "b": ["steps are 3 % too short"], "c": []}
    assert over_run(over["a"][0], over) == over_run(over["b"][0], over)
    assert over_run("the body sleeps", over) == "the body sleeps"


Answer = Callable[[System, System, State], Acceleration]


def with_siblings(
    answer: Answer, gravities: Sequence[Sequence[float]]
) -> tuple[Siblings, list[Case]]:
    """Tops, each right by itself, and what another system loaded after it shows."""
    loads = [{"gravity": gravity, "pivot": PIVOT} for gravity in gravities]
    found, tops = Siblings(), [case(f"top-{k}", load) for k, load in enumerate(loads)]
    for top in tops:
        states = random_states(top, 8, [1])
        right = of_forward_dynamics(top.system, states, forward_dynamics(top.system, states))
        features = features_of(top.system, top.initial)
        answers = {}
        for what, other in siblings_of(top):
            placed = place_on_pivot(other.system, states)
            made = answer(top.system, other.system, placed)
            answers[what] = (other.system, placed, SimpleNamespace(ok=True, result=vars(made)))
        result: Any = SimpleNamespace(siblings=answers, precision="float64", before={})
        found.add(Scene(top.name, top.system, features, {"forward": right}), top, result)
    return found, tops


def siblings(answer: Answer, gravities: Sequence[Sequence[float]]) -> list[str]:
    found, tops = with_siblings(answer, gravities)
    return found.causes(tops[0])


def gravity_down(first: System, other: System, states: State) -> Acceleration:
    g = np.array([0.0, 0.0, -np.linalg.norm(other.load.gravity)])
    return forward_dynamics(replace(other, load=replace(other.load, gravity=g)), states)


def test_a_gravity_of_which_the_direction_is_ignored_shows_in_a_sibling() -> None:
    (text,) = siblings(gravity_down, [[0.0, 0.0, -9.81]])
    ignored = "gravity points along -z, whatever direction was requested"
    assert text == f"either {ignored}, or {AFTER_ANOTHER}"


def test_what_is_left_over_of_a_first_system_is_named() -> None:
    def kept(first: System, other: System, states: State) -> Acceleration:
        load = replace(other.load, gravity=first.load.gravity)
        return forward_dynamics(replace(other, load=load), states)

    (text,) = siblings(kept, [[0.0, 0.0, -9.81], [3.0, 0.0, -8.0]])
    assert text == f"{AFTER_ANOTHER}: its gravity"


def test_a_cause_of_other_scenarios_is_tried_on_the_siblings() -> None:
    """Caught: a cause that other scenarios name, taken for that of siblings it does not make."""
    found, (top,) = with_siblings(gravity_down, [[0.0, 0.0, -9.81]])
    by_text = {one.text: Candidate((one,)) for one in hypotheses(top.system)}
    assert found.follow(top, by_text["gravity points along -z, whatever direction was requested"])
    assert not found.follow(top, by_text["gravity is missing"])
