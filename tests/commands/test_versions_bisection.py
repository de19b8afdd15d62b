"""Bisection names releases that do differ from the one before, in about log2 looks."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.commands.versions.bisection import Bisection, _no_such, bisect
from omegadot.commands.versions.changes import Portrait, changes_between, pace_of, ratio_of
from omegadot.commands.versions.metric import Figure

NAME = ("order", "RK4", "free", "attitude")
BROKEN = "broken"


def bisected(values: list[str]) -> Bisection:
    versions = [f"1.{n}" for n in range(len(values))]

    def look(version: str) -> Portrait:
        value = values[versions.index(version)]
        if value == BROKEN:
            return Portrait(version, outcome="crashed", reason="ended by signal 11 (SIGSEGV)")
        return Portrait(version, integrators=["RK4"], figures={NAME: Figure(value)})

    return bisect(versions, look)


def steps(found: Bisection) -> list[tuple[str, str]]:
    return [(step.before.version, step.after.version) for step in found.steps]


def test_one_change_is_found_in_log2_looks() -> None:
    for at in range(1, 16):
        found = bisected(["a"] * at + ["b"] * (16 - at))
        assert steps(found) == [(f"1.{at - 1}", f"1.{at}")]
        assert len(found.looked_at) <= 2 + math.ceil(math.log2(15))


def test_each_of_several_changes_is_found() -> None:
    found = bisected(["a"] * 3 + ["b"] * 4 + ["c"] * 6 + ["d"])
    assert steps(found) == [("1.2", "1.3"), ("1.6", "1.7"), ("1.12", "1.13")]


def test_ends_that_do_not_differ_are_looked_at_alone() -> None:
    found = bisected(["a", "a", "b", "a"])
    assert not found.steps
    assert [portrait.version for portrait in found.looked_at] == ["1.0", "1.3"]


def test_releases_that_do_not_run_are_stepped_over_and_named() -> None:
    found = bisected(["a", "a", BROKEN, BROKEN, "b", "b"])
    assert steps(found) == [("1.1", "1.4")]
    assert found.steps[0].skipped == ["1.2", "1.3"]


def test_an_end_that_does_not_run_gives_way() -> None:
    found = bisected([BROKEN, "a", "b", BROKEN])
    assert found.low is not None
    assert found.high is not None
    assert (found.low.version, found.high.version) == ("1.1", "1.2")
    assert steps(found) == [("1.1", "1.2")]
    alone = bisected([BROKEN, "a", BROKEN])
    assert alone.high is None
    assert bisected([BROKEN, BROKEN]).low is None


@given(st.lists(st.sampled_from(["a", "b", "c", BROKEN]), min_size=2, max_size=24))
@settings(derandomize=True, max_examples=200, deadline=None)
def test_what_is_found_is_there(values: list[str]) -> None:
    """Whatever the releases do, a step reported of has two sides that differ and none between."""
    found = bisected(values)
    for before, after in steps(found):
        low, high = int(before[2:]), int(after[2:])
        assert values[low] != values[high]
        assert set(values[low + 1 : high]) <= {BROKEN}
    running = [value for value in values if value != BROKEN]
    if running and running[0] != running[-1]:
        assert found.steps


def test_of_an_integrator_that_appears_no_other_change_is_reported() -> None:
    there = ("integrator", "discrete")
    own = {("scheme", "discrete", "free"): Figure("unknown"), there: Figure("there")}
    one = Portrait("1.0", integrators=["RK4"])
    other = Portrait("1.1", integrators=["RK4", "discrete"], figures=own)
    assert [change.name for change in changes_between(one, other)] == [there]
    vanished = changes_between(other, one)
    assert [(change.name, change.after) for change in vanished] == [(there, None)]


def test_what_is_not_reported_is_no_change() -> None:
    frame = ("convention", "velocity frame")
    one = Portrait("1.0", unreported=frozenset({"convention"}))
    other = Portrait("1.1", figures={frame: Figure("body axes")})
    assert changes_between(one, other) == []
    assert len(changes_between(Portrait("1.0"), other)) == 1


def test_paces_are_apart_where_their_spreads_do_not_touch() -> None:
    slow, fast = pace_of([4.0, 5.0, 6.0]), pace_of([1.0, 2.0, 2.5])
    assert slow is not None
    assert fast is not None
    ratio = ratio_of(slow, fast)
    assert (ratio.value, ratio.apart) == (0.4, True)
    assert (ratio.least, ratio.most) == (1.0 / 6.0, 2.5 / 4.0)
    touching = pace_of([2.5, 9.0])
    assert touching is not None
    assert not ratio_of(fast, touching).apart
    assert pace_of([]) is None


def test_a_term_that_no_metric_has_is_named() -> None:
    names = [NAME, ("convention", "velocity frame")]
    text = _no_such("convention attitude", names)
    assert "no metric has all of these terms in its name" in text
    assert "order:RK4:free:attitude" in text
    assert "'speed'" in _no_such("speed RK4", names)
