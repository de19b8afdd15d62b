"""``--via``: bodies through an engine's own reader of files, from command line to record."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from command_line import ENGINES, omegadot, quick_scenario

from omegadot import check, run, versions
from omegadot.commands.versions.result import VersionsResult
from omegadot.harness.arguments import Via
from omegadot.harness.usage import UsageError

IMPORTERS = ENGINES / "importers.py"
SOUND, WRONG = f"{IMPORTERS}:SoundImporter", f"{IMPORTERS}:IgnoresRotation"


def test_a_sound_reader_passes_and_goes_by_a_name_of_its_own(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    checked = check(SOUND, scenarios=quick, via=["api", "urdf"])
    assert checked.passed, checked.failures
    assert [subject.name for subject in checked.subjects] == [
        "soundimporter",
        "soundimporter-via-urdf",
    ]
    assert "soundimporter-via-urdf-quick-model" in checked.results


def test_a_faulty_reader_fails_the_model_gate_and_its_api_passes(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    assert check(WRONG, scenarios=quick).passed
    failed = check(WRONG, scenarios=quick, via="urdf").failures
    assert "inertia" in failed["ignoresrotation-via-urdf-quick-model"].message


def test_a_run_records_both_ways_apart(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    found = run(quick, "mujoco:RK4", timesteps=0.01, via=["api", "mjcf"], out=tmp_path / "out")
    assert found.passed
    assert {task.engine for task in found.record.tasks} == {"mujoco", "mujoco-via-mjcf"}
    entries = {e["name"]: e["via"] for e in found.record.run["engines"]}
    assert entries == {"mujoco": "api", "mujoco-via-mjcf": "mjcf"}
    assert set(found.record.metrics["engine"]) >= {"mujoco", "mujoco-via-mjcf"}
    again = omegadot("compare", tmp_path / "out", tmp_path / "out", folder=tmp_path)
    assert again.code == 0, again.err


def test_engines_without_a_reader_are_unsupported_unless_named(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    found = run(quick, timesteps=0.01, via="mjcf")
    outcomes = {task.engine: task.outcome for task in found.record.tasks}
    assert outcomes["dart-via-mjcf"] == "unsupported"
    assert outcomes["mujoco-via-mjcf"] == "ok"
    assert outcomes["exact"] == outcomes["reference"] == "ok"
    with pytest.raises(UsageError, match=r"--via mjcf: dart .* it reads urdf"):
        run(quick, "dart", via="mjcf")
    with pytest.raises(UsageError, match=r"--via sdf: no such way"):
        check("dart", scenarios=quick, via="sdf")  # type: ignore[arg-type]


def test_the_command_line_takes_it(tmp_path: Path) -> None:
    quick = quick_scenario(tmp_path)
    own = ("check", WRONG, "--scenario", quick, "--via")
    assert omegadot(*own, "urdf", folder=tmp_path).code == 1
    refused = omegadot(*own, "mjcf", folder=tmp_path)
    assert refused.code == 2
    assert refused.err == (
        "omegadot: --via mjcf: reference 0.1.0 has no reader of mjcf; it reads urdf.\n"
    )


def test_releases_are_compared_by_their_readers(tmp_path: Path) -> None:
    here, scenario = ["0.0.9", f"0.1.0={sys.executable}"], quick_scenario(tmp_path)

    def found(adapter: str, via: Via) -> VersionsResult:
        own = {"offline": True, "cache": tmp_path, "speed": False, "scenarios": scenario}
        return versions("reader", here, adapter=adapter, via=via, **own)

    (faults,) = found(WRONG, "urdf").faults.values()
    assert any("model" in fault for fault in faults)
    assert not found(SOUND, "urdf").faults
    missing = found(SOUND, "mjcf").missing["0.1.0"]
    assert missing.startswith("unsupported: reference 0.1.0 has no reader of mjcf")
