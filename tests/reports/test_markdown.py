"""One run as a comment: what must be seen is in it, and nothing in it is more than text."""

from __future__ import annotations

import pytest
from comment import active
from hypothesis import given, settings
from hypothesis import strategies as st
from synthetic_record import build, task

from omegadot.reports.text.markdown import markdown_of
from omegadot.reports.text.markdown_text import code, escape, table

LIMIT = 65_536
HOSTILE = "<script>alert(1)</script> | `@someone` ![x](https://example.org) #12 **b** www.a.org"
MARKS = list("ab1 @#<>&|`*_[]()!~\\:/.-+=$\n\r\x1b\u2028\ud800")


def test_the_verdict_the_failures_and_what_did_not_run_are_there(record) -> None:
    broken = record.run["tasks"][-1]
    broken |= {"gates": {"trajectory": "fail"}, "why": "it diverges from its scheme"}
    lost = {"outcome": "not-installed", "reason": "No module named 'dartpy'", "gates": {}}
    record.run["tasks"].append(task("sphere", "other", "", None, **lost))
    message = markdown_of(record)
    first = message.splitlines()[0]
    assert first.startswith("### omegadot: 1 of ")
    assert "dart, on spun-again" in first
    assert "it diverges from its scheme" in message
    assert "| other | not-installed | 1 | No module named 'dartpy' |" in message
    assert "✗" in message
    assert "`omegadot run --out 'a folder'`" in message
    assert "| numpy | 2.0.0 |" in message
    assert not active(message)


def test_a_skip_is_no_pass(record) -> None:
    for entry in record.run["tasks"]:
        entry |= {"outcome": "unsupported", "gates": {}, "reason": "no free joints"}
    message = markdown_of(record)
    matrix = [line for line in message.splitlines() if line.startswith("| sphere |")]
    assert matrix
    assert all("✓" not in line and "unsupported" in line for line in matrix)


def test_a_record_without_a_run_is_reported_as_such(record) -> None:
    record.run.update(tasks=[], engines=[], scenarios=[])
    assert "No run was made." in markdown_of(record)


def test_the_worst_is_kept_where_there_is_no_room_for_all() -> None:
    names = tuple(f"{HOSTILE} {'x' * 200} {number}" for number in range(400))
    record = build(
        scenarios=names, engines={"dart": {"semi-implicit": 1}}, steps=(0.02,), samples=2
    )
    record.run["tasks"][-1] |= {"gates": {"trajectory": "fail"}, "why": HOSTILE * 100}
    record.run["command"] = ["omegadot", "run", "`" * 5 + HOSTILE * 50]
    message = markdown_of(record)
    assert len(message.encode()) < LIMIT
    assert "more scenarios, none of them worse." in message
    assert [line for line in message.splitlines() if "✗ " in line and line.startswith("| ")]
    assert not active(message)


@settings(derandomize=True, max_examples=60)
@given(st.text(alphabet=st.sampled_from(MARKS), max_size=30))
def test_whatever_a_name_holds_is_text(name: str) -> None:
    """In a cell of a table, where a bar or the end of the line would end it."""
    lines = table(("name", "other"), [(name, "end")], 10_000)
    assert not active("\n".join(lines))
    assert len(lines) == 3
    assert "\n" not in lines[2]
    assert code(name).count("\n") == 0


@pytest.mark.parametrize("name", ["t-handle", "aba+lie-rk4", "mujoco 4.0.0", "3.1e-15 → 2", "a b"])
def test_ordinary_names_are_left_as_they_are(name: str) -> None:
    assert escape(name) == name
