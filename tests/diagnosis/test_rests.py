"""Where a body is put to sleep: by the quantity whose limit holds on every scenario, or by none."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from in_process import builtin, declared, truth_of
from numpy.typing import NDArray
from wrong_equations import PIVOT, TENSOR, case

from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.vanishing.jumps import jump_cause
from omegadot.diagnosis.stepping.vanishing.rests import Rests, RunWithRests, rests_of, sleep_law
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import vanishing_steps
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.gates.steps.probe import Probe
from omegadot.reference_impl.energy import kinetic_energy
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import Array, State, System

Rule = Callable[[System, State], NDArray[np.bool_]]
SCHEME, STEPS = "semi-implicit-euler", 9
# Of sizes and masses that no two quantities go together over.
CASES = tuple(
    case(f"body-{k}", load, mass, (size * np.asarray(TENSOR)).tolist())
    for k, (load, mass, size) in enumerate(
        [
            ({}, 1.0, 1.0),
            ({}, 20.0, 1.0),
            ({"pivot": PIVOT}, 1.0, 30.0),
            ({"pivot": PIVOT}, 9.0, 0.1),
            ({}, 0.1, 0.2),
        ]
    )
)


def probed(one: Case) -> Probe:
    """States of many speeds: by octaves of the largest."""
    states = random_states(one, 60, [1])
    slower = 2.0 ** -np.linspace(0.0, 8.0, len(states.position))[:, None]
    states = place_on_pivot(
        one.system,
        replace(
            states,
            angular_velocity=slower * states.angular_velocity,
            linear_velocity=slower[::-1] * states.linear_velocity,
        ),
    )
    return Probe(states, np.tile(1e-6 * 0.5 ** np.arange(STEPS), (len(slower), 1)))


def stepped(one: Case, probe: Probe, rule: Rule) -> State:
    """Steps that move nothing, and put a body to rest."""
    moves = ~rule(one.system, probe.states)[:, None]
    w, v = probe.states.angular_velocity * moves, probe.states.linear_velocity * moves
    after = replace(probe.states, angular_velocity=w, linear_velocity=v)
    return State(*(np.repeat(values[:, None], STEPS, axis=1) for values in vars(after).values()))


def of_cases(rule: Rule) -> dict[str, Rests]:
    found = {}
    for one in CASES:
        probe = probed(one)
        found[one.name] = rests_of(one.system, probe, stepped(one, probe, rule), [])
    return found


def by_energy_per_mass(system: System, states: State) -> NDArray[np.bool_]:
    return np.asarray(kinetic_energy(system, states) / float(system.body.mass) < 0.02)


def by_omega(system: System, states: State) -> NDArray[np.bool_]:
    return np.asarray(np.linalg.norm(states.angular_velocity, axis=-1) < 0.3)


def by_mass_and_omega(system: System, states: State) -> NDArray[np.bool_]:
    """No quantity of the list has a limit."""
    size = np.linalg.norm(states.angular_velocity, axis=-1)
    return np.asarray(size < 0.1 * np.cbrt(float(system.body.mass)))


@pytest.mark.parametrize(
    ("rule", "quantity", "limit"),
    [
        (by_energy_per_mass, "its kinetic energy over its mass", 0.02),
        (by_omega, "|omega|", 0.3),
    ],
)
def test_the_limit_is_of_what_holds_over_all(rule: Rule, quantity: str, limit: float) -> None:
    """Caught: limits of omega that contradict one another, "below 0.311 and 0.568 rad/s"."""
    text = sleep_law([*of_cases(rule).values()])
    start = f"the body is put to sleep where {quantity} is below a limit between "
    assert text.startswith(start)
    low, high = (float(part.split()[0]) for part in text.removeprefix(start).split(" and "))
    assert low <= limit <= high


def test_limits_of_omega_and_speed_may_hold_at_once() -> None:
    """As engines have that put a body to sleep by two thresholds."""

    def by_both(system: System, states: State) -> NDArray[np.bool_]:
        sizes = (states.angular_velocity, states.linear_velocity)
        w, v = (np.linalg.norm(one, axis=-1) for one in sizes)
        return np.asarray((w < 0.4) & (v < 0.9))

    text = sleep_law([*of_cases(by_both).values()])
    found = [float(one) for one in re.findall(r"[0-9.]+(?= and|\b(?= rad/s| m/s))", text)]
    assert text.startswith("the body is put to sleep where |omega| is below a limit between ")
    assert found[0] <= 0.4 <= found[1]
    assert found[2] <= 0.9 <= found[3]


def test_no_limit_is_named_where_none_holds_over_all() -> None:
    assert sleep_law([*of_cases(by_mass_and_omega).values()]) == ""


def test_one_scenario_has_several_limits_or_none() -> None:
    """Of one mass the energy and the energy over it are the same."""
    for one in of_cases(by_energy_per_mass).values():
        text = sleep_law([one])
        assert text == "" or ("either" in text and ", or its kinetic energy over its mass" in text)


def test_a_scenario_that_shows_no_sleep_has_none() -> None:
    engine, known = EngineOverScenarios(), of_cases(by_energy_per_mass)
    engine.integrators["one"].asleep.rests |= known
    engine.integrators["sound"].asleep.rests |= of_cases(
        lambda _, s: np.zeros(len(s.position), bool)
    )
    assert [bool(engine.sleep("one", name)) for name in known] == [
        one.seen for one in known.values()
    ]
    assert any(one.seen for one in known.values())
    assert not any(engine.sleep("sound", name) for name in known)
    assert engine.sleep("one", "another") == ""


def test_of_one_scenario_the_jump_names_no_limit() -> None:
    """Caught: a limit of omega where the energy has one."""
    one = CASES[0]
    probe = probed(one)
    text = jump_cause(vanishing_steps(one.system, probe, stepped(one, probe, by_omega)))
    assert text == "the body is put to sleep: omega is set to zero at some states"


@pytest.mark.parametrize("every", [1, 2])
def test_a_run_that_falls_asleep_is_seen_and_shows_no_limit(every: int) -> None:
    """Caught: a limit of where a run falls asleep, which may have waited below a higher one."""
    whole = builtin("damped-tumble")
    truth, integrator = truth_of(whole, (SCHEME,)), declared(SCHEME, SCHEME)
    sweep = replace(whole.sweeps_of(integrator)[0], every=every, steps=20)
    exact = truth.at(sweep)
    run = ReportedRun(
        whole, truth, integrator, sweep, sweep.times, exact, exact, np.ones(len(sweep.times))
    )
    own = run.stepped()
    w = np.array(own.angular_velocity)
    w[6:] = 0.0
    one = RunWithRests(replace(own, angular_velocity=w), exact)
    assert one.rests
    found = rests_of(whole.system, None, None, [one])
    assert found.seen
    assert found.known == 0
    sizes: Array = np.linalg.norm(own.angular_velocity, axis=-1)
    assert found.moving["|omega|"] == pytest.approx(np.min(sizes[1:6]), rel=1e-12)
    assert not replace(one, state=own).rests


def test_few_states_that_chance_sorts_name_no_limit() -> None:
    """Caught: a limit of a few states at rest beside a few that move."""
    known = [*of_cases(by_omega).values()]
    assert sleep_law([replace(one, known=1, left=12) for one in known])
    assert sleep_law([replace(one, known=1, left=0) for one in known]) == ""
