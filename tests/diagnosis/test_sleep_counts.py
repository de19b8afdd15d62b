"""Runs that fall asleep after some steps in a row below a limit: of what, and after how many."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from wrong_equations import PIVOT, TENSOR, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.diagnosis.stepping.vanishing.sleep_counts import sleeping_runs
from omegadot.diagnosis.stepping.vanishing.sleep_laws import Sleeps
from omegadot.gates.case import Case, Sweep
from omegadot.reference_impl.energy import kinetic_energy
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State, System

Rule = Callable[[System, State], NDArray[np.bool_]]
SCHEME, H, STEPS = "semi-implicit-euler", 0.05, 60
LENGTHS = (H, 0.08, 0.11)
INTEGRATOR = Integrator("own", SCHEME, dict.fromkeys(CHANNELS, 1))
AT_PIVOT, PUSHED = {"pivot": PIVOT}, {"gravity": [0.01, 0.0, -0.02]}


def slowed(number: int, load: dict[str, object], mass: float, size: float, slow: float) -> Case:
    """One that begins with these parts of the usual velocities."""
    one = case(f"body-{number}", load, mass, (size * np.asarray(TENSOR)).tolist())
    w, v = slow * one.initial.angular_velocity, slow * one.initial.linear_velocity
    initial = place_on_pivot(
        one.system, replace(one.initial, angular_velocity=w, linear_velocity=v)
    )
    return replace(one, initial=initial)


# Of sizes and masses that no two quantities go together over: some fall asleep on their way.
CASES = tuple(
    slowed(k, *one)
    for k, one in enumerate(
        [
            ({}, 1.0, 1.0, 0.02),
            ({}, 20.0, 1.0, 0.05),
            (PUSHED, 4.0, 8.0, 0.01),
            ({"damping": 1.5} | AT_PIVOT, 1.0, 1.0, 0.3),
            ({"damping": 4.0} | AT_PIVOT, 9.0, 0.5, 0.4),
            ({"damping": 20.0} | AT_PIVOT, 3.0, 9.0, 0.2),
            ({}, 0.1, 0.2, 0.08),
            ({}, 0.1, 30.0, 0.01),
            ({}, 1.0, 1.0, 1.0),
            ({}, 20.0, 1.0, 0.2),
            (AT_PIVOT, 1.0, 30.0, 0.05),
            (AT_PIVOT, 9.0, 0.1, 0.3),
            (PUSHED, 4.0, 8.0, 0.3),
            (AT_PIVOT, 0.5, 2.0, 1.0),
        ]
    )
)


def kept(one: Case, step: int, every: int, asleep: bool = True, h: float = H) -> KeptRun:
    """A run whose velocities are set to zero in this step, and which rests from then on."""
    state = step_body(SCHEMES[SCHEME], one.system, one.initial, h, STEPS, 1)[1]
    if asleep and step <= STEPS:
        fields = {name: np.array(values) for name, values in vars(state).items()}
        for name, values in fields.items():
            values[step:] = 0.0 if "velocity" in name else values[step]
        state = State(**fields)
    sweep = Sweep(h, STEPS, every)
    state = state[::every]
    bounds = {c: np.full(len(sweep.times) - 1, 1e-12) for c in ("omega", "attitude")}
    bounds |= {c: np.full(len(sweep.times) - 1, 1e-12) for c in ("velocity", "position")}
    fails = asleep and step <= STEPS
    return KeptRun(one.name, one.system, sweep, sweep.times, state, bounds, fails)


def falls(one: Case, rule: Rule, count: int, given: bool = False, h: float = H) -> int:
    """The step in which so many in a row are below; one more than there are where none is."""
    state = step_body(SCHEMES[SCHEME], one.system, one.initial, h, STEPS, 1)[1]
    below, quiet = rule(one.system, state), 0
    for step in range(0 if given else 1, STEPS + 1):
        quiet = quiet + 1 if below[step] else 0
        if quiet >= count:
            return step
    return STEPS + 1


def found(
    rule: Rule, count: int, given: bool = False, every: Sequence[int] = (1, 4)
) -> Sleeps | None:
    return sleeping_runs(INTEGRATOR, runs_of(rule, count, given, every))


def runs_of(
    rule: Rule,
    count: int,
    given: bool = False,
    every: Sequence[int] = (1, 4),
    cases: Sequence[Case] = CASES,
) -> list[KeptRun]:
    """Of several lengths of step: of one alone a number of steps is a time as well."""
    return [
        kept(one, falls(one, rule, count, given, h), n, h=h)
        for one in cases
        for n in every
        for h in LENGTHS
    ]


def by_energy_per_mass(system: System, states: State) -> NDArray[np.bool_]:
    return np.asarray(kinetic_energy(system, states) / float(system.body.mass) < 0.02)


def by_energy(system: System, states: State) -> NDArray[np.bool_]:
    return np.asarray(kinetic_energy(system, states) < 0.03)


def by_omega(_: System, states: State) -> NDArray[np.bool_]:
    return np.asarray(np.linalg.norm(states.angular_velocity, axis=-1) < 0.17)


@pytest.mark.parametrize("count", [3, 5, 12])
@pytest.mark.parametrize(
    ("rule", "quantity", "limit"),
    [
        (by_energy_per_mass, "its kinetic energy over its mass", 0.02),
        (by_energy, "its kinetic energy", 0.03),
        (by_omega, "|omega|", 0.17),
    ],
)
def test_the_limit_and_the_count_are_of_all_runs(
    rule: Rule, quantity: str, limit: float, count: int
) -> None:
    """Caught: no limit at all, as a body moves on for some steps below it."""
    one = found(rule, count)
    assert one is not None
    start = f"the body is put to sleep where {quantity} is below a limit between "
    assert one.statement.startswith(start)
    assert one.statement.endswith(f" in {count} steps in a row")
    low, high = (
        float(part.split()[0]) for part in one.statement.removeprefix(start).split(" and ")
    )
    assert low <= limit <= high
    asleep = {one.name for one in CASES if falls(one, rule, count) <= STEPS}
    assert one.names == asleep
    assert len(asleep) < len(CASES)


def test_the_state_that_is_given_may_be_counted() -> None:
    """Caught: one step fewer than it is where the body falls asleep on its way."""
    one = found(by_energy_per_mass, 5, given=True)
    assert one is not None
    assert one.statement.endswith(" in 5 states in a row, the given one among them")


def test_the_time_may_be_one_and_not_the_count() -> None:
    """Caught: no law, as shorter steps are more until the same time has passed."""
    runs = list[KeptRun]()
    for h in (0.05, 0.08, 0.11):
        count = int(np.ceil(0.4 / h - 1e-9))
        for one in CASES:
            step = falls(one, by_energy_per_mass, count, h=h)
            runs += [kept(one, step, every, h=h) for every in (1, 4)]
    found = sleeping_runs(INTEGRATOR, runs)
    assert found is not None
    start = (
        "the body is put to sleep where its kinetic energy over its mass is below a limit between "
    )
    assert found.statement.startswith(start)
    last = found.statement.partition(" for a time between ")[2].split()
    assert float(last[0]) <= 0.4 <= float(last[2])
    assert float(last[2]) - float(last[0]) < 0.1


def by_both(_: System, states: State) -> NDArray[np.bool_]:
    turns, moves = (
        np.linalg.norm(v, axis=-1) for v in (states.angular_velocity, states.linear_velocity)
    )
    return np.asarray((turns < 0.17) & (moves < 0.1))


@pytest.mark.parametrize("count", [3, 6])
def test_two_limits_may_hold_at_once(count: int) -> None:
    """Caught: no law, or one of a quantity that is small where both are."""
    one = found(by_both, count)
    assert one is not None
    start = "the body is put to sleep where "
    assert one.statement.startswith(start)
    assert one.statement.endswith(f" in {count} steps in a row")
    number = r"([-.\de]+)"
    limits = re.search(
        rf"\|omega\| is below a limit between {number} and {number} rad/s "
        rf"and its speed is below one between {number} and {number} m/s",
        one.statement,
    )
    assert limits is not None, one.statement
    low, high, slow, fast = map(float, limits.groups())
    assert low <= 0.17 <= high
    assert slow <= 0.1 <= fast


def test_a_body_that_moves_and_does_not_turn_falls_asleep_as_well() -> None:
    """Caught: what its omega is not off in was taken for another cause."""
    turns = slowed(len(CASES), {}, 20.0, 1.0, 0.2)
    flies = replace(turns, initial=replace(turns.initial, angular_velocity=np.zeros(3)))
    runs = runs_of(by_omega, 5, cases=(*CASES, flies))
    found = sleeping_runs(INTEGRATOR, runs)
    assert found is not None
    assert "|omega| is below a limit" in found.statement
    assert flies.name in found.names


def test_runs_that_stop_without_a_limit_are_not_named() -> None:
    """Caught: a limit of whatever happens to be small where a run stops."""
    for stop in (lambda k: 5, lambda k: 7 + 3 * (k % 4), lambda k: 9 if k % 3 else STEPS + 1):
        runs = [kept(one, stop(k), n) for k, one in enumerate(CASES) for n in (1, 4)]
        assert sleeping_runs(INTEGRATOR, runs) is None
    sound = [kept(one, 0, n, asleep=False) for one in CASES for n in (1, 4)]
    assert sleeping_runs(INTEGRATOR, sound) is None


def test_a_run_that_is_wrong_before_it_rests_is_not_explained() -> None:
    runs = runs_of(by_energy_per_mass, 5, every=(4,))
    wrong = replace(runs[0].state, position=1.1 * runs[0].state.position)
    one = sleeping_runs(INTEGRATOR, [replace(runs[0], state=wrong), *runs[1:]])
    assert one is not None
    assert runs[0].name not in one.names


def test_one_law_is_named_of_all_integrators() -> None:
    """Caught: a limit of its own for each, as wide as its own runs leave it."""
    engine = EngineOverScenarios()
    for name, every in (("one", 1), ("two", 4)):
        runs = engine.integrators[name].runs
        runs.integrator = replace(INTEGRATOR, name=name)
        runs.kept += runs_of(by_energy_per_mass, 5, every=(every,))
    engine.integrators["sound"].runs.integrator = replace(INTEGRATOR, name="sound")
    texts = {engine.sleep(name, CASES[0].name) for name in ("one", "two")}
    assert len(texts) == 1
    assert " in 5 steps in a row" in texts.pop()
    assert engine.sleep("one", CASES[8].name) == ""
    assert engine.sleep("sound", CASES[0].name) == ""


def of_time(
    rule: Rule, seconds: float, lengths: Sequence[float], cases: Sequence[Case] = CASES
) -> str:
    """What is named of runs that wait for so long below the limit."""
    runs = [
        kept(one, falls(one, rule, int(np.ceil(seconds / h - 1e-9)), h=h), every, h=h)
        for h in lengths
        for one in cases
        for every in (1, 4)
    ]
    found = sleeping_runs(INTEGRATOR, runs)
    return found.statement if found is not None else ""


@pytest.mark.parametrize(
    ("rule", "cases", "lengths", "seconds"),
    [
        (by_omega, CASES[:10], LENGTHS, 0.6),
        (by_omega, CASES[3:12], (0.05,), 0.25),
        (by_energy_per_mass, CASES, (0.05, 0.1), 0.6),
        (by_energy, (*CASES[3:6], *CASES[8:]), (0.05, 0.1), 0.6),
    ],
)
def test_no_limit_is_named_without_a_time_where_one_may_have_passed(
    rule: Rule, cases: Sequence[Case], lengths: Sequence[float], seconds: float
) -> None:
    """Caught: a lower limit and no time, by counts that were looked at first."""
    text = of_time(rule, seconds, lengths, cases)
    assert text == "" or " for a time between " in text


def test_a_limit_alone_is_named_where_no_number_and_no_time_fit() -> None:
    """Caught: "for a time between 0 and 0.05 s", or nothing, of bodies that do not wait."""
    one = found(by_energy_per_mass, 1)
    assert one is not None
    assert "its kinetic energy over its mass is below a limit between" in one.statement
    assert "in a row" not in one.statement
    assert "for a time" not in one.statement


def test_of_one_length_of_step_a_number_of_steps_is_a_time_as_well() -> None:
    """Caught: either of the two, which runs of other steps may contradict."""
    runs = [kept(one, falls(one, by_energy_per_mass, 5), n) for one in CASES for n in (1, 4)]
    assert sleeping_runs(INTEGRATOR, runs) is None


def test_few_scenarios_that_chance_sorts_name_no_law() -> None:
    """Caught: a limit that two bodies at rest and one that moves happen to leave."""
    assert of_time(by_omega, 0.25, LENGTHS, (CASES[0], CASES[3], CASES[8])) == ""
