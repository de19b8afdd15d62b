"""The checks: what they are called, what they report, and `omegadot check`."""

import json
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest
from command_line import FAULTY, QUICK, WRONG, omegadot, quick_scenario

from omegadot.commands.check.check import arguments_of
from omegadot.commands.check.check_result import CheckResult
from omegadot.commands.check.compare import baseline_checks
from omegadot.commands.check.coverage import coverage
from omegadot.commands.check.judge import CAUSE, failure, to_read
from omegadot.commands.check.print_checks import print_checks
from omegadot.commands.check.pytest_items import CheckFailedError, CheckItem
from omegadot.commands.check.result import (
    REGISTRY,
    Check,
    Registry,
    Result,
    Subject,
    Tally,
    checks_of,
)
from omegadot.commands.check.select import Arguments, select
from omegadot.commands.check.shrink import Failing
from omegadot.gates.rows import Row
from omegadot.harness.arguments import case_of, scenarios_of
from omegadot.harness.usage import UsageError
from omegadot.scenarios import load_builtin
from omegadot.scenarios import scenario as omegadot_scenario

MUJOCO = Subject("mujoco", "4.0.0", ("RK4",), ("Euler", "RK4"))


def test_checks_are_known_before_anything_runs() -> None:
    case = case_of(load_builtin("t-handle"), (0.01, 1e-5))
    names = [check.id for check in checks_of([MUJOCO], [case])]
    assert names == [
        "mujoco-t-handle-model",
        "mujoco-t-handle-equation",
        "mujoco-RK4-t-handle-0.01-scheme",
        "mujoco-RK4-t-handle-0.01-invariants",
        "mujoco-RK4-t-handle-0.01-trajectory",
        "mujoco-RK4-t-handle-1e-05-scheme",
        "mujoco-RK4-t-handle-1e-05-invariants",
        "mujoco-RK4-t-handle-1e-05-trajectory",
    ]


def test_the_exact_solution_is_not_checked_against_itself() -> None:
    case = case_of(load_builtin("t-handle"), ())
    exact = Subject("exact", "1", ("closed-form", "series"), ("closed-form", "series"))
    assert [check.gate for check in checks_of([exact], [case])] == [
        "model",
        "equation",
        "invariants",
    ]


def test_coverage_counts_scenarios_gates_and_checks() -> None:
    cases = [case_of(load_builtin(name), ()) for name in ("t-handle", "sphere")]
    checks = checks_of([MUJOCO], cases)
    # Caught: "2 scenarios x 5 gates", which no one multiplies to 22.
    assert coverage([MUJOCO], checks) == [
        "mujoco 4.0.0 (RK4): 22 checks, model and equation on each of 2 scenarios, and scheme, "
        "invariants and trajectory in each of 6 runs"
    ]
    assert coverage([MUJOCO.whole], checks)[0].startswith("mujoco 4.0.0: ")


def test_coverage_counts_baselines_where_they_are() -> None:
    """Caught: "scheme and baseline in each of 6 runs" of baselines at the finest step alone."""
    cases = [case_of(load_builtin(name), ()) for name in ("t-handle", "sphere")]
    checks = checks_of([MUJOCO], cases)
    kept = list(baseline_checks(MUJOCO, cases, None))
    runs = "scheme, invariants and trajectory in each of 6 runs"
    assert coverage([MUJOCO], [*checks, *kept]) == [
        "mujoco 4.0.0 (RK4): 26 checks, model, equation and baseline on each of 2 scenarios, and "
        f"{runs}, and baseline in 2 of these, at the finest step"
    ]
    named = [check for check in kept if check.scenario == "sphere"]  # the other one was drawn
    (drawn,) = coverage([MUJOCO], [*checks, *named])
    assert "model and equation on each of 2 scenarios, and baseline on 1 of these, " in drawn
    longer = [replace(check, timestep=check.timestep and 2 * check.timestep) for check in named]
    (other,) = coverage([MUJOCO], [*checks, *longer])  # not the finest; perhaps of no run now
    assert "finest" not in other
    exact = replace(MUJOCO, by_accuracy={"RK4": 1e-13})
    kept = list(baseline_checks(exact, cases, None))
    (by_accuracy,) = coverage([exact], [*checks_of([exact], cases), *kept])
    assert by_accuracy.endswith("and baseline in 2 of these, at the finest accuracy")


def test_a_registry_survives_the_way_to_another_process() -> None:
    registry = Registry((MUJOCO,), {"dart": ("not-installed", "No module named 'dartpy'")})
    assert REGISTRY.validate_json(REGISTRY.dump_json(registry)) == registry


def test_a_failure_names_the_worst_row_its_bound_and_the_others() -> None:
    small = Row("trajectory", "omega", "error_max", 2e-9, "1", 1e-9, "fail", "observed order 1.00")
    large = replace(small, channel="attitude", value=5e-3, unit="rad")
    fine = replace(small, channel="position", value=1.0, bound=0.0, verdict="pass")
    text = failure([small, large, fine], "the step is too long.")
    assert text.startswith(
        "attitude: largest error is 0.005 rad (0.29 deg), 5e6 times its bound of 1e-9 rad"
    )
    assert "omega fails as well" in text
    assert "position" not in text
    assert text.endswith("Likely cause: the step is too long.")


def test_a_cause_that_the_message_states_is_not_stated_again(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Caught: "steps are 1e-5 % too long; ... Likely cause: steps are 1e-5 % too long."."""
    note = "steps are 1e-5 % too long"
    row = Row("scheme", "omega", "rate_at_no_step", 1e-7, "1", 1e-12, "fail", note)
    twice = failure([row, replace(row, channel="attitude", note="")], f"{note}.")
    assert twice == f"omega: {note}; attitude fails as well. {CAUSE}{note}."
    assert to_read(twice) == f"omega: {note}; attitude fails as well."
    print_checks(CheckResult({Check("toy", "s", "scheme", "a", 0.1): Result("fail", twice)}, ()))
    assert capsys.readouterr().out.count(note) == 1
    suite = SimpleNamespace(result_of=lambda _: Result("fail", twice))
    item = SimpleNamespace(check=Check("toy", "s", "model"), suite=suite, user_properties=[])
    with pytest.raises(CheckFailedError) as caught:
        CheckItem.runtest(cast(CheckItem, item))
    assert str(caught.value).count(note) == 1
    for kept in (f"omega: {note} by half. {CAUSE}{note}.", f"omega: off. {CAUSE}{note}.", "off."):
        assert to_read(kept) == kept  # it says less, something else, or nothing


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_what_is_not_finite_is_the_worst_of_all(value: float) -> None:
    row = Row("equation", "omega_dot", "residual", 1e200, "1", 1e-14, "fail")
    broken = replace(row, channel="torque", value=value)
    assert failure([row, broken]).startswith("torque: residual is not finite")


def test_the_plain_residual_is_quoted_where_it_fails() -> None:
    """Caught: "residual_of_sibling" of an engine that is wrong without any system before."""
    plain = Row("equation", "omega_dot", "residual", 0.12, "1", 2e-14, "fail")
    after = replace(plain, metric="residual_of_sibling", value=0.15, note="after another mass")
    assert failure([after, plain]).startswith("omega_dot: residual is 0.12, ")
    assert "after another mass" in failure([after, replace(plain, verdict="pass")])


def test_an_engine_is_idle_only_when_every_check_was_skipped() -> None:
    tally = Tally()
    for engine, verdict in (("a", "skip"), ("a", "skip"), ("b", "skip"), ("b", "pass")):
        tally.add(engine, "equation", verdict, "unsupported: no joints")
    (text,) = tally.only_skipped(["a", "b", "c"])
    assert text.startswith("a: all of its 2 checks were skipped")
    assert "no joints" in text


def test_a_model_alone_is_no_pass() -> None:
    """Caught: an engine that passes because nothing about its motion could be requested."""
    tally = Tally()
    for gate, verdict in (("model", "pass"), ("equation", "skip"), ("scheme", "skip")):
        tally.add("a", gate, verdict, "unsupported: no such call")
        tally.add("b", gate, verdict)
        tally.add("c", "model", "pass")  # where nothing but the model was selected
    tally.add("b", "trajectory", "pass")
    (text,) = tally.only_skipped(["a", "b", "c"])
    assert text.startswith("a: its model alone was tested and nothing about its motion")
    assert "no such call" in text


def test_engines_are_named_given_or_required() -> None:
    arguments = Arguments(
        engines=["mujoco:RK4"], adapters=[f"{WRONG}:Sound"], required=["mujoco", "dart", "nope"]
    )
    found = select(replace(arguments, scenarios=["sphere"]))
    assert [(c.name, c.integrators) for c in found.choices] == [
        ("mujoco", ("RK4",)),
        ("sound", ()),
        ("dart", ()),
    ]
    assert found.unknown == ("nope",)
    assert select(Arguments(required=["nope"], scenarios=["sphere"])).choices == []
    everything = select(Arguments(scenarios=["sphere"])).choices
    assert {"mujoco", "pinocchio", "dart", "reference", "exact"} <= {c.name for c in everything}
    assert not any(choice.required for choice in everything)


def test_a_file_is_enough_where_it_holds_one_adapter(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("class Helper: pass\nclass MineAdapter: pass\n")
    (choice,) = select(Arguments(adapters=[str(file)], scenarios=["sphere"])).choices
    assert (choice.name, choice.target) == ("mine", f"{file}:MineAdapter")
    with pytest.raises(UsageError, match="which class is the adapter"):
        select(Arguments(adapters=[str(WRONG)]))


def test_a_sound_engine_passes_every_check(tmp_path: Path) -> None:
    arguments = ("--integrator", "RK4", "--scenario", quick_scenario(tmp_path))
    result = omegadot("check", "mujoco", *arguments, "--format", "json", folder=tmp_path)
    assert result.code == 0, result.err
    assert result.json["exit_code"] == 0
    assert result.json["verdicts"] == {
        "pass": 11,
        "fail": 0,
        "declared": 0,
        "skip": 0,
        "error": 0,
    }
    ids = [check["id"] for check in result.json["checks"]]
    assert "mujoco-RK4-quick-0.005-trajectory" in ids


def test_a_wrong_engine_fails_with_a_reason(tmp_path: Path) -> None:
    arguments = (f"{WRONG}:NoGyroscopic", "--no-shrink", "--scenario", quick_scenario(tmp_path))
    result = omegadot("check", *arguments, folder=tmp_path)
    assert result.code == 1, result.err
    assert "FAIL  nogyroscopic-quick-equation" in result.out
    assert "omega_dot: residual" in result.out
    assert "Likely cause: the gyroscopic term is missing." in result.out
    assert "FAIL  nogyroscopic-quick-model" not in result.out
    explained = re.search(r"What explains the (\d+) failed checks:\n +(\d+)  (.*)\n", result.out)
    assert explained is not None
    assert explained[1] == explained[2] == str(result.out.count("FAIL  "))
    assert explained[3].startswith("the gyroscopic term is missing (equation gate, runs")


@pytest.mark.parametrize(
    ("name", "code", "text"),
    [
        ("Raises", 3, "raised: ArithmeticError: the solver did not converge"),
        ("Diverges", 1, "omega: largest error is not finite"),
        ("Unsupporting", 3, "a skip is not a pass (unsupported: this engine has no rigid bodies)"),
        ("Missing", 3, "not-installed: "),
    ],
)
def test_outcomes_stay_apart(name: str, code: int, text: str, tmp_path: Path) -> None:
    arguments = (f"{FAULTY}:{name}", "--no-shrink", "--scenario", quick_scenario(tmp_path))
    result = omegadot("check", *arguments, folder=tmp_path)
    assert result.code == code, result.err
    assert text in result.out
    if name == "Raises":  # the other integrator is whole
        assert "rk4-quaternion" not in result.out


def test_an_engine_is_given_as_run_takes_it(tmp_path: Path) -> None:
    """Caught: NAME:INTEGRATOR and --adapter refused by one command of two."""
    quick = quick_scenario(tmp_path)
    one = ("check", "reference:lie-rk4", "--scenario", quick)
    apart = ("check", "reference", "--integrator", "lie-rk4", "--scenario", quick)
    first, second = omegadot(*one, folder=tmp_path), omegadot(*apart, folder=tmp_path)
    assert (first.code, first.out) == (second.code, second.out)
    assert first.code == 0
    both = omegadot(*one, "--integrator", "rk4-quaternion", folder=tmp_path)
    assert both.code == 2
    assert "give reference, and --integrator for each" in both.err
    own = omegadot("check", "--adapter", f"{FAULTY}:Unsupporting", "--scenario", quick,
                   folder=tmp_path)  # fmt: skip
    assert "a skip is not a pass" in own.out
    two = omegadot("check", "reference", "--adapter", f"{FAULTY}:Unsupporting", folder=tmp_path)
    assert two.code == 2
    assert f"write omegadot check {FAULTY}:Unsupporting" in two.err
    run = omegadot("run", "--scenario", quick, "--engine", "reference:lie-rk4", folder=tmp_path)
    assert run.code == 0, run.err
    assert "quick" in run.out


def test_nothing_judged_is_no_success_of_run_or_check(tmp_path: Path) -> None:
    """Caught: exit code 0 of a run in which a named engine takes no system."""
    quick, target = quick_scenario(tmp_path), f"{FAULTY}:Unsupporting"
    ran = omegadot("run", quick, "--adapter", target, "--engine", "unsupporting", folder=tmp_path)
    assert "No verdict" in ran.out
    checked = omegadot("check", target, "--scenario", quick, folder=tmp_path)
    assert (ran.code, checked.code) == (3, 3)


def test_a_run_that_diverges_keeps_its_equation_gate(tmp_path: Path) -> None:
    """Caught: "no run was judged" beside an equation that holds at identical states."""
    fast = quick_scenario(tmp_path, QUICK.replace("[0.3, 2.0, 0.1]", "[1e6, 3e6, 1e6]"))
    one = ("--engine", "mujoco:RK4", "--timestep", "0.02", "--timestep", "0.01")
    ran = omegadot("run", fast, *one, folder=tmp_path)
    assert ran.code == 0, ran.out
    assert "mujoco agrees with the Newton–Euler equations at identical states" in ran.out
    assert "2 diverged" in ran.out


@pytest.mark.parametrize(
    ("adapter", "arguments", "message"),
    [
        ("mujocco", Arguments(), "write mujoco"),
        ("mujoco:", Arguments(), "give mujoco, or mujoco:INTEGRATOR"),
        ("mujoco", Arguments(update=True), "--baseline DIR"),
        ("mujoco", Arguments(exceptions=["nowhere.toml"]), "nowhere.toml"),
        ("mujoco", Arguments(random=1_000_001), "--random 1000001: give a whole number of at most"),
        ("mujoco", Arguments(seed=10**9), "--seed 1000000000: give a whole number of at most"),
        ("nowhere.py", Arguments(), "no such adapter file"),
        ("nowhere.py:Mine", Arguments(), "no such adapter file"),
        ("mine.py:Mine:rk4", Arguments(), "give FILE.py:Class"),
    ],
)
def test_wrong_usage_is_one_sentence(adapter: str, arguments: Arguments, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        select(arguments_of(adapter, [], arguments))
    assert message in str(caught.value)
    assert str(caught.value).endswith(".")


def test_wrong_usage_is_found_where_the_engine_knows_better(tmp_path: Path) -> None:
    result = omegadot("check", "mujoco", "--integrator", "RK5", folder=tmp_path)
    assert (result.code, result.out) == (2, "")
    assert "write RK4" in result.err


@pytest.mark.parametrize("name", ["Nope", "np"])
def test_what_is_no_class_is_named_as_such(name: str, tmp_path: Path) -> None:
    result = omegadot("check", f"{FAULTY}:{name}", "--scenario", "sphere", folder=tmp_path)
    assert result.code == 3
    assert f"has no class {name}; check its name" in result.out


def test_a_scenario_given_twice_is_one() -> None:
    assert len(scenarios_of(["sphere", "sphere"])) == 1


def test_two_scenarios_of_one_name_are_refused() -> None:
    other = omegadot_scenario("sphere", run={"duration": 1.0})
    with pytest.raises(UsageError, match="of its own"):
        scenarios_of(["sphere", other])


def test_json_gives_every_check_its_parts(tmp_path: Path) -> None:
    arguments = ("--scenario", quick_scenario(tmp_path), "--format", "json")
    result = omegadot("check", "exact", *arguments, folder=tmp_path)
    assert result.code == 0, result.err
    first = json.loads(result.out)["checks"][0]
    check, verdict = Check("exact", "quick", "model"), Result("pass")
    assert first == {"id": check.id, **vars(check), **vars(verdict)}


def test_a_fault_in_every_check_is_a_screen_long(capsys: pytest.CaptureFixture[str]) -> None:
    """Caught: 1300 lines of one cause, with what explains them below."""
    many = {
        Check("toy", f"s-{n}", gate): Result("fail", f"{gate} is off by {n}. {CAUSE}no spin.")
        for n in range(40)
        for gate in ("equation", "scheme")
    }
    alike = {
        Check("toy", "s-0", "trajectory", "a", 0.1 * n): Result("fail", "off.") for n in range(1, 9)
    }
    found = CheckResult({**many, **alike}, ())
    print_checks(found)
    printed = capsys.readouterr().out
    lines = printed.splitlines()
    assert printed.index("What explains the 88 failed checks:") < printed.index("FAIL  ")
    assert "FAIL  toy-s-0-equation" in lines
    assert f"    equation is off by 0. {CAUSE}no spin." in lines
    assert "    scheme is off by 0." in lines  # of the next gate, its cause not again
    assert "    and 77 more failures of this cause: --verbose lists them." in lines
    assert "    and 5 more failures: --verbose lists them." in lines
    assert printed.count("FAIL  ") == 3 + 3
    assert lines[-1] == "88 checks: 88 fail."
    print_checks(found, verbose=True)
    printed = capsys.readouterr().out
    assert printed.count("FAIL  ") == 88
    assert printed.count(f"{CAUSE}no spin.") == 80
    few = CheckResult(dict(list(many.items())[:20]), ())
    print_checks(few)
    assert capsys.readouterr().out.count("FAIL  ") == 20


def test_what_explains_names_gates_and_runs_apart(capsys: pytest.CaptureFixture[str]) -> None:
    """Caught: "(equation, a and b)", of which the first is a gate and the others integrators."""
    wrong = Result("fail", f"off. {CAUSE}no spin.")
    other = Result("fail", "off by more.")
    checks = {
        Check("toy", "s", "equation"): wrong,
        Check("toy", "s", "scheme", "a", 0.1): wrong,
        Check("toy", "s", "scheme", "b", 0.1): wrong,
        Check("toy", "s", "trajectory", "b", 0.1): other,
    }
    print_checks(CheckResult(checks, ()))
    printed = capsys.readouterr().out
    assert "       3  no spin (equation gate, runs of a and b)\n" in printed
    assert "       1  no cause was found (runs of b); what is known:\n" in printed


def test_skips_of_one_reason_are_one_line_with_their_scenarios(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Caught: four lines that differ in an observed order, and none names a scenario."""
    checks = {
        Check("toy", f"s-{n}", "scheme", "a", 0.1): Result(
            "skip", f"not judged: it is not resolved: observed order {n}.00, declared 1"
        )
        for n in range(5)
    }
    print_checks(CheckResult(checks, ()))
    printed = capsys.readouterr().out
    assert printed.count("not judged: ") == 1
    assert "skip  5 checks: not judged: it is not resolved (on s-0, s-1, s-2 and 2 more)" in printed


def test_two_small_systems_of_one_cause_are_one(capsys: pytest.CaptureFixture[str]) -> None:
    """Caught: two files that show one fault, and the total below both, off the screen."""
    checks = [Check("toy", "t-handle", "scheme", name, 0.1) for name in ("a", "b")]
    small = omegadot_scenario("t-handle")
    failing = [Failing(c, small, "off.", (), 1, True, "command", cause="no spin.") for c in checks]
    results = {check: Result("fail", f"off. {CAUSE}no spin.") for check in checks}
    print_checks(CheckResult(results, (), failing=tuple(failing)))
    printed = capsys.readouterr().out
    assert printed.count("Smallest failing system") == printed.count("[body]") == 1
    assert f"{checks[1].id} fails for the same cause as {checks[0].id}" in printed
    assert printed.count(CAUSE) == 1
    assert printed.count("2 checks: 2 fail.\n") == 2
    assert printed.index("2 checks: 2 fail.") < printed.index("Smallest")
    several = [failing[0], replace(failing[1], cause="no mass.")]
    results[checks[1]] = Result("fail", f"off. {CAUSE}no mass.")
    print_checks(CheckResult(results, (), failing=tuple(several)))
    printed = capsys.readouterr().out
    assert printed.count("Smallest failing system") == 2
    assert "Likely cause, found on t-handle: no mass." in printed


def test_verbose_lists_every_failure(tmp_path: Path) -> None:
    text = QUICK.replace(
        "[0.02, 0.01, 0.005]", "[0.04, 0.02, 0.01, 0.005, 0.0025, 0.00125, 0.000625]"
    )
    arguments = (f"{WRONG}:NoGyroscopic", "--no-shrink", "--scenario")
    result = omegadot("check", *arguments, quick_scenario(tmp_path, text), folder=tmp_path)
    whole = omegadot("check", *arguments, "quick.toml", "--verbose", folder=tmp_path)
    assert result.code == whole.code == 1
    failures = int(re.search(r"(\d+) fail", whole.out.splitlines()[-1])[1])  # type: ignore[index]
    assert failures > 20
    assert whole.out.count("FAIL  ") == failures > result.out.count("FAIL  ")
