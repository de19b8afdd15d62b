"""Scenarios whose motion double precision cannot hold end in a sentence, in every command."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import QUICK, Result, omegadot, quick_scenario

CAUSE = "the exact trajectory cannot be worked out: "
EXTREMES = {
    "spin": QUICK.replace("[0.3, 2.0, 0.1]", "[1e49, 0.0, 1e49]"),
    "slow": QUICK.replace("[0.3, 2.0, 0.1]", "[1e-160, 0.0, 1e-160]"),
    "pivot": QUICK.replace("[run]", "[load]\npivot = [1e20, 0.0, 0.0]\n[run]"),
}
TRACE = "t,qw,qx,qy,qz,wx,wy,wz\n" + "".join(f"{i * 0.1},1,0,0,0,0.3,2,0.1\n" for i in range(11))


def clean(result: Result) -> Result:
    assert "Traceback" not in result.err + result.out
    assert "Warning" not in result.err + result.out
    return result


@pytest.mark.parametrize("which", EXTREMES)
def test_no_command_ends_in_a_traceback_or_accuses(tmp_path: Path, which: str) -> None:
    """Caught: LinAlgError and ZeroDivisionError with exit code 1, that of a failing gate."""
    quick_scenario(tmp_path, EXTREMES[which])
    (tmp_path / "t.csv").write_text(TRACE)
    one = ["--engine", "reference:rk4-quaternion"]
    ran = clean(omegadot("run", "quick.toml", *one, folder=tmp_path))
    assert ran.code == 3
    assert "No verdict" in ran.out
    assert CAUSE in ran.out
    chosen = clean(omegadot("choose", "quick.toml", *one, "--attitude", "1deg", folder=tmp_path))
    assert chosen.code == 3
    assert CAUSE in chosen.out
    checked = ["reference", "--integrator", "rk4-quaternion", "--scenario", "quick.toml"]
    done = clean(omegadot("check", *checked, folder=tmp_path))
    assert done.code == 3
    assert CAUSE in done.out
    scored = clean(omegadot("score", "t.csv", "--scenario", "quick.toml", folder=tmp_path))
    assert scored.code == 2
    assert CAUSE in scored.err
    assert scored.err.count("\n") == 1
