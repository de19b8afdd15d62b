"""Without the exact solution nothing is judged, and that is one sentence."""

import sys
from pathlib import Path

import pytest

from omegadot.harness import cli, workers


def test_a_truth_that_does_not_start_ends_the_run_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Caught: a look-up of a worker that never came up, and a record without verdicts."""
    lost = {**workers.BUILT_IN, "exact": "omegadot.adapters.exact:NoSuchAdapter"}
    monkeypatch.setattr(workers, "BUILT_IN", lost)
    out = tmp_path / "run"
    words = ["omegadot", "run", "sphere", "--engine", "reference:lie-rk4", "--out", str(out)]
    monkeypatch.setattr(sys, "argv", words)
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 3
    said = capsys.readouterr().err.strip()
    assert said.startswith("omegadot: worker of exact: ")
    assert "\n" not in said
    assert not out.exists()
