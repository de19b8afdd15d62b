"""Random systems in `check`, and the simplest system that fails.

What these tests catch: random systems that are not those of their seed, or that a baseline or an
exception holds to something; a search that loses the failure, or keeps what does not matter; a
printed file that does not fail when it is run alone.
"""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import WRONG, omegadot, quick_scenario

import omegadot as package
from omegadot.commands.check.exceptions import DeclaredException, with_exceptions
from omegadot.commands.check.print_checks import print_checks, print_json
from omegadot.commands.check.result import PASSED, Check, Result
from omegadot.commands.check.select import Arguments, select
from omegadot.commands.check.shrink import _candidates, kinds_of_failure, shrink
from omegadot.commands.check.simpler import SIMPLER
from omegadot.commands.check.tables import ingredients, scaled, tables_of
from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of
from omegadot.harness.random_cases import random_case
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.scenarios import load_scenario, scenario, scenario_of
from omegadot.scenarios.random_traits import BLOCK
from omegadot.scenarios.writing import to_toml

FORGETS = f"{WRONG}:DampedForgetsTorque"


def names(**arguments: Any) -> list[str]:
    return [case.name for case in select(Arguments(engines=["reference"], **arguments)).cases]


def test_random_systems_stand_next_to_the_built_in_ones() -> None:
    whole = names()
    assert len(whole) == len(names(random=0)) + BLOCK
    assert whole[-1] == f"random-0-{BLOCK - 1}"
    assert names(scenarios=["sphere"]) == ["sphere"]
    assert names(scenarios=["random-3-4"]) == ["random-3-4"]
    some = names(scenarios=["sphere", "random-7-1"], random=3, seed=7)
    assert some == ["sphere", "random-7-1", "random-7-0", "random-7-2"]
    found = select(Arguments(engines=["reference"], scenarios=["random-7-1"], random=2, seed=7))
    assert found.drawn == {"random-7-0"}


@pytest.mark.parametrize("arguments", [{"random": -1}, {"random": 1.5}, {"seed": -2}])
def test_wrong_numbers_are_refused(arguments: dict[str, Any]) -> None:
    with pytest.raises(UsageError, match=r"--(random|seed) .*: give a whole number"):
        select(Arguments(engines=["reference"], **arguments))


def test_an_exception_may_excuse_a_random_system_and_requires_nothing_of_it() -> None:
    known = DeclaredException("toy", "toy-*-equation", "slow", "https://example.org", "toy.toml")
    check, fails = Check("toy", "random-0-1", "equation"), Result("fail", "off")
    assert with_exceptions(check, fails, [known]).verdict == "declared"
    assert with_exceptions(check, PASSED, [known]) == PASSED
    named = replace(known, check="toy-random-0-1-equation")
    assert with_exceptions(check, PASSED, [named]).verdict == "fail"


@pytest.fixture(scope="module")
def checked() -> Any:
    """Three systems of which one has a damping and a torque."""
    return package.check(FORGETS, random=2, seed=5, scenarios="damped-tumble")


def test_the_same_system_fails_alone_by_its_name(checked: Any) -> None:
    failed = {c.scenario for c, result in checked.by_check.items() if result.verdict == "fail"}
    assert failed == {"random-5-1"} <= checked.drawn
    alone = package.check(FORGETS, scenarios="random-5-1", shrink=False)
    assert set(alone.failures) == set(checked.failures)
    assert (alone.drawn, alone.failing) == (frozenset(), ())


def test_a_failing_system_is_shrunk_to_what_the_fault_needs(checked: Any, tmp_path: Path) -> None:
    (found,) = checked.failing
    assert found.check.gate == "equation"
    left = re.sub(r" (of|in) [^,]*", "", ", ".join(found.has))
    assert left in ("a damping, a torque", "moments, a damping, a torque")
    file = tmp_path / f"{found.scenario.name}.toml"
    file.write_text(found.toml)
    assert load_scenario(file) == found.scenario
    again = omegadot(*found.command.split()[1:], "--no-shrink", folder=tmp_path)
    assert again.code == 1
    assert "omega_dot: residual" in again.out
    assert package.check(f"{WRONG}:Sound", scenarios=file).passed


def test_shrinking_ends_with_its_seconds(checked: Any) -> None:
    (found,) = checked.failing
    choice = select(Arguments(adapters=[FORGETS])).choices[0]
    how = (random_case(5, 1), choice, 60.0, 0, "omegadot check")
    left = shrink(found.check, *how, seconds=0.0)
    assert left is not None
    assert (left.trials, left.finished) == (1, False)
    run = left.scenario.run
    assert run.duration == max(run.timesteps)  # the equations need no more than a step


def test_a_shrunk_system_is_printed_with_its_command(
    checked: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    print_json(checked)
    (found,) = json.loads(capsys.readouterr().out)["failing"]
    assert found["check"] == "dampedforgetstorque-random-5-1-equation"
    assert scenario_of(_toml(found["scenario"]), "printed").name == "random-5-1-shrunk"
    assert found["command"] == f"omegadot check {FORGETS} --scenario random-5-1-shrunk.toml"
    print_checks(checked)
    printed = capsys.readouterr().out
    assert found["scenario"].splitlines()[-1] in printed
    assert found["command"] in printed
    assert found["cause"]
    assert f"Likely cause, found on random-5-1: {found['cause']}" not in printed  # the only one
    assert found["cause"] in printed
    assert re.search(r"What is left in it: [^.]*a damping of .* and a torque in", printed)
    assert re.search(r"^2 random systems +pass +1 fail, 1 pass", printed, re.MULTILINE)


def test_the_smallest_system_fails_by_its_own_motion(tmp_path: Path) -> None:
    """Caught: a body that spins from the identity, of which nothing is wrong to be seen."""
    file = quick_scenario(tmp_path)
    (found,) = package.check(f"{WRONG}:OmegaDotInWorld", scenarios=file).failing
    assert found.at == {}
    assert "a start of several components of omega" in found.has
    rows = package.run(found.scenario, f"{WRONG}:OmegaDotInWorld").record.metrics
    on_path = rows.filter(engine="omegadotinworld", metric="residual_on_path", verdict="fail")
    assert len(on_path) == 1


def test_a_turned_start_is_tried_in_few_digits() -> None:
    tables = tables_of(random_case(0, 1), "one")
    turns = [t for s in SIMPLER if sum(map(bool, t := s(tables)["initial"]["orientation"])) == 2]
    assert turns == [[0.6, 0.8, 0.0, 0.0], [0.6, 0.0, 0.8, 0.0], [0.6, 0.0, 0.0, 0.8]]
    simple = {**tables, "initial": {**tables["initial"], "orientation": turns[1]}}
    assert all(s(simple)["initial"]["orientation"] in ([1.0, 0, 0, 0], turns[1]) for s in SIMPLER)


@pytest.mark.parametrize(
    ("name", "gate", "what"),
    [
        ("FastSpinsDamped", "equation", "the equation is wrong"),
        ("FastStepsDamped", "scheme", "a single step fails"),
    ],
)
def test_a_state_off_the_motion_is_printed(
    name: str, gate: str, what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Caught: a scenario to type in that shows nothing, as the gate failed at another state."""
    checked = package.check(f"{WRONG}:{name}", scenarios=quick_scenario(tmp_path))
    (found,) = checked.failing
    assert found.check.gate == gate
    assert np.linalg.norm(found.scenario.initial.angular_velocity) < 5.0
    assert np.linalg.norm(found.at["angular_velocity"]) > 5.0
    assert set(found.at) == {"orientation", "angular_velocity", "position", "linear_velocity"}
    print_checks(checked)
    printed = capsys.readouterr().out
    assert f"It fails at a state that is none of its run: {what} at orientation = [" in printed
    print_json(checked)
    assert json.loads(capsys.readouterr().out)["failing"][0]["at"] == found.at


def _toml(text: str) -> dict[str, Any]:
    return tomllib.loads(text)


def test_one_of_each_kind_is_shrunk_and_consequences_are_not() -> None:
    cases = {name: case_of(scenario(name), ()) for name in ("t-handle", "sphere")}
    fail, run = Result("fail"), {"integrator": "a", "timestep": 0.02}
    checks = {
        Check("toy", "t-handle", "scheme", **run): fail,
        Check("toy", "sphere", "scheme", **run): fail,
        Check("toy", "sphere", "trajectory", **run): fail,
        Check("toy", "sphere", "trajectory", "b", 0.01): fail,
        Check("toy", "sphere", "invariants", "c", 0.01): PASSED,
    }
    found = kinds_of_failure(checks, cases)
    assert [(one.scenario, one.gate, one.integrator) for one in found] == [
        ("sphere", "scheme", "a"),
        ("sphere", "trajectory", "b"),
    ]
    of_the_engine = {Check("toy", "sphere", "equation"): fail, **checks}
    assert [one.gate for one in kinds_of_failure(of_the_engine, cases)] == ["equation"]


def test_other_units_leave_the_motion_as_it_is() -> None:
    case = random_case(0, 0)
    tables = tables_of(case, "as-it-is")
    other = case_of(scenario_of(scaled(tables, 3.0, 0.5, 7.0), "scaled"), ())
    before = forward_dynamics(case.system, case.initial)
    after = forward_dynamics(other.system, other.initial)
    np.testing.assert_allclose(after.angular, 49.0 * before.angular, rtol=1e-12)
    np.testing.assert_allclose(after.linear, 98.0 * before.linear, rtol=1e-12, atol=1e-300)
    assert [s.steps for s in other.sweeps] == [s.steps for s in case.sweeps]


@pytest.mark.parametrize("index", range(BLOCK))
def test_a_system_that_fails_whatever_is_left_becomes_the_simplest(index: int) -> None:
    case: Case = random_case(2, index)
    start = tables_of(case, f"{case.name}-shrunk")
    search, simplest = _candidates(start), start
    tables, count = next(search), 1
    while True:
        simplest = tables
        try:
            tables = search.send(True)
        except StopIteration:
            break
        count += 1
    assert count < 3 * len(SIMPLER)
    found = scenario_of(simplest, "simplest")
    assert set(ingredients(found)) <= {"a start at rest"}
    assert np.count_nonzero(found.initial.angular_velocity) <= 1
    assert len(found.run.timesteps) == 1
    assert scenario_of(_toml(to_toml(found)), "again") == found


def test_of_two_torques_one_is_left_where_it_alone_shows_a_fault() -> None:
    """Caught: a pair of torques that goes as a whole or not at all, or in other units by half."""
    (index, *_) = (n for n in range(BLOCK) if len(random_case(2, n).scenario.load.torque) == 2)
    tables = tables_of(random_case(2, index), "one")
    found = scenario_of(tables, "one")
    assert {"a torque in body axes", "a torque in world axes"} <= set(ingredients(found))
    body, world = tables["load"]["torque"]
    left = [simpler(tables)["load"]["torque"] for simpler in SIMPLER]
    assert [body] in left
    assert [world] in left
    largest = np.abs(world["value"]) == np.max(np.abs(world["value"]))
    along = {"frame": "world", "value": np.where(largest, world["value"], 0.0).tolist()}
    assert [body, along] in left
    assert scenario_of(_toml(to_toml(found)), "again") == found
    for one, other in zip(
        tables["load"]["torque"], scaled(tables, 3.0, 0.5, 7.0)["load"]["torque"], strict=True
    ):
        assert one["frame"] == other["frame"]
        np.testing.assert_allclose(other["value"], 49.0 / 0.75 * np.array(one["value"]), rtol=1e-12)


def test_every_built_in_scenario_can_be_written() -> None:
    for name in ("nesc-checkcase-2", "heavy-top", "driven-world", "damped-tumble", "free-bar"):
        found = scenario(name)
        assert scenario_of(_toml(to_toml(found)), name) == found


def test_a_long_step_that_an_engine_refuses_is_skipped_where_nobody_chose_it() -> None:
    how = {"integrators": "semi-implicit-euler", "shrink": False}
    found = package.check(f"{WRONG}:RefusesLongSteps", scenarios="sphere", random=4, **how)
    skipped = [one for one in found.results.values() if one.verdict == "skip"]
    assert found.passed
    assert {one.message.partition(":")[0] for one in skipped} == {
        "raised at this step and at no finer one"
    }
    coarse = next(c for c in map(random_case, (0,) * 4, range(4)) if c.sweeps[0].steps in (13, 15))
    assert not package.check(f"{WRONG}:RefusesLongSteps", scenarios=coarse.name, **how).passed
