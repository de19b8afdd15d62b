"""No command requests of an engine what its features do not list, or ends at what it lacks."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from command_line import ENGINES, quick_scenario

import omegadot
from omegadot.commands.run.print_run import exit_code
from omegadot.commands.versions.result import VersionsResult

PARTIAL = ENGINES / "partial.py"
SOUND = ("NoInverse", "NoForward", "NoDynamics")


def target(name: str) -> str:
    return f"{PARTIAL}:{name}"


def two_releases(folder: Path, name: str) -> VersionsResult:
    given = []
    for version in ("1.0", "1.1"):
        python = folder / f"python-{version}"
        python.write_text(f'#!/bin/sh\nPARTIAL_ENGINE={version} exec "{sys.executable}" "$@"\n')
        python.chmod(0o755)
        given.append(f"{version}={python}")
    own = {"adapter": target(name), "offline": True, "cache": folder, "speed": False}
    return omegadot.versions("partial", given, scenarios=quick_scenario(folder), **own)


def noted(found: VersionsResult) -> str:
    return " ".join(line for version in found.record["versions"] for line in version["troubles"])


@pytest.mark.parametrize("name", SOUND)
def test_releases_are_compared_by_their_features(tmp_path: Path, name: str) -> None:
    found = two_releases(tmp_path, name)
    assert found.passed
    assert "raised" not in noted(found)
    figures = found.record["versions"][0]["figures"]
    lacks = {"NoInverse": ["torque"], "NoForward": ["omega_dot", "linear_momentum"]}
    for channel in ("omega_dot", "linear_momentum", "torque"):
        text = figures[f"equation:quick:{channel}"]["text"]
        assert (text == "unsupported") == (channel in lacks.get(name, [channel]))


def test_an_integrator_that_is_gone_once_a_system_is_loaded_is_unsupported(tmp_path: Path) -> None:
    found = two_releases(tmp_path, "NoIntegratorOnceLoaded")
    assert found.comparable
    assert "not declared for this system" in noted(found)
    assert omegadot.schemes(target("NoIntegratorOnceLoaded")).answered


def test_a_release_that_fails_a_query_is_compared_and_not_passed(tmp_path: Path) -> None:
    found = two_releases(tmp_path, "RunRaises")
    assert found.comparable
    assert not found.passed
    assert "ValueError: no licence" in noted(found)


@pytest.mark.parametrize("name", [*SOUND, "NoIntegrator"])
def test_a_check_skips_what_there_is_not(tmp_path: Path, name: str) -> None:
    checked = omegadot.check(target(name), scenarios=quick_scenario(tmp_path))
    assert checked.passed, checked.failures


def test_a_run_judges_an_engine_without_integrators(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    sound = omegadot.run(quick, target("NoIntegrator"))
    (task,) = sound.record.tasks
    assert sound.passed
    assert task.gates == {"model": "pass", "equation": "pass"}
    wrong = omegadot.run(quick, target("NoIntegratorNoCoupling"))
    (task,) = wrong.record.tasks
    assert not wrong.passed
    assert task.gates["equation"] == "fail"


def test_a_model_alone_passes_nowhere(tmp_path: Path) -> None:
    """Caught: an engine without integrators and dynamics that passes on its model alone."""
    quick = quick_scenario(tmp_path)
    ran = omegadot.run(quick, target("ModelOnly"))
    (task,) = ran.record.tasks
    assert task.gates == {"model": "pass"}
    assert ran.untested == ("modelonly",)
    assert not ran.passed
    assert exit_code(ran) == 3
    page = ran.record.page()
    sentence = "modelonly has no integrators and no dynamics: its model alone was tested"
    assert sentence in page
    assert '<td class="s-not-judged"' in page
    assert '<td class="s-pass"' not in page
    checked = omegadot.check(target("ModelOnly"), scenarios=quick)
    assert not checked.passed
    assert checked.only_skipped[0].startswith("modelonly: its model alone was tested")
    chosen = omegadot.choose(quick, target("ModelOnly"), attitude="1deg", budget=0.02)
    assert not chosen.qualifies
    (engine,) = chosen.document["engines"]
    assert "nothing about its motion over time can be tested" in engine["refused"][0]


@pytest.mark.parametrize("name", ["InverseOnly", "NoIntegrator"])
def test_one_equation_is_more_than_a_model(tmp_path: Path, name: str) -> None:
    ran = omegadot.run(quick_scenario(tmp_path), target(name))
    assert ran.untested == ()
    assert ran.passed


def test_runs_that_pass_are_a_verdict_without_omega_dot(tmp_path: Path) -> None:
    """Caught: "No verdict" on an engine every run of which passes, and gives no omega-dot."""
    quick = quick_scenario(tmp_path)
    own = "nodynamics holds every gate, and gives no omega-dot at a state."
    alone = omegadot.run(quick, target("NoDynamics")).record.headline
    assert own in alone
    assert "No verdict" not in alone
    beside = omegadot.run(quick, "mujoco:RK4", adapters=target("NoDynamics")).record.headline
    assert beside.startswith("mujoco (of 2 engines) agrees with")
    assert own in beside


def test_beside_another_engine_a_model_alone_is_no_pass_either(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    ran = omegadot.run(quick, "mujoco:RK4", adapters=target("ModelOnly"))
    assert ran.untested == ("modelonly",)
    assert "No verdict on modelonly" in ran.record.headline


def test_no_other_command_ends_at_them(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    for name in ("NoDynamics", "NoIntegrator"):
        assert omegadot.choose(quick, target(name), attitude="1deg", budget=0.02).answered
        assert omegadot.schemes(target(name)).passed
        assert omegadot.run(quick, target(name)).passed
