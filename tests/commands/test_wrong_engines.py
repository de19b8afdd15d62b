"""Every broken engine is caught by the gate that should catch it, and the sound one is not."""

import json
from pathlib import Path

import pytest
from command_line import WRONG, omegadot, quick_scenario

# A turned tensor, an offset, gravity and no symmetry: nothing for a fault to hide behind.
REVEALING = """
schema = 1
name = "revealing"
[body]
mass = 2.0
inertia = [[1.0, 0.1, 0.2], [0.1, 1.6, -0.1], [0.2, -0.1, 2.1]]
center_of_mass = [0.05, -0.02, 0.1]
[initial]
orientation = [0.5, 0.1, -0.7, 0.4]
angular_velocity = [0.8, 2.0, -0.5]
position = [0.4, -1.0, 2.0]
linear_velocity = [1.0, -0.5, 3.0]
[load]
gravity = [0.0, 0.0, -9.81]
[run]
duration = 2.0
timesteps = [0.02, 0.01, 0.005]
sample = 0.02
"""
SLOW = """
schema = 1
name = "slow"
[body]
mass = 2.0
inertia = [1.0, 1.6, 2.1]
[initial]
angular_velocity = [0.02, 0.04, 0.01]
[run]
duration = 2.0
timesteps = [0.02, 0.01, 0.005]
sample = 0.02
"""
FAULTS = {
    "SignAsPrinted": "equation",
    "NoGyroscopic": "equation",
    "GyroscopicSlightlyOff": "equation",
    "OmegaDotInWorld": "equation",
    "MassSlightlyOff": "model",
    "DiagonalInertia": "model",
    "TransposedAttitude": "model",
    "GravityUpwards": "equation",
    "SecretDamping": "trajectory",
    "StepSlightlyLong": "trajectory",
    "FirstSampleMissing": "trajectory",
    "LogsOneSampleLate": "trajectory",
    "EnergyCorrected": "scheme",
}


def failed_gates(text: str, folder: Path, *names: str) -> dict[str, set[str]]:
    scenario = quick_scenario(folder, text)
    adapters = [argument for name in names for argument in ("--adapter", f"{WRONG}:{name}")]
    engines = [argument for name in names for argument in ("--engine", name.lower())]
    result = omegadot(
        "run", scenario, *engines, *adapters, "--out", "out", "--format", "json", folder=folder
    )
    assert result.code in (0, 1), result.err
    found: dict[str, set[str]] = {name: set() for name in names}
    for task in json.loads(result.out)["tasks"]:
        name = next(n for n in names if n.lower() == task["engine"])
        assert task["outcome"] == "ok", task["reason"]
        found[name] |= {gate for gate, verdict in task["gates"].items() if verdict == "fail"}
    return found


def test_each_fault_is_caught_by_its_gate(tmp_path: Path) -> None:
    found = failed_gates(REVEALING, tmp_path, *FAULTS)
    missed = {name for name, gate in FAULTS.items() if gate not in found[name]}
    assert missed == set()


@pytest.mark.parametrize("text", [REVEALING, SLOW])
def test_a_sound_engine_is_not_accused(text: str, tmp_path: Path) -> None:
    assert failed_gates(text, tmp_path, "Sound") == {"Sound": set()}


def test_sleeping_is_caught_where_the_body_is_slow(tmp_path: Path) -> None:
    assert "trajectory" in failed_gates(SLOW, tmp_path, "FallsAsleep")["FallsAsleep"]
