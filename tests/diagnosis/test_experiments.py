"""When a wrong engine is wrong, found by changing one thing of a system at a time."""

from __future__ import annotations

import re
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, case, gyroscopic, with_torque

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import of_forward_dynamics
from omegadot.diagnosis.equations.hypotheses import hypotheses
from omegadot.diagnosis.experiments.conditioned import (
    condition_in,
    conditioned,
    not_always,
    without_condition,
)
from omegadot.diagnosis.experiments.experiment import Experiment
from omegadot.diagnosis.experiments.judges import MOST, ForwardJudge, shown_in
from omegadot.diagnosis.experiments.lines import between
from omegadot.diagnosis.experiments.observed import Observations, Trial
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.experiments.sorting import contradicted
from omegadot.diagnosis.experiments.step_lengths import limit_of_length
from omegadot.diagnosis.experiments.traits import START, traits_of
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.harness.drive import Driver
from omegadot.harness.requests.variations import other_bodies, other_loads, other_states
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.reference_impl.stepping import stack
from omegadot.reference_impl.system import Acceleration, Array, State, System
from omegadot.workers.harness_end.process import Answer

FREE = case("free", {})
TENSOR = [[1.2, 0.1, -0.05], [0.1, 1.5, 0.07], [-0.05, 0.07, 2.0]]
TOP = case("top", {"gravity": GRAVITY, "pivot": PIVOT, "damping": 0.1}, 2.0, TENSOR)
DRIVEN = case("driven", {"gravity": GRAVITY, "pivot": PIVOT, "torque": BODY_TORQUE})
BOTH = [BODY_TORQUE, {"frame": "world", "value": [-0.7, 0.2, 0.5]}]
PUSHED = case("pushed", {"torque": BOTH})
ROUND = case("round", {}, 1.0, np.diag([1.0, 1.0, 1.7]).tolist())
ROD = case("rod", {}, 3.0, np.diag([9.0, 8.8, 0.4]).tolist())
PLATE = case("plate", {"pivot": PIVOT}, 1.0, np.diag([4.0, 4.2, 8.1]).tolist())
Where = Callable[[System, State], Any]


class Toy:
    """A driver whose engine loses its gyroscopic term where a condition holds."""

    def __init__(self, where: Where) -> None:
        self.where, self.requests = where, 0

    def found(self, system: System, states: State) -> Acceleration:
        lost = np.reshape(
            np.broadcast_to(self.where(system, states), len(states.position)), (-1, 1)
        )
        return with_torque(system, states, lost * gyroscopic(system, states))

    def request(self, one: Case, operation: str, states: State) -> Answer:
        assert operation == "forward"
        self.requests += 1
        return Answer("ok", result=vars(self.found(one.system, states)))


def missing() -> Candidate:
    return next(
        Candidate((h,))
        for h in hypotheses(FREE.system)
        if h.text == "the gyroscopic term is missing"
    )


def experiment(where: Where, cases: tuple[Case, ...], named: bool = True) -> tuple[str, Toy]:
    toy, drawn = Toy(where), list[Trial]()
    one = missing() if named else None
    for each in cases:
        states = random_states(each, 40, [3])
        evidence = of_forward_dynamics(each.system, states, toy.found(each.system, states))
        drawn.append(Trial(each.system, states, *shown_in(evidence, one)))
    judge = ForwardJudge(Requests(cast(Driver, toy)), cases[0], EPS, one)
    return Experiment(judge, drawn).condition(), toy


def torque_acts(system: System, states: State) -> Any:
    load = system.load
    lever = 0.0 if load.pivot is None else system.body.center_of_mass - load.pivot
    weighs = load.pivot is not None and np.any(load.gravity) and np.any(lever)
    applied = np.any(load.torque_body) or np.any(load.torque_world)
    damped = np.any(load.damping) and np.any(states.angular_velocity, axis=-1)
    return damped | bool(applied) | bool(weighs)


def pitch(_: System, states: State) -> Any:
    w, x, y, z = np.moveaxis(states.orientation, -1, 0)
    return np.abs(2.0 * (w * y - x * z)) > 0.9


WHERE: dict[str, tuple[Where, str]] = {
    "no torque": (
        lambda s, x: ~torque_acts(s, x),
        "no torque acts (applied, of damping or of the weight)",
    ),
    "any torque": (torque_acts, "a torque acts (applied, of damping or of the weight)"),
    "pivoted": (lambda s, _: s.load.pivot is not None, "the body is pivoted"),
    "scalar part": (
        lambda _, x: x.orientation[:, 0] < 0.0,
        "the quaternion's scalar part is negative",
    ),
    "component": (lambda _, x: x.angular_velocity[:, 1] < 0.0, "omega's y component is negative"),
    "two at once": (
        lambda s, _: s.load.pivot is not None and bool(np.any(s.load.torque_body)),
        "the body is pivoted and a torque in body axes acts",
    ),
    "order": (
        lambda s, _: np.argmin(np.diag(moving_inertia(s))) == 0,
        "Ixx is the least on the diagonal",
    ),
    "equal": (
        lambda s, _: abs(moving_inertia(s)[0, 0] - moving_inertia(s)[1, 1]) < 1e-9,
        "Ixx and Iyy about what stays are equal",
    ),
}
LIMITS: dict[str, tuple[Where, str, float]] = {
    "fast": (
        lambda _, x: np.linalg.norm(x.angular_velocity, axis=-1) > 3.0,
        "|omega| is above a limit between",
        3.0,
    ),
    "lock": (pitch, "the size of the sine of the pitch, |2 (w y - x z)|, is above", 0.9),
    "heavy": (lambda s, _: s.body.mass > 20.0, "the mass is above a limit between", 20.0),
    # of one body scaled, its trace and its other moments have a limit as well
    "long": (
        lambda s, _: np.linalg.eigvalsh(moving_inertia(s))[-1] > 7.0,
        "the largest moment of inertia about what stays is above a limit between",
        7.0,
    ),
    "pushed": (
        lambda s, x: np.linalg.norm(applied_torque(s, x) + 0.0 * x.angular_velocity, axis=-1) > 1.1,
        "the size of the applied torque, of both frames together, is above a limit between",
        1.1,
    ),
}


@pytest.mark.parametrize("name", WHERE)
def test_a_condition_is_named(name: str) -> None:
    """Of two systems at most. Caught: the gyroscopic term is missing, whatever the system is."""
    where, text = WHERE[name]
    cases = (FREE, TOP) if name not in ("equal", "two at once") else (FREE, TOP, DRIVEN, ROUND)
    found, toy = experiment(where, cases)
    assert found in (text, text.replace(" about what stays", ""))
    assert toy.requests <= MOST


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_is_closed_in_upon(name: str) -> None:
    where, text, limit = LIMITS[name]
    more = {"pushed": (PUSHED,), "long": (ROUND, ROD, PLATE)}
    found, toy = experiment(where, (FREE, TOP, *more.get(name, ())))
    assert found.startswith(text)
    low, high = map(float, re.findall(r"between (\S+) and (\S+)", found)[0])
    assert low < limit < high
    assert high - low < 0.1 * limit
    assert toy.requests <= MOST


def nearly_symmetric(system: System, _: State) -> Any:
    x, y, z = np.diag(moving_inertia(system))
    return bool(abs(x - y) < 0.1 * z)


def test_moments_that_nearly_agree_are_a_condition() -> None:
    """Caught: no products taken for the condition, or no condition at all."""
    near = case("near", {}, 1.0, np.diag([2.0, 2.15, 2.6]).tolist())
    found, toy = experiment(nearly_symmetric, (near, FREE, TOP, DRIVEN))
    assert found.startswith("|Ixx - Iyy| / Izz is below a limit between")
    low, high = map(float, re.findall(r"between (\S+) and (\S+)", found)[0])
    assert low < 0.1 < high
    assert toy.requests <= MOST


def chance(system: System, _: State) -> bool:
    """By nothing that has a name."""
    numbers = (system.body.mass, np.trace(system.body.inertia), system.load.damping)
    vectors = (system.load.gravity, system.load.torque_body, system.body.center_of_mass)
    whole = sum(map(float, numbers)) + sum(float(np.sum(v)) for v in vectors)
    return bool(int(1e6 * abs(np.sin(1e3 * whole))) % 2)


def test_what_goes_by_no_condition_has_none() -> None:
    """Caught: one of some hundred sentences that happens to sort a few systems."""
    cases = (FREE, TOP, DRIVEN, ROUND)
    assert len({chance(one.system, random_states(one, 1, [3])) for one in cases}) == 2
    assert experiment(chance, cases)[0] == ""
    assert experiment(chance, cases, named=False)[0] == ""


@pytest.mark.parametrize("always", [True, False])
def test_what_always_acts_or_never_does_has_no_condition(always: bool) -> None:
    assert experiment(lambda *_: always, (FREE, TOP))[0] == ""


def test_an_observation_contradicts_a_condition() -> None:
    states = random_states(FREE, 4, [3])
    free = Trial(FREE.system, states, np.ones(4, dtype=bool), np.ones(4, dtype=bool))
    held = Trial(TOP.system, states, np.zeros(4, dtype=bool), np.ones(4, dtype=bool))
    assert not contradicted(Observations([free, held]), "the body is free")
    assert contradicted(Observations([free, held]), "the body is pivoted")
    assert not contradicted(Observations([free, held]), "of which nothing is known")


def test_no_request_is_made_of_an_engine_that_does_not_answer() -> None:
    toy = Toy(lambda s, _: s.load.pivot is not None)
    late = SimpleNamespace(request=lambda *_, **__: Answer("timeout", "late"))
    states = random_states(TOP, 10, [3])
    evidence = of_forward_dynamics(TOP.system, states, toy.found(TOP.system, states))
    judge = ForwardJudge(Requests(cast(Driver, late)), TOP, EPS, missing())
    one = Trial(TOP.system, states, *shown_in(evidence, missing()))
    assert Experiment(judge, [one]).condition() == ""
    assert judge.requests == 1


@pytest.mark.parametrize("one", [FREE, TOP, DRIVEN])
def test_every_variation_is_a_system_that_moves(one: Case) -> None:
    states = random_states(one, 4, [1])
    for _, system in (*other_loads(one.system), *other_bodies(one.system)):
        assert np.isfinite(forward_dynamics(system, states).angular).all()
        moments = np.linalg.eigvalsh(system.body.inertia)
        assert moments[0] > 0.0
        assert moments[2] < moments[0] + moments[1]
    for what, other in other_states(states):
        assert np.allclose(np.linalg.norm(other.orientation, axis=-1), 1.0), what


def test_no_trait_is_of_the_start() -> None:
    """An answer at a state knows nothing of it."""
    traits = traits_of(TOP.system, random_states(TOP, 3, [1]))
    known = features_of(TOP.system, TOP.initial)
    assert any(start in text for text in known.kinds for start in START)
    for text in (*traits.plain, *traits.particular, *traits.sizes):
        assert not any(start in text for start in START)


def test_half_way_by_factors() -> None:
    """Caught: a straight line, of which half is no nearer to a small number."""
    half = between(np.array([1.0, 0.0, 0.0]), np.array([1e-4, 0.0, 0.0]), 0.5)
    assert np.allclose(half, [1e-2, 0.0, 0.0])
    assert np.allclose(between(np.zeros(3), np.array([2.0, 0.0, 0.0]), 0.5), [1.0, 0.0, 0.0])


class Steps:
    """An engine whose single steps turn half as far where something holds of turn and length."""

    def __init__(self, where: Callable[[float, float], bool]) -> None:
        self.where = where

    def request(self, one: Case, _: str, states: State, timesteps: Array, **__: object) -> Answer:
        start, ends = states[0], list[State]()
        times = np.concatenate([[0.0], timesteps[0]])
        every = exact_solution(one.system, start, times).state[1:]
        for k, h in enumerate(timesteps[0]):
            exact = every[k]
            turn = h * start.angular_velocity
            less = 0.5 if self.where(float(np.linalg.norm(turn)), float(h)) else 1.0
            q = quaternion_product(start.orientation, exp_quaternion(less * turn))
            ends.append(State(q, exact.angular_velocity, exact.position, exact.linear_velocity))
        return Answer("ok", result=vars(stack([stack(ends)])))


@pytest.mark.parametrize(
    ("where", "text", "limit"),
    [
        (lambda turn, _: turn < 0.03, "a step turns the body by less than a limit", 0.03),
        (lambda turn, _: turn > 0.2, "a step turns the body by more than a limit", 0.2),
        (lambda _, h: h < 2e-2, "a step is shorter than a limit", 2e-2),
    ],
)
def test_a_turn_in_a_step_is_told_from_its_length(
    where: Callable[[float, float], bool], text: str, limit: float
) -> None:
    start = random_states(FREE, 2, [1])
    start.angular_velocity[:] = [[0.2, -0.5, 0.7], [2.0, 4.0, -3.0]]
    integrator = Integrator("one", None, {})
    found = limit_of_length(Requests(cast(Driver, Steps(where))), FREE, integrator, start, EPS)
    assert found.startswith(text)
    low, high = map(float, re.findall(r"between (\S+) and (\S+)", found)[0])
    assert low < limit * (1.0 + 1e-9)
    assert limit * (1.0 - 1e-9) < high < 1.01 * low


def test_steps_that_are_of_one_formula_have_no_limit() -> None:
    start = random_states(FREE, 2, [1])
    start.angular_velocity[:] = [[0.2, -0.5, 0.7], [2.0, 4.0, -3.0]]
    for always in (True, False):
        driver = Requests(cast(Driver, Steps(lambda *_, always=always: always)))
        assert limit_of_length(driver, FREE, Integrator("one", None, {}), start, EPS) == ""


def test_a_cause_has_one_condition() -> None:
    cause = "the damping is missing"
    some_of_all = ", on 3 scenarios, not on 17 others that would show it"
    for some in ("", some_of_all, ", not on 17 others that would show it", ", but not always"):
        assert conditioned(cause + some, "it rains") == f"{cause}, but only where it rains"
    assert not_always(cause) == f"{cause}, but not always"
    assert not_always(cause + some_of_all) == cause + some_of_all
    for law in ("is limited to 10 N m s/rad", "is rounded to 3 decimals"):  # no more is claimed
        assert not_always(f"the damping {law}") == f"the damping {law}"
    old = f"{cause}, but only where a torque acts (random-0-1; other numbers on 3 more)"
    assert condition_in(old) == "a torque acts"
    assert without_condition(old).startswith(f"{cause}, but not always (random-0-1")
    known = "none is known; omega-dot is off; it is so in scenarios alone where the body is free"
    text = "none is known; omega-dot is off; it is so only where it rains"
    assert conditioned(known, "it rains") == text
    assert (
        conditioned("either a, or b", "it rains") == "either a, or b; it is so only where it rains"
    )


def test_what_rounds_a_number_has_no_limit_of_sizes() -> None:
    """A damping of 0.6 is left as it is by two decimals: no limit below 0.6 decides."""
    limit = "the damping is below a limit between 0.48 and 0.6 N m s/rad"
    rounded = "the damping is rounded to 2 decimals"
    assert conditioned(rounded, limit) == rounded
    assert (
        conditioned(rounded, "the body is pivoted")
        == f"{rounded}, but only where the body is pivoted"
    )
    assert conditioned("the damping is missing", limit).endswith(limit)


def test_no_request_is_made_after_a_time_limit() -> None:
    """Caught: minutes of silence, of nine time limits for each of six causes."""

    class Hanging:
        requests = 0

        def request(self, *_: object, **__: object) -> Answer:
            self.requests += 1
            return Answer("ok" if self.requests < 3 else "timeout", result={})

    toy = Hanging()
    requests = Requests(cast(Driver, toy))
    outcomes = [requests.request(TOP, "forward").outcome for _ in range(5)]
    assert outcomes == ["ok", "ok", "timeout", "timeout", "timeout"]
    assert toy.requests == 3
    judge = ForwardJudge(requests, TOP, EPS, missing())
    assert judge.trial(TOP.system, random_states(TOP, 2, [1])) is None
    assert toy.requests == 3


def test_a_lever_that_is_zero_where_it_acts_is_said_as_none() -> None:
    """Caught: the pivot's distance from the origin, where there is none."""
    wrong = "in the parallel-axis theorem, the pivot's distance from the origin is taken, not from"
    text = conditioned(f"{wrong} the centre of mass", "the pivot lies at the origin")
    due = "in the dynamics, the inertia about the centre of mass is taken, not that about the pivot"
    assert text == f"{due}, but only where the pivot lies at the origin"
    kept = conditioned(f"{wrong} the centre of mass", "the body is damped")
    assert kept == f"{wrong} the centre of mass, but only where the body is damped"
