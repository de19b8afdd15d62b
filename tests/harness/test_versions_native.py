"""What engines themselves do is measured past their adapters, and told in the same words."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from omegadot.adapters.checked import AnswerError, checked_native
from omegadot.adapters.mujoco_integrators import Case, declared_integrators
from omegadot.adapters.native_axes import GIVEN, TURNED, axes_told_by, in_words
from omegadot.adapters.operations import OPERATIONS
from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.reference import ReferenceAdapter
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.harness.versions.release import key_of

EXPECTED = {
    "mujoco": {
        "quaternion order": "w, x, y, z",
        "free joint angular velocity frame": "body axes",
        "free joint linear velocity frame": "world axes",
        "free joint linear velocity point": "body origin",
        "ball joint angular velocity frame": "body axes",
    },
    "dart": {
        "FreeJoint velocity order": "angular, linear",
        "BallJoint velocity frame": "body axes",
        "turns below 1e-3 rad": "expanded to second order",
    },
    "pinocchio": {
        "quaternion order": "x, y, z, w",
        "free-flyer velocity order": "linear, angular",
        "free-flyer linear velocity frame": "body axes",
        "free-flyer angular velocity frame": "body axes",
        "spherical joint velocity frame": "body axes",
    },
}


def at_least(version: str, release: str) -> bool:
    one, other = key_of(version), key_of(release)
    assert one is not None
    assert other is not None
    return one >= other


@pytest.mark.parametrize("engine", EXPECTED)
def test_conventions_are_those_of_the_installed_release(engine: str) -> None:
    pytest.importorskip({"dart": "dartpy"}.get(engine, engine))
    adapter: Any = build_adapter(BUILT_IN[engine])
    told = OPERATIONS["native"](adapter, {})
    assert told["conventions"].items() >= EXPECTED[engine].items()
    assert told["defaults"]
    if engine == "dart":
        frame = "world" if at_least(adapter.description.version, "6.17.0") else "body"
        for what in ("velocity frame", "linear velocity frame"):
            assert told["conventions"][f"FreeJoint {what}"] == f"{frame} axes"


def test_axes_are_told_from_what_is_seen() -> None:
    assert axes_told_by(GIVEN) == "world axes"
    assert axes_told_by(TURNED @ GIVEN) == "body axes"
    assert "(0, 0, 1)" in axes_told_by(np.array([0.0, 0.0, 1.0]))
    assert "neither" in axes_told_by(np.full(3, np.nan))


def test_settings_are_the_same_text_where_they_are_the_same() -> None:
    assert in_words(np.array([[0.0, -0.0], [1e-3, 9.81]])) == "(0, 0, 0.001, 9.81)"
    assert in_words(True) == "True"
    assert in_words(np.int32(3)) == "3"


def test_an_adapter_without_the_question_says_so() -> None:
    with pytest.raises(UnsupportedError):
        OPERATIONS["native"](ReferenceAdapter(), {})


@pytest.mark.parametrize(
    "found",
    [
        None,
        {"conventions": {}},
        {"conventions": {"frame": 1}, "defaults": {}},
        {"conventions": {1: "body"}, "defaults": {}},
    ],
)
def test_answers_are_held_to_their_types(found: Any) -> None:
    with pytest.raises(AnswerError, match="native"):
        checked_native(found)


def test_the_midpoint_of_mujoco_falls_with_order_1() -> None:
    mujoco = pytest.importorskip("mujoco")

    def energy(case: Case) -> int:
        declared = {i.name: i for i in declared_integrators(mujoco, case)}
        assert declared["implicitfast"].orders["omega"] == 2
        return declared["implicitfast"].orders["energy"]

    assert energy(Case((3, 7, 0))) == 2
    assert energy(Case((3, 7, 0), falls=True)) == 1
    assert energy(Case((3, 10, 0), offset=True)) == 1
