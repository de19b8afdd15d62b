"""The published checks as they stand, and the command that prints the matrix."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import omegadot

from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.catalogue import FAULTS
from omegadot.commands.faults.detect import GATES
from omegadot.commands.faults.faults import FaultsResult
from omegadot.commands.faults.matrix import EngineMatrix, detection
from omegadot.commands.faults.prepared import Pool
from omegadot.commands.faults.print_faults import markdown, share
from omegadot.commands.faults.published import Published
from omegadot.commands.faults.published_checks import PUBLISHED

CHECKS = {check.name: check for check in PUBLISHED}


def catches(check: Published, fault: str | None, pose: int = 0) -> bool:
    sound = ReferenceAdapter()
    adapter = sound if fault is None else FAULTS[fault].wrap(sound)
    integrator = check.integrator_of(sound)
    assert integrator is not None
    return check.caught(adapter, integrator, np.random.default_rng([7, pose]))


@pytest.mark.parametrize("check", PUBLISHED, ids=lambda check: check.name)
def test_published_checks_pass_a_sound_engine(check: Published) -> None:
    assert not catches(check, None)


@pytest.mark.parametrize("check", PUBLISHED, ids=lambda check: check.name)
def test_published_checks_catch_what_they_are_for(check: Published) -> None:
    assert catches(check, "OmegaInWorldThroughout")
    assert catches(check, "NotFiniteAfterAWhile")


def test_published_checks_have_the_strengths_and_the_holes_of_their_bounds() -> None:
    assert not catches(CHECKS["MuJoCo"], "GyroscopicDropped")
    assert catches(CHECKS["MuJoCo"], "GyroscopicReversed")
    dropped = [catches(CHECKS["DART"], "GyroscopicDropped", pose) for pose in range(12)]
    assert any(dropped)
    assert not all(dropped)
    assert catches(CHECKS["Drake"], "GravitySlightlyOff")
    assert not catches(CHECKS["Drake"], "StepSlightlyLong")
    assert catches(CHECKS["Newton"], "GyroscopicDropped")
    assert not catches(CHECKS["Newton"], "GyroscopicOnePercentOff")


def test_a_row_of_the_matrix() -> None:
    row = detection(FAULTS["GravityReversed"], "reference", Pool(3), 2)
    assert (row.judged, row.broken, row.any, row.named) == (2, 0, 1.0, 1.0)
    assert row.gates["equation"] == 1.0
    assert row.gates["model"] == 0.0
    assert row.no_scheme == 1.0
    assert row.published["Drake"] == 1.0
    assert row.published["MuJoCo"] is None


def test_the_page_has_a_line_for_every_fault_and_states_how_it_was_made() -> None:
    row = detection(FAULTS["MassSlightlyOff"], "reference", Pool(3), 1)
    matrix = EngineMatrix("reference", "1", ("rk4-quaternion",), 2, 0, 0, ("Left",), (), (row,))
    page = markdown(FaultsResult(1, 3, (matrix,)))
    command = "omegadot faults --engine reference --bodies 1 --seed 3 --format markdown"
    assert command in page.splitlines()[2:6][0] + page.splitlines()[3]
    line = next(text for text in page.splitlines() if text.startswith("| MassSlightlyOff | 100"))
    assert line.count("|") == len(GATES) + len(PUBLISHED) + 5
    assert "1 faults, of which 1 were caught on every body" in page
    assert "Left" in page
    for check in PUBLISHED:
        assert check.source in page
    assert share(None) == "–"


def test_the_kept_page_is_of_all_the_faults() -> None:
    page = (Path(__file__).parents[2] / "docs" / "faults.md").read_text(encoding="utf-8")
    for name, fault in FAULTS.items():
        assert f"| {name} | {fault.sentence} |" in page


def test_the_command_refuses_other_engines(tmp_path: Path) -> None:
    result = omegadot("faults", "--engine", "exact", folder=tmp_path)
    assert result.code == 2
    assert "--engine exact: no such engine; choose dart" in result.err


@pytest.mark.parametrize("form", ["json", "text"])
def test_the_command_prints_the_matrix(
    form: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    from omegadot.commands.faults import matrix
    from omegadot.commands.faults.faults import faults
    from omegadot.commands.faults.print_faults import print_faults

    few = [FAULTS[name] for name in ("MassSlightlyOff", "GyroscopicDropped", "AttitudeOfOrderTwo")]
    monkeypatch.setattr(matrix, "ORDERED", few)
    found = faults("dart", bodies=1)
    assert found.passed
    print_faults(found, form)
    out = capfd.readouterr().out
    if form == "json":
        engine = json.loads(out)["engines"][0]
        assert [row["name"] for row in engine["faults"]] == ["MassSlightlyOff", "GyroscopicDropped"]
        assert engine["skipped"] == ["AttitudeOfOrderTwo"]
        assert (engine["sound"], engine["accused"], engine["accused_nameless"]) == (2, 0, 0)
        assert engine["faults"][1]["gates"]["equation"] == 1.0
    else:
        assert "2 faults, of which 2 were caught on every body" in out
        assert "AttitudeOfOrderTwo" in out
