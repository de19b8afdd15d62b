"""What the first screen of `omegadot check` states where no cause is named."""

import re

import pytest

from omegadot.commands.check.check_result import CheckResult
from omegadot.commands.check.explained import explained
from omegadot.commands.check.judge import CAUSE
from omegadot.commands.check.print_checks import print_checks
from omegadot.commands.check.result import PASSED, Check, Result
from omegadot.commands.check.shrink import Failing
from omegadot.scenarios import scenario

STEPS = (0.04, 0.02, 0.01)


def runs(name: str, failing: int, message: str) -> dict[Check, Result]:
    """The scheme gate at three steps, of which so many of the longest fail."""
    checks = [Check("toy", name, "scheme", "a", step) for step in STEPS]
    return {
        check: Result("fail", message, excess=1e4 * check.timestep) if k < failing else PASSED
        for k, check in enumerate(checks)
        if check.timestep is not None
    }


def test_what_is_known_stands_where_no_cause_does() -> None:
    """Caught: "none is known" in the list of what explains, and nothing of what is."""
    known = f"attitude: off. {CAUSE}none is known; attitude is off; it goes as |omega|^2."
    results = {**runs("s", 2, known), **runs("t", 0, ""), **runs("u", 1, known)}
    small = Failing(next(iter(results)), scenario("sphere"), "off.", ("gravity",), 1, True, "")
    assert explained(results, [small]) == [
        "What explains the 3 failed checks:",
        "       3  no cause was found (runs of a); what is known:",
        "          attitude is off",
        "          it goes as |omega|^2",
        "          it fails on 2 of 3 scenarios: s, u",
        "          it fails at long steps alone, from 0.02 s on; finer ones pass",
        "          on s by a: 400 times its bound at 0.04 s, 200 at 0.02 s",
        "          left in the smallest failing system, printed below: gravity",
    ]


def test_without_a_word_of_the_diagnosis_channels_and_steps_are_known() -> None:
    """Caught: nothing at all of failures for which the diagnosis has no sentence."""
    results = {**runs("s", 3, "omega: diverges."), **runs("t", 3, "attitude: diverges.")}
    lines = [line.strip() for line in explained(results, [])]
    assert lines[2:] == [
        "what is off: omega and attitude",
        "it fails on all of 2 scenarios",
        "it fails at every step",
        "on s by a: 400 times its bound at 0.04 s, 200 at 0.02 s, 100 at 0.01 s",
    ]
    fine = {c: Result("fail", "omega: off.") if c.timestep == 0.01 else r
            for c, r in runs("s", 0, "").items()}  # fmt: skip
    assert "it fails at fine steps alone, up to 0.01 s; longer ones pass" in explained(fine, [])[-1]
    middle = {c: Result("fail", "omega: off.") if c.timestep == 0.02 else r
              for c, r in runs("s", 0, "").items()}  # fmt: skip
    assert not any("steps" in line for line in explained(middle, []))


def test_one_named_cause_needs_no_list() -> None:
    named = f"off. {CAUSE}no spin."
    assert explained(runs("s", 3, named), []) == []
    assert explained(runs("s", 3, "off."), [])  # of none something is known
    two = {**runs("s", 3, named), **runs("t", 3, f"off by more. {CAUSE}no spin.")}
    assert explained(two, [])[1:] == ["       6  no spin (runs of a)"]


def test_a_cause_of_other_scenarios_is_the_same_cause() -> None:
    """Caught: one cause on two lines, of which neither has the whole count."""
    here = runs("s", 3, f"off. {CAUSE}no spin.")
    there = runs("t", 2, f"off. {CAUSE}on 3 other scenarios: no spin.")
    assert explained({**here, **there}, [])[1:] == ["       5  no spin (runs of a)"]
    besides = runs("t", 2, f"off. {CAUSE}on 3 other scenarios: no spin; here: omega is off.")
    assert len(explained({**here, **besides}, [])) == 3


def test_a_cell_counts_every_verdict(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: "pass 1/3" of a sound run, read as two failures; and "2 fail, 1 p…"."""
    print_checks(CheckResult(runs("s", 2, f"off. {CAUSE}no spin."), ()))
    assert re.search(r"^s +2 fail, 1 pass *$", capsys.readouterr().out, re.MULTILINE)
    sound = {
        check: result if result.verdict == "pass" else Result("skip", "not judged: at rest")
        for check, result in runs("s", 2, "off.").items()
    }
    print_checks(CheckResult(sound, ()))
    assert re.search(r"^s +1 pass, 2 skip *$", capsys.readouterr().out, re.MULTILINE)
    print_checks(CheckResult(runs("s", 3, f"off. {CAUSE}no spin."), ()))
    assert re.search(r"^s +fail *$", capsys.readouterr().out, re.MULTILINE)
    monkeypatch.setattr("omegadot.commands.check.print_checks.WIDTH_WHEN_PIPED", 20)
    print_checks(CheckResult(sound, ()))
    assert re.search(r"^ +2 skip *$", capsys.readouterr().out, re.MULTILINE)
