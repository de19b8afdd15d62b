"""What engines themselves do is measured past their adapters, and reported in the same terms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from omegadot.adapters.mujoco.integrators import Case, declared_integrators
from omegadot.adapters.native_axes import GIVEN, TURNED, axes_observed, described
from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.commands.versions.release import version_of
from omegadot.workers.engine_end.checked import AnswerError, checked_native
from omegadot.workers.engine_end.operations import OPERATIONS

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
    one, other = version_of(version), version_of(release)
    assert one is not None
    assert other is not None
    return one >= other


@pytest.mark.parametrize("engine", EXPECTED)
def test_conventions_are_those_of_the_installed_release(engine: str) -> None:
    pytest.importorskip({"dart": "dartpy"}.get(engine, engine))
    adapter: Any = build_adapter(BUILT_IN[engine])
    reported = OPERATIONS["native"](adapter, {})
    assert reported["conventions"].items() >= EXPECTED[engine].items()
    assert reported["defaults"]
    if engine == "dart":
        frame = "world" if at_least(adapter.description.version, "6.17.0") else "body"
        for what in ("velocity frame", "linear velocity frame"):
            assert reported["conventions"][f"FreeJoint {what}"] == f"{frame} axes"


def test_axes_are_determined_from_what_is_seen() -> None:
    assert axes_observed(GIVEN) == "world axes"
    assert axes_observed(TURNED @ GIVEN) == "body axes"
    assert "(0, 0, 1)" in axes_observed(np.array([0.0, 0.0, 1.0]))
    assert "neither" in axes_observed(np.full(3, np.nan))


def test_settings_are_the_same_text_where_they_are_the_same() -> None:
    assert described(np.array([[0.0, -0.0], [1e-3, 9.81]])) == "(0, 0, 0.001, 9.81)"
    assert described(True) == "True"
    assert described(np.int32(3)) == "3"


def test_an_adapter_without_the_request_reports_it() -> None:
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
