"""The published checks as they stand, and the command that prints the matrix."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_line import omegadot

from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults import matrix
from omegadot.commands.faults.catalogue import FAULTS
from omegadot.commands.faults.detection import detection
from omegadot.commands.faults.fault import Spoiled
from omegadot.commands.faults.faults import FaultsResult, faults
from omegadot.commands.faults.matrix import SOUND, EngineMatrix
from omegadot.commands.faults.prepared import Pool
from omegadot.commands.faults.print_faults import HEADS, markdown, print_faults, share
from omegadot.commands.faults.published import Published
from omegadot.commands.faults.published_checks import PUBLISHED
from omegadot.scenarios import builtin_names

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
    pool = Pool(7)
    row = detection(FAULTS["GravityReversed"], "reference", pool, 5)
    under_gravity = [bool(np.any(one.case.system.load.gravity)) for one in pool.first(5)]
    assert (row.judged, row.broken) == (5, 0)
    assert 0 < sum(under_gravity) < 5
    assert row.any == row.gates["equation"] == row.no_scheme == sum(under_gravity) / 5
    assert row.at_default == 1.0 - (1.0 - row.any) ** 24
    assert row.gates["model"] == 0.0
    assert row.named == 1.0
    assert row.built_in == "free-bar"
    assert row.caught
    assert row.published["Drake"] == 1.0
    assert row.published["MuJoCo"] is None


def test_a_fault_that_nothing_shows_is_missed() -> None:
    fault = replace(FAULTS["MassSlightlyOff"], name="Sound", wrap=Spoiled)
    row = detection(fault, "reference", Pool(2), 2, published=False)
    assert (row.built_in, row.any, row.no_scheme, row.named) == ("", 0.0, 0.0, None)
    assert not row.caught
    missing = EngineMatrix("reference", "1", (), 2, (), (), (), (), (row,), 0.0)
    assert FaultsResult(2, 3, (missing,)).unseen == ("reference: Sound",)
    assert not FaultsResult(2, 3, (missing,)).passed


def test_what_is_stepped_by_the_reference_is_tried_elsewhere_where_it_shows() -> None:
    """A body that is damped in the steps alone: over another engine on the same systems."""
    pool, fault = Pool(2), FAULTS["OmegaHeldBelow25"]
    over = [detection(fault, engine, pool, 5, published=False) for engine in ("reference", "dart")]
    assert over[0].any == over[1].any
    assert 0.0 < over[0].any < 1.0
    assert over[0].gates["scheme"] == over[1].gates["scheme"] == over[0].any


def test_the_page_has_a_line_for_every_fault_and_states_how_it_was_made() -> None:
    row = detection(FAULTS["MassSlightlyOff"], "reference", Pool(3), 1)
    matrix = EngineMatrix(
        "reference", "1", ("rk4-quaternion",), 2, (), (), ("Left",), (), (row,), 2.6
    )
    result = FaultsResult(1, 3, (matrix,))
    assert result.passed
    page = markdown(result)
    command = "omegadot faults --engine reference --random 1 --seed 3 --format markdown"
    assert command in page.splitlines()[2:6][0] + page.splitlines()[3]
    line = next(text for text in page.splitlines() if text.startswith("| MassSlightlyOff | yes"))
    assert line.count("|") == len(HEADS) + len(PUBLISHED) + 1
    assert "1 faults, of which 1 are caught (100 %)" in page
    assert "This took 3 min of processor time" in page
    assert "Left" in page
    for check in PUBLISHED:
        assert check.source in page


def test_shares_are_never_rounded_to_all_or_nothing() -> None:
    shares = (None, 0.0, 0.001, 0.5, 0.9951, 0.99999, 1.0)
    assert list(map(share, shares)) == ["–", "0", "<1", "50", ">99", ">99.9", "100"]


def test_the_kept_page_is_of_all_the_faults() -> None:
    page = (Path(__file__).parents[2] / "docs" / "faults.md").read_text(encoding="utf-8")
    for name, fault in FAULTS.items():
        assert f"| {name} | {fault.sentence} |" in page


def test_the_command_refuses_other_engines(tmp_path: Path) -> None:
    result = omegadot("faults", "--engine", "exact", folder=tmp_path)
    assert result.code == 2
    assert "--engine exact: no such engine; choose dart" in result.err


@pytest.fixture(scope="module")
def few_faults() -> FaultsResult:
    """Three faults over one engine."""
    few = [FAULTS[name] for name in ("MassSlightlyOff", "GyroscopicDropped", "AttitudeOfOrderTwo")]
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(matrix, "ORDERED", few)
        return faults("dart", random=2)


@pytest.mark.parametrize("form", ["json", "text"])
def test_the_command_prints_the_matrix(
    form: str, few_faults: FaultsResult, capfd: pytest.CaptureFixture[str]
) -> None:
    found = few_faults
    assert found.passed
    print_faults(found, form)
    out = capfd.readouterr().out
    if form == "json":
        data = json.loads(out)
        (engine,) = data["engines"]
        assert (data["random"], data["seed"]) == (2, 0)
        assert data["minutes"] == engine["minutes"] > 0.0
        assert [row["name"] for row in engine["faults"]] == ["MassSlightlyOff", "GyroscopicDropped"]
        assert engine["skipped"] == ["AttitudeOfOrderTwo"]
        assert engine["accused"] == engine["accused_nameless"] == []
        assert engine["sound"] == SOUND * 2 + len(builtin_names())
        row = engine["faults"][1]
        assert (row["caught"], row["built_in"]) == (True, "damped-tumble")
        assert row["at_24"] == 1.0 - (1.0 - row["any"]) ** 24
    else:
        assert "2 faults, of which 2 are caught (100 %)" in out
        assert "AttitudeOfOrderTwo" in out
