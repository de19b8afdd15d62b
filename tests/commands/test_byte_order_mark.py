"""Every text that is read may begin with a UTF-8 byte order mark, as some editors write it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from command_line import QUICK, omegadot
from synthetic_record import build

import omegadot as api
from omegadot.commands.check.baseline_file import (
    Figure,
    Figures,
    RunKey,
    ScenarioFigures,
    read_baseline,
    to_text,
)
from omegadot.commands.check.exceptions import read_exceptions
from omegadot.commands.choose.requirements import read_requirements
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.settings import _read_map
from omegadot.harness.engine_target import target_of
from omegadot.harness.own_engines import FILE, known_engines
from omegadot.reports.choice.page import NAME, read_choice
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import RUN, read_record, write_record
from omegadot.reports.record.schema import RecordError

MARK = b"\xef\xbb\xbf"
EXCEPTION = """
engine = "mujoco"
[[exception]]
check = "mujoco-Euler-t-handle-0.01-scheme"
reason = "known"
link = "https://example.org/1"
"""
ADAPTER = """
from omegadot.adapters.reference import ReferenceAdapter
class Own(ReferenceAdapter): ...
"""
URDF = """<robot name="r"><link name="a"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""
BASELINE = to_text(
    "own",
    {"sphere": ScenarioFigures("1.0", {RunKey("Euler", 0.01): Figures({"f": Figure(1.0, 0.1)})})},
)


def _choice(path: Path) -> str:
    """What is wrong with it beyond its bytes: this one is no whole choice."""
    with pytest.raises(RecordError) as problem:
        read_choice(path.parent)
    return repr(problem.value.__cause__)


def _cells(path: Path) -> object:
    table = read_table(path)
    return table.names, [cell.to_list() for cell in table.cells]


READ: dict[str, tuple[str, str, Callable[[Path], object]]] = {
    "scenario": ("quick.toml", QUICK, lambda path: api.scenario(path).to_dict()),
    "map": ("map.toml", 'time-unit = "ms"\n[columns]\nt = "time"\n', _read_map),
    "exceptions": ("known.toml", EXCEPTION, read_exceptions),
    "requirements": ("needs.toml", 'attitude = "1deg"\n', read_requirements),
    "table": ("trace.csv", "t,wx,wy,wz\n0,1,2,3\n1,1,2,3\n", _cells),
    "adapter": ("own.py", ADAPTER, lambda path: target_of(str(path))),
    "class": ("own.py", ADAPTER, lambda path: target_of(f"{path}:Own")),
    "engines": (FILE, '[adapters]\nown = "own.py:Own"\n', lambda path: known_engines()),
    "baseline": ("own.toml", BASELINE, lambda path: read_baseline(path.parent, "own")),
    "choice": (NAME, '{"kind": "choice"}', _choice),
}
"""By kind: the file's name, its text, and what reads it."""


@pytest.mark.parametrize("kind", READ)
def test_a_byte_order_mark_is_no_part_of_the_text(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: a reader of its own that takes the mark for a letter."""
    name, text, read = READ[kind]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_bytes(MARK + ADAPTER.encode())
    file = tmp_path / name
    file.write_bytes(text.encode())
    plain = read(file)
    file.write_bytes(MARK + text.encode())
    assert read(file) == plain


def test_a_record_whose_run_json_was_saved_with_a_mark_is_whole(tmp_path: Path) -> None:
    record = build(samples=4)
    for folder in ("was", "now"):
        write_record(record, tmp_path / folder, draw_page(record))
    file = tmp_path / "now" / RUN
    file.write_bytes(MARK + file.read_bytes())
    assert read_record(tmp_path / "now").run == json.loads((tmp_path / "was" / RUN).read_text())
    for command in (("report", "now"), ("compare", "was", "now")):
        done = omegadot(*command, folder=tmp_path)
        assert done.code == 0, done.err


def test_the_body_of_a_robot_and_an_adapter_run_with_a_mark(tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_bytes(MARK + URDF.encode())
    (tmp_path / "own.py").write_bytes(MARK + ADAPTER.encode())
    chosen = omegadot(
        *("choose", "--body", "robot.urdf#a", "--angular-velocity", 0, 0, 1, "--duration", 1),
        *("--attitude", "10deg", "--engine", "own.py:Own", "--budget", 0.05),
        folder=tmp_path,
    )
    assert "own" in chosen.out, chosen.err
