"""Requirements as they are written: units, files, what is refused and how."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import omegadot
from omegadot.adapters.protocol import Description, Integrator
from omegadot.commands.choose.eligible import unmet, untestable
from omegadot.commands.choose.licences import check_licences
from omegadot.commands.choose.motion import Motion, cases_of
from omegadot.commands.choose.requirements import Requirements, merged, read_requirements
from omegadot.commands.engines.engines import EngineEntry
from omegadot.commands.units import quantity
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError

QUANTITIES = [
    ("0.1deg", "angle", 0.1 * math.pi / 180),
    ("0.1 deg", "angle", 0.1 * math.pi / 180),
    ("1e-3", "angle", 1e-3),
    (2, "angle", 2.0),
    ("3arcsec", "angle", 3 * math.pi / 648000),
    ("60rpm", "rate", 2 * math.pi),
    ("1deg/h", "rate", math.pi / 648000),
    ("5ms", "time", 5e-3),
    ("2min", "time", 120.0),
    ("0.01%", "ratio", 1e-4),
    ("3ppm", "ratio", 3e-6),
]


@pytest.mark.parametrize(("text", "kind", "expected"), QUANTITIES)
def test_quantities(text: object, kind: str, expected: float) -> None:
    assert quantity(text, kind, "--it") == pytest.approx(expected, rel=4e-16)


@pytest.mark.parametrize(
    ("text", "kind", "message"),
    [
        ("0.1dge", "angle", "write deg"),
        ("0.1DEG", "angle", "write deg"),
        ("0.1deg", "ratio", "no unit"),
        ("0.1deg", "rate", "write deg/s"),
        ("-1", "angle", "not a positive"),
        ("0", "angle", "not a positive"),
        ("1e999", "angle", "not a positive"),
        ("nan", "angle", "no quantity"),
        ("", "time", "no quantity"),
        (True, "angle", "write it as"),
        ([1], "angle", "write it as"),
    ],
)
def test_bad_quantities_are_refused_in_one_sentence(text: object, kind: str, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        quantity(text, kind, "--it")
    assert message in str(caught.value)
    assert str(caught.value).startswith("--it")
    assert "\n" not in str(caught.value)


def test_the_line_wins_over_the_file(tmp_path: Path) -> None:
    path = tmp_path / "need.toml"
    path.write_text(
        'attitude = "0.1 deg"\nmomentum_drift = 1e-6\nfeatures = ["pivot"]\npython = "3.12"\n'
    )
    line = {"attitude": "1deg", "feature": [], "licence": None, "precision": "double"}
    found = merged(read_requirements(path), line, str(path))
    assert found.limits["attitude"] == pytest.approx(math.pi / 180)
    assert found.limits["momentum-drift"] == 1e-6
    assert (found.features, found.precision, found.python) == (("pivot",), "double", "3.12")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("atitude = 1", "write attitude"),
        ("attitude = 1\nspeed = 2", "no requirement 'speed'"),
        ('attitude = "1 m"', "need.toml: attitude"),
        ("attitude = ", "not valid TOML"),
        ("precision = 'half'\nattitude = 1", "double or single"),
        ("feature = 'pivots'\nattitude = 1", "write pivot"),
        ("python = 3.12\nattitude = 1", "3.12"),
        ("licence = ['']\nattitude = 1", "empty"),
        ("feature = [1]\nattitude = 1", "list of texts"),
        ("momentum-drift = 1\nmomentum_drift = 2", "given twice"),
        ("python = '3.12'", "no accuracy is required"),
        ("attitude = 1\n[attitude.x]\ny=1", "not valid TOML"),
        ("a.b = [1]\n[[a.b]]\ny=1", "a.b is given as a value and again as a table"),
    ],
)
def test_bad_files_are_refused_in_one_sentence(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "need.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as caught:
        merged(read_requirements(path), {}, str(path))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


STEPS = (Integrator("euler", "explicit-euler", {"omega": 1}),)


def engine(**fields: object) -> Description:
    given: dict[str, object] = {"features": frozenset({"pivot"}), "licence": "MIT", **fields}
    return Description("toy", "1", STEPS, **given)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        ({"precision": "single"}, "double"),
        ({"features": ("inverse-dynamics",)}, "inverse dynamics"),
        ({"licences": ("Apache-2.0", "BSD-2-Clause")}, "MIT"),
    ],
)
def test_engines_are_refused_by_what_they_are(wanted: dict[str, object], message: str) -> None:
    requested = Requirements({"attitude": 1.0}, {"attitude": "1"}, **wanted)  # type: ignore[arg-type]
    (clause,) = unmet(engine(), requested)
    assert message in clause


def test_an_engine_without_integrators_is_refused_whatever_is_required() -> None:
    """Caught: a choice of an engine that has nothing to step with."""
    (clause,) = untestable(Description("toy", "1", ()))
    assert clause.startswith("integrators: it has none")


def test_engines_that_are_as_required_are_not_refused() -> None:
    requested = Requirements(
        {"attitude": 1.0}, {"attitude": "1"}, precision="double", features=("pivot",),
        licences=("mit",), python="3.12",
    )  # fmt: skip
    assert unmet(engine(), requested) == []


@pytest.mark.parametrize("name", ["permissive", "Apache2", "apache-2.0 or mit", "LicenseRef-x"])
def test_a_name_that_is_no_licence_is_refused_with_those_there_are(name: str) -> None:
    """Caught: a typo, for which no engine qualifies."""
    with pytest.raises(UsageError) as caught:
        omegadot.choose("sphere", "mujoco", attitude="1deg", licences=[name])
    message = str(caught.value)
    assert message.startswith(f"--licence {name}: there is no such licence; ")
    assert "the installed engines have Apache-2.0" in message
    assert "\n" not in message


def test_names_of_licences_in_any_letters_and_engines_own_are_accepted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A licence of SPDX that no engine has may stand in a list of those that are allowed."""
    choice = EngineChoice("toy", "toy:Toy")
    module = "omegadot.commands.choose.licences"
    check_licences(["apache-2.0", "mit", "BSD-2-Clause"], [choice])  # and starts nothing
    monkeypatch.setattr(
        f"{module}.entry_of", lambda c: EngineEntry(c.name, engine(licence="In-House"))
    )
    check_licences(["in-house"], [choice])
    with pytest.raises(UsageError, match="write In-House"):
        check_licences(["in-hose"], [choice])


def test_a_package_that_refuses_the_python_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    requested = Requirements({"attitude": 1.0}, {"attitude": "1"}, python="3.8")
    module = "omegadot.commands.choose.eligible"
    monkeypatch.setattr(f"{module}._required", lambda name: ">=3.10,<3.14")
    (clause,) = unmet(engine(), requested)
    assert "3.10" in clause
    later = Requirements({"attitude": 1.0}, {"attitude": "1"}, python="3.14")
    assert unmet(engine(), later)


@pytest.mark.parametrize(
    ("required", "python", "admitted"),
    [
        (">=3.11.4", "3.11", True),
        (">3.10", "3.10", True),
        ("<3.12.4", "3.12", True),
        ("<3.12.0", "3.12", False),
        ("~=3.11.2", "3.12", False),
        ("~=3.11", "3.14", True),
        ("==3.12.*", "3.12", True),
        ("!=3.12.*,>=3.9", "3.12", False),
        (">=3.9,!=3.12.0", "3.12", True),
    ],
)
def test_a_minor_version_is_admitted_where_a_release_of_it_is(
    monkeypatch: pytest.MonkeyPatch, required: str, python: str, admitted: bool
) -> None:
    wanted = Requirements({"attitude": 1.0}, {"attitude": "1"}, python=python)
    module = "omegadot.commands.choose.eligible"
    monkeypatch.setattr(f"{module}._required", lambda name: required)
    monkeypatch.setattr(f"{module}._running", lambda: "3.99")
    assert (unmet(engine(), wanted) == []) is admitted


@pytest.mark.parametrize("name", ["mujoco", "pinocchio", "dart"])
def test_what_the_packages_state_of_python_is_found(name: str) -> None:
    old = Requirements({"attitude": 1.0}, {"attitude": "1"}, python="3.1")
    found = Description(name, "1", STEPS)
    assert "its package requires" in unmet(found, old)[0]
    assert unmet(found, Requirements({"attitude": 1.0}, {"attitude": "1"}, python="3.12")) == []


def test_a_body_alone_needs_a_start_and_a_horizon(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("[body]\nmass = 2.0\ninertia = [1.0, 2.0, 2.5]\n")
    with pytest.raises(UsageError, match="--angular-velocity"):
        cases_of(Motion(body=str(path), duration=2.0))
    with pytest.raises(UsageError, match="--duration"):
        cases_of(Motion(body=str(path), angular_velocity=(0.0, 1.0, 0.0)))
    (case,) = cases_of(Motion(body=str(path), angular_velocity=(0.1, 1.0, 0.0), duration=2.0))
    assert case.name == "mine"
    assert case.system.body.mass == 2.0
    assert case.initial.angular_velocity.tolist() == [0.1, 1.0, 0.0]
    assert case.sweeps[0].steps * case.sweeps[0].timestep == pytest.approx(2.0)


def test_a_body_takes_a_scenarios_motion_and_the_horizon_is_the_users(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("[body]\nmass = 2.0\ninertia = [1.0, 2.0, 2.5]\n")
    (case,) = cases_of(Motion(["t-handle"], body=str(path), duration=0.015))
    assert case.initial.angular_velocity.tolist() == [0.05, 0.05, 9.0]
    assert case.scenario.run.duration == 0.015
    assert all(sweep.timestep <= 0.015 for sweep in case.sweeps)


def test_nothing_to_simulate_is_an_error() -> None:
    with pytest.raises(UsageError, match="--body"):
        cases_of(Motion())
    with pytest.raises(UsageError, match=r"^--duration 1e12 needs 5e13 steps of 0.02 s; the"):
        cases_of(Motion(["t-handle"], duration=1e12))
    with pytest.raises(UsageError, match=r"needs 2.5e7 samples of 0.04 s; the limit is 10,000,000"):
        cases_of(Motion(["t-handle"], duration=1e6))
