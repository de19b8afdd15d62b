"""A check that is interrupted, or of which an engine is lost as causes are sought: what is said."""

import json
import os
import signal
import subprocess
import time
from collections.abc import Mapping
from pathlib import Path

import pytest
from command_line import PROGRAM, QUICK, quick_scenario

import omegadot as api
from omegadot.commands.check.check_result import CheckResult
from omegadot.commands.check.print_checks import print_checks, print_json
from omegadot.commands.check.result import Check, Result
from omegadot.commands.check.suite import Suite

# Wrong on every scenario; on the one named slow it never answers.
SLOW = """
import time
from omegadot.adapters.reference import ReferenceAdapter
from omegadot.reference_impl.system import Acceleration

class SlowAdapter(ReferenceAdapter):
    def forward_dynamics(self, states):
        if float(self.system.body.mass) == 7.0:
            open("busy", "w").close()
            time.sleep(1e6)
        sound = super().forward_dynamics(states)
        return Acceleration(1.01 * sound.angular, sound.linear)
"""
# Wrong where omega_x is positive; once the checks are made, it ends or hangs.
LOST = """
import os
import time
import numpy as np
from omegadot.adapters.reference import ReferenceAdapter
from omegadot.reference_impl.system import Acceleration

class LostAdapter(ReferenceAdapter):
    def forward_dynamics(self, states):
        if os.path.exists("dies"):
            os._exit(9)
        if os.path.exists("hangs"):
            time.sleep(1e6)
        sound, w = super().forward_dynamics(states), states.angular_velocity
        wrong = np.where(w[..., :1] > 0.0, 0.05 * np.sin(7.0 * w), 0.0)
        return Acceleration(sound.angular + wrong, sound.linear)
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_an_interruption_prints_what_has_failed(tmp_path: Path, name: str) -> None:
    """Caught: "interrupted." alone after minutes of checks; a partial result that is not said to
    be one.
    """
    quick_scenario(tmp_path)
    text = QUICK.replace('"quick"', '"slow"').replace("mass = 2.0", "mass = 7.0")
    quick_scenario(tmp_path, text, "slow.toml")
    (tmp_path / "slow.py").write_text(SLOW)
    command = [*PROGRAM, "check", "slow.py", "--integrator", "lie-rk4", "--scenario", "quick.toml"]
    running = subprocess.Popen(
        [*command, "--scenario", "slow.toml", "--baseline", "kept", "--update-baseline"],
        cwd=tmp_path,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL) and None,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 60.0
    while not (tmp_path / "busy").exists() and time.monotonic() < deadline:
        time.sleep(0.1)
    running.send_signal(getattr(signal, name))
    try:
        out, err = running.communicate(timeout=60.0)
    finally:
        running.kill()
    assert running.returncode == 128 + getattr(signal, name)
    assert err == "omegadot: interrupted.\n"
    assert "FAIL  slow-quick-equation" in out
    assert out.splitlines()[-1] == (
        "Partial, interrupted: 11 of 22 checks: 4 fail, 7 pass. Causes and the smallest systems "
        "that fail were not looked for, nor was any other check made."
    )
    assert "What explains" not in out
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize("doing", ["_causes", "_shrunk"])
def test_an_interruption_as_failures_are_explained_keeps_them(
    doing: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def interrupted(*_: object) -> object:
        raise KeyboardInterrupt

    if doing == "_causes":
        monkeypatch.setattr(Suite, "settled", interrupted)
    else:
        monkeypatch.setattr("omegadot.commands.check.check._shrunk", interrupted)
    (tmp_path / "slow.py").write_text(SLOW)
    how = {"scenarios": quick_scenario(tmp_path), "integrators": "lie-rk4"}
    with pytest.raises(api.CheckInterrupted) as caught:
        api.check(f"{tmp_path / 'slow.py'}:SlowAdapter", **how)
    found = caught.value.result
    assert len(found.results) == len(found.planned) == 11
    assert found.failures
    assert not found.passed
    print_checks(found)
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("Partial, interrupted: 11 of 11 checks: 4 fail, 7 pass. ")
    assert ("Causes and the" in last) is (doing == "_causes")
    print_json(found)
    printed = json.loads(capsys.readouterr().out)
    assert (printed["complete"], printed["exit_code"], printed["planned"]) == (False, 130, 11)


def test_a_check_that_ends_is_complete(capsys: pytest.CaptureFixture[str]) -> None:
    found = CheckResult({Check("toy", "s", "model"): Result("pass")}, ())
    print_json(found)
    printed = json.loads(capsys.readouterr().out)
    assert (printed["complete"], printed["exit_code"], printed["lost"]) == (True, 0, [])


@pytest.mark.parametrize(
    ("flag", "outcome"),
    [("dies", "crashed: ended with exit code 9"), ("hangs", "timeout: no answer within 1 s")],
)
def test_an_engine_that_is_lost_in_an_experiment_is_stated(
    flag: str,
    outcome: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Caught: a crash or time-out after the checks, of which no one hears."""
    settled = Suite.settled

    def then(suite: Suite, results: Mapping[Check, Result]) -> dict[Check, Result]:
        Path(flag).touch()
        return settled(suite, results)

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Suite, "settled", then)
    Path("lost.py").write_text(LOST)
    how = {"scenarios": ["t-handle", "free-bar"], "integrators": "lie-rk4", "shrink": False}
    found = api.check("lost.py", **how, timeout=1.0)
    os.unlink(flag)
    (line,) = found.lost
    assert line.startswith("lost gave no answer in an experiment on a cause, the last that was ")
    assert f"omega-dot on t-handle; {outcome}" in line
    print_checks(found)
    assert capsys.readouterr().out.splitlines()[-2] == line
