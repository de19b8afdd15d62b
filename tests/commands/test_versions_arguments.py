"""Which releases the arguments of the command line mean, and what metrics are called."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from platformdirs import user_cache_path

from omegadot.commands.versions.environments import default_cache
from omegadot.commands.versions.metric import Figure, differ, matching, shown, unknown_metric
from omegadot.commands.versions.release import (
    Span,
    product_of,
    requested_releases,
    rising,
    version_of,
)
from omegadot.harness.usage import UsageError

RELEASES = ("6.16.2", "6.16.10", "6.17.0", "6.17.1", "6.18.0rc1", "6.18.0", "6.18.0.post1", "7.0")


def releases(span: Span) -> Sequence[str]:
    return span.of(RELEASES)


def test_versions_are_ordered_by_number() -> None:
    assert rising(reversed(RELEASES)) == list(RELEASES)
    assert rising(["1.10", "1.9", "1.9", "about"]) == ["1.9", "1.10"]
    assert version_of("4.0") == version_of("4.0.0")
    assert version_of("4.0.dev1") < version_of("4.0a1") < version_of("4.0rc1") < version_of("4.0")  # type: ignore[operator]
    assert version_of("4.x") is None


ORDERED = (
    "1.0.dev1",
    "1.0a1",
    "1.0a2",
    "1.0b1",
    "1.0rc1",
    "1.0",
    "1.0.post1",
    "1.0.1",
    "1.2",
    "1.10",
)


@given(st.lists(st.sampled_from(ORDERED), unique=True), st.randoms(use_true_random=False))
def test_any_order_of_versions_rises_alike(versions: list[str], random: Random) -> None:
    """Compared as texts, or by their numbers alone, some of these stand elsewhere."""
    shuffled = [f"{version}.0" if version[-2:] == "10" else version for version in versions]
    random.shuffle(shuffled)
    found = rising([*shuffled, *versions])
    assert [version_of(text) for text in found] == [version_of(v) for v in ORDERED if v in versions]
    assert rising(found) == found


@given(st.sampled_from(ORDERED), st.sampled_from(ORDERED))
def test_a_range_is_what_lies_between_its_ends(low: str, high: str) -> None:
    between = ORDERED[ORDERED.index(low) : ORDERED.index(high) + 1]
    finals = [v for v in between if not any(mark in v for mark in ("dev", "a", "b", "rc"))]
    assert Span(low, high).of(ORDERED) == finals


def test_ranges_have_both_ends_and_no_trial_releases() -> None:
    assert Span("6.16.10", "6.18.0").of(RELEASES) == ["6.16.10", "6.17.0", "6.17.1", "6.18.0"]
    assert Span("", "6.16.10").of(RELEASES) == ["6.16.2", "6.16.10"]
    assert Span("6.18.0", "").of(RELEASES) == ["6.18.0", "6.18.0.post1", "7.0"]


def test_arguments_are_versions_ranges_and_interpreters() -> None:
    python = sys.executable
    versions, pythons = requested_releases(
        ["7.0", "6.16.2..6.17.0", f"6.17.1={python}", "6.17.0"], releases
    )
    assert versions == ["6.16.2", "6.16.10", "6.17.0", "6.17.1", "7.0"]
    assert pythons == {"6.17.1": python}


@pytest.mark.parametrize(
    ("names", "text"),
    [
        ([], "none is named"),
        (["1.0"], "only 1.0 is named"),
        (["1.0", "1.0.0"], "only"),
        (["1.0", "new"], "'new' is no version"),
        (["1.0", "x..2.0"], "'x' is no version"),
        (["6.18.0..6.17.0"], "write 6.17.0..6.18.0"),
        (["8.0..9.0"], "they go from 6.16.2 to 7.0"),
        ([".."], "a range has two ends"),
        (["6.16.2.."], "a range has two ends"),
        (["..7.0"], "a range has two ends"),
        (["1.0..2.0=/bin/sh"], "a range has no single interpreter"),
        (["1.0=/no/such/python", "2.0"], "is no program"),
        (["1.0=", "2.0"], "nothing is no program"),
        (["", "2.0"], "an empty version"),
    ],
)
def test_wrong_arguments_are_one_sentence(names: list[str], text: str) -> None:
    with pytest.raises(UsageError) as caught:
        requested_releases(names, releases)
    assert text in str(caught.value)
    assert "\n" not in str(caught.value)


def test_engines_go_by_their_packages_names_too() -> None:
    assert product_of("dartpy") is product_of("dart")
    assert product_of("pin").engine == "pinocchio"
    assert product_of("own", "file.py:Own", "own-package").package == "own-package"
    with pytest.raises(UsageError, match="write mujoco"):
        product_of("mujoko")


def test_what_a_release_needs_comes_along() -> None:
    plain = product_of("mujoco").requirements("3.6.0")
    assert plain == ["mujoco==3.6.0", "numpy", "scipy"]
    assert "cmeel-urdfdom<5" in product_of("pin").requirements("3.4.0")
    assert product_of("pin").requirements("4.1.0") == ["pin==4.1.0", "numpy", "scipy"]


@pytest.mark.parametrize(("value", "folder"), [("/c", "/c"), ("", "/h/.cache")])
def test_the_cache_is_where_the_platform_has_it(
    monkeypatch: pytest.MonkeyPatch, value: str, folder: str
) -> None:
    monkeypatch.setenv("HOME", "/h")
    monkeypatch.setenv("XDG_CACHE_HOME", value)
    if sys.platform != "linux" and not value:
        folder = str(user_cache_path())
    assert default_cache() == Path(folder) / "omegadot" / "versions"


def test_numbers_differ_beyond_both_bands_alone() -> None:
    assert differ(Figure(1.0, 0.1), Figure(1.3, 0.1))
    assert not differ(Figure(1.0, 0.1), Figure(1.3, 0.25))
    assert not differ(Figure(1.0, math.inf), Figure(5.0, 0.1))
    assert not differ(Figure(0.0), Figure(0.0))
    assert differ(Figure(1.0, 0.1), Figure(math.nan, 0.1))
    assert not differ(Figure(math.nan), Figure(math.nan))


def test_texts_and_presence_differ_plainly() -> None:
    assert differ(Figure("body axes"), Figure("world axes"))
    assert not differ(Figure("body axes"), Figure("body axes"))
    assert differ(Figure("rounding alone"), Figure(2.0, 0.15))
    assert differ(None, Figure("there"))
    assert not differ(None, None)
    assert not differ(Figure(None), Figure(2.0, 0.15))
    assert shown(("order", "RK4"), Figure(1.996, 0.15)) == "2.00"
    assert shown(("drift", "x"), None) == "none"
    assert shown(("drift", "x"), Figure(None)) == "not stated"


NAMES = [
    ("order", "RK4", "free", "attitude"),
    ("order", "RK4", "free", "omega"),
    ("drift", "box", "RK4", "0.01", "angular_momentum"),
    ("convention", "FreeJoint velocity frame"),
]


@pytest.mark.parametrize(
    ("names", "found"),
    [
        ("order attitude RK4", [0]),
        ("RK4:order", [0, 1]),
        ("mujoco rk4.attitude.order", [0]),
        ("orders RK4 free", [0, 1]),
        ("angular momentum 0.010 box", [2]),
        ("freejoint FRAME", [3]),
        ("attitude of RK4", []),
        ("", []),
    ],
)
def test_metrics_are_found_by_their_terms_in_any_order(names: str, found: list[int]) -> None:
    assert matching(names, NAMES, "mujoco") == [NAMES[n] for n in found]


def test_the_term_that_no_metric_has_is_named() -> None:
    assert unknown_metric("order attitude RK5", NAMES) == ["rk5"]
    assert unknown_metric("orders attitude", NAMES) == []
