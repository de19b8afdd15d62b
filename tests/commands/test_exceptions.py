"""Declared exceptions: they excuse what they name, and are held to it."""

import re
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from command_line import WRONG, Result, omegadot, quick_scenario

from omegadot.adapters.registry import OURS
from omegadot.commands.check.exception_conditions import read_conditions
from omegadot.commands.check.exceptions import (
    OWN_FOLDER,
    DeclaredException,
    exceptions_of,
    read_exceptions,
    with_exceptions,
)
from omegadot.commands.check.result import PASSED, Check, skipped
from omegadot.commands.check.result import Result as CheckResult
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError
from omegadot.reports.record.record import read_record
from omegadot.scenarios import load_builtin

LINK = "https://example.org/issues/17"
NAME = "nogyroscopic"


def declaration(*patterns: str, engine: str = NAME) -> str:
    tables = [
        f'[[exception]]\ncheck = "{pattern}"\nreason = "No gyroscopic term."\nlink = "{LINK}"\n'
        for pattern in patterns
    ]
    return f'engine = "{engine}"\n' + "".join(tables)


ALL = declaration(f"{NAME}-quick-equation", f"{NAME}-semi-implicit-euler-quick-*")


def checked(text: str, folder: Path, command: str = "check") -> Result:
    scenario, file = quick_scenario(folder), folder / "known.toml"
    file.write_text(text)
    if command == "check":
        names = ("check", f"{WRONG}:NoGyroscopic", "--no-shrink", "--scenario", scenario)
    else:
        names = ("run", scenario, "--engine", NAME, "--adapter", f"{WRONG}:NoGyroscopic")
    return omegadot(*names, "--exceptions", file, folder=folder)


def test_a_declared_failure_is_declared(tmp_path: Path) -> None:
    result = checked(ALL, tmp_path)
    assert result.code == 0, result.out
    assert f"DECLARED  {NAME}-quick-equation" in result.out
    assert LINK in result.out
    assert "FAIL " not in result.out


def test_one_that_no_longer_fails_and_one_that_matches_nothing_fail(tmp_path: Path) -> None:
    # The model is right; t-handle and sphere are known, and left out of this run.
    left_out = (f"{NAME}-*-t-handle-*", f"{NAME}-*-sphere-0.01-scheme")
    result = checked(declaration(f"{NAME}-*quick-*", f"{NAME}-quik-model", *left_out), tmp_path)
    assert result.code == 1
    assert f"FAIL  {NAME}-quick-model" in result.out
    assert "passes, though" in result.out
    assert f"'{NAME}-quik-model' matches no check" in result.out
    assert result.out.count("FAIL") == 2


def test_a_run_honours_them_and_gives_the_link(tmp_path: Path) -> None:
    result = checked(ALL, tmp_path, "run")
    assert result.code == 0, result.out
    metrics = read_record(tmp_path / "omegadot-run").metrics
    declared = metrics.filter(pl.col("verdict") == "declared")
    assert set(declared["gate"]) == {"equation", "scheme", "invariants", "trajectory"}
    assert all(LINK in note for note in declared["note"])
    assert "fail" not in set(metrics["verdict"])


def test_a_run_fails_where_one_no_longer_holds(tmp_path: Path) -> None:
    patterns = (f"{NAME}-quick-*", f"{NAME}-semi-implicit-euler-quick-*", f"{NAME}-no-such")
    result = checked(declaration(*patterns), tmp_path, "run")
    assert result.code == 1
    assert f"{NAME}-quick-model passes, though" in result.out
    assert "matches no check" in result.out


def test_only_failures_are_excused() -> None:
    check = Check("dart", "sphere", "model")
    known = [DeclaredException("dart", "dart-*", "known", LINK, "dart.toml")]
    assert with_exceptions(check, CheckResult("fail", "off"), known).verdict == "declared"
    assert with_exceptions(check, PASSED, known).verdict == "fail"
    for other in (skipped("no joints"), CheckResult("error", "crashed: signal 9", "crashed")):
        assert with_exceptions(check, other, known) == other
    assert with_exceptions(Check("mujoco", "sphere", "model"), PASSED, known) == PASSED


def test_a_random_system_may_pass_where_all_are_declared_and_not_where_it_is() -> None:
    """Caught: the command that is printed for a failing system fails the checks that hold there."""
    check = Check("toy", "random-3-4", "scheme", "euler", timestep=0.01)
    every = DeclaredException("toy", "toy-euler-random-*", "known", LINK, "toy.toml")
    assert with_exceptions(check, PASSED, [every]) == PASSED
    assert with_exceptions(check, CheckResult("fail", "off"), [every]).verdict == "declared"
    one = DeclaredException("toy", "toy-euler-random-3-4-*", "known", LINK, "toy.toml")
    assert with_exceptions(check, PASSED, [one]).verdict == "fail"


def test_a_pattern_may_be_about_every_system_that_is_drawn(tmp_path: Path) -> None:
    """None is drawn here, and the pattern matches what may be; one of a single system does not."""
    drawn = f"{NAME}-semi-implicit-euler-random-*"
    result = checked(f"{ALL}{declaration(drawn).partition(chr(10))[2]}", tmp_path)
    assert result.code == 0, result.out
    result = checked(declaration(f"{NAME}-*-quick-*", f"{NAME}-random-7-7-model"), tmp_path)
    assert "'nogyroscopic-random-7-7-model' matches no check" in result.out


@pytest.mark.parametrize(
    ("limit", "code"), [("moments_product_below = 1.0", 1), ("moments_ratio_above = 1.5", 0)]
)
def test_an_exception_is_about_the_bodies_within_its_limits(
    tmp_path: Path, limit: str, code: int
) -> None:
    """Caught: an exception of small bodies that excuses every other fault of all of them.

    The quick scenario's moments are 1, 2 and 2.5 kg m^2.
    """
    text = ALL.replace('reason = "', f'when = {{ {limit} }}\nreason = "')
    result = checked(text, tmp_path)
    assert result.code == code, result.out
    assert ("DECLARED" in result.out) == (code == 0)
    assert ("FAIL " in result.out) == (code == 1)
    assert "matches no check" not in result.out
    ran = checked(text, tmp_path, "run")
    assert ran.code == code
    assert ran.out.count("fail") == 0 if code == 0 else "fail" in ran.out


def test_the_quantities_that_limits_are_about() -> None:
    driven, thrown = load_builtin("driven-body"), load_builtin("free-bar")
    top, damped = load_builtin("heavy-top"), load_builtin("damped-tumble")
    slowed = damped.load.damping * damped.run.duration
    assert top.load.pivot is not None
    moments = np.linalg.eigvalsh(driven.body.inertia)
    for scenario, key, value in (
        (driven, "moments_product", float(np.prod(moments))),
        (driven, "moments_ratio", float(moments[2] / moments[0])),
        (driven, "torque", float(np.linalg.norm(driven.load.torque[0].value))),
        (driven, "angular_velocity", float(np.linalg.norm(driven.initial.angular_velocity))),
        (thrown, "speed", float(np.linalg.norm(thrown.initial.linear_velocity))),
        (damped, "decay", slowed / float(np.linalg.eigvalsh(damped.body.inertia)[2])),
        (top, "lever", float(np.linalg.norm(np.subtract(top.load.pivot, top.body.center_of_mass)))),
    ):
        assert value > 0.0
        for factor, below in ((1.001, True), (0.999, False)):
            limits = {f"{key}_below": value * factor}, {f"{key}_above": value * factor}
            found = [read_conditions(limit, "here")[0].holds(scenario) for limit in limits]
            assert found == [below, not below], key
    pivoted = read_conditions({"lever_above": 0.0}, "here")[0]
    assert [pivoted.holds(scenario) for scenario in (top, thrown)] == [True, False]


@pytest.mark.parametrize(
    ("when", "message"),
    [
        ("{ moment_product_below = 1 }", "write moments_product_below"),
        ("{ speed_below = 'slow' }", "speed_below is 'slow'; give a number in SI units"),
        ("{ speed_below = nan }", "give a number in SI units"),
        (f"{{ speed_below = {'9' * 400} }}", "give a number in SI units"),
        ("{}", "give it as a table of limits"),
        ("7", "when is 7; give it as a table of limits"),
    ],
)
def test_limits_that_cannot_be_read(tmp_path: Path, when: str, message: str) -> None:
    file = tmp_path / "known.toml"
    file.write_text(declaration("a-*").replace('reason = "', f'when = {when}\nreason = "'))
    with pytest.raises(UsageError, match=re.escape(message)) as raised:
        read_exceptions(file)
    assert str(raised.value).startswith(f"{file}: exception 1: when")


@pytest.mark.parametrize("entry", ["1", "true", "[]", '"ab"'])
def test_an_exception_that_is_no_table_is_refused(tmp_path: Path, entry: str) -> None:
    file = tmp_path / "known.toml"
    file.write_text(f'engine = "toy"\nexception = [{entry}]\n')
    with pytest.raises(UsageError, match=r"exception 1 is .*write it as a table"):
        read_exceptions(file)


def test_they_stand_next_to_an_adapter(tmp_path: Path) -> None:
    (tmp_path / "mine.exceptions.toml").write_text(declaration("mine-*", engine="mine"))
    target = f"{tmp_path / 'mine.py'}:MineAdapter"
    (found,) = exceptions_of([EngineChoice("mine", target)], [])
    assert (found.check, found.link) == ("mine-*", LINK)
    assert exceptions_of([EngineChoice("other", target)], []) == []


def test_they_stand_next_to_a_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "an_engine_with_exceptions"
    package.mkdir()
    # Importing it would fail: it is the worker's to import, not ours.
    (package / "__init__.py").write_text("raise RuntimeError('imported')")
    (package / "adapter.exceptions.toml").write_text(declaration("mine-*", engine="mine"))
    monkeypatch.syspath_prepend(str(tmp_path))
    target = "an_engine_with_exceptions.adapter:MineAdapter"
    (found,) = exceptions_of([EngineChoice("mine", target)], [])
    assert found.engine == "mine"


def test_the_projects_own_files_are_read() -> None:
    files = sorted(OWN_FOLDER.glob("*.toml"))
    assert {file.stem for file in files} == {*OURS} - {"exact", "reference"}
    read = [exception for file in files for exception in read_exceptions(file)]
    assert all(exception.link.startswith("https://") for exception in read)
    ours = [EngineChoice(name, OURS[name]) for name in sorted(OURS)]
    assert exceptions_of(ours, []) == read


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("engine = ", "not valid TOML"),
        ("[[exception]]\n", 'engine = "NAME"'),
        (declaration("x").replace("reason", "reson"), "write reason"),
        (declaration("x").replace(LINK, " "), "link is missing or empty"),
        ('engine = "x"\nexceptions = []\n', "write exception"),
    ],
)
def test_a_malformed_file_is_one_sentence(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "known.toml"
    file.write_text(text)
    with pytest.raises(UsageError, match=r"known\.toml") as caught:
        read_exceptions(file)
    assert message in str(caught.value)
