"""Without the exact solution nothing is judged, and that is one sentence."""

import sys
from pathlib import Path

import pytest

from omegadot.commands import cli
from omegadot.harness import engines


def test_a_truth_that_does_not_start_ends_the_run_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Caught: a look-up of a worker that never came up, and a record without verdicts."""
    lost = {**engines.BUILT_IN, "exact": "omegadot.adapters.exact.adapter:NoSuchAdapter"}
    monkeypatch.setattr(engines, "BUILT_IN", lost)
    out = tmp_path / "run"
    arguments = ["omegadot", "run", "sphere", "--engine", "reference:lie-rk4", "--out", str(out)]
    monkeypatch.setattr(sys, "argv", arguments)
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 3
    text = capsys.readouterr().err.strip()
    assert text.startswith("omegadot: worker of exact: ")
    assert "\n" not in text
    assert not out.exists()
