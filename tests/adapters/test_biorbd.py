"""biorbd's models, and what of its dynamics is not as a reader may expect."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, at, norm, states, system

from omegadot.adapters.biorbd.adapter import BiorbdAdapter
from omegadot.adapters.biorbd.model import build_model
from omegadot.adapters.biorbd.motion import own_coordinates
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, Load, System

biorbd = pytest.importorskip("biorbd")

DRAG = 0.5  # N m s
MOMENTS = np.array([1.0, 2.0, 3.0])
UPRIGHT, SPIN, TORQUE = np.array([0.0, 0.0, 0.0, 1.0]), np.array([1.0, 2.0, 3.0]), np.full(3, 0.3)


def made(of: System) -> BiorbdAdapter:
    adapter = BiorbdAdapter()
    adapter.load(of)
    return adapter


def bare(damping: list[float]) -> Any:
    """By biorbd's interface: a body on a quaternion, its joint damped by these."""
    none, held = biorbd.VecBiorbdRange(), biorbd.VecBiorbdScalar()
    for value in damping:
        held.append(value)
    numbers = np.diag(MOMENTS).ravel().tolist()
    center = biorbd.Vector3d(0.0, 0.0, 0.0)
    body = biorbd.SegmentCharacteristics(1.0, center, biorbd.Matrix3d(*numbers))
    model = biorbd.Model()
    place = biorbd.RotoTrans()
    model.AddSegment("body", "root", "", "q", none, none, none, held, body, place)
    return model


def solved(model: Any) -> Array:
    """The torque of `InverseDynamics` for the acceleration of `ForwardDynamics`."""
    found = model.ForwardDynamics(UPRIGHT, SPIN, TORQUE).to_array()
    torque: Array = model.InverseDynamics(UPRIGHT, SPIN, found[:3]).to_array()
    return torque


@pytest.mark.parametrize("drag", [0.0, DRAG])
def test_inverse_dynamics_has_damping_with_the_wrong_sign(drag: float) -> None:
    """By its own interface: the inverse of its forward dynamics is off by ``2 d ω``."""
    off = solved(bare([drag] * 3)) - TORQUE
    assert norm(off + 2 * drag * SPIN) <= 64 * EPS * norm(np.cross(SPIN, MOMENTS * SPIN))


def test_the_torque_of_a_damped_body_is_that_without_damping() -> None:
    """Caught: biorbd's own, where the adapter asks the model that is damped."""
    damped, plain = system("full", "pivot_damping"), system("full", "pivot_gravity")
    many = place_on_pivot(damped, states(6, seed=3, fast=2.0))
    wanted = made(damped).forward_dynamics(many)
    found, expected = (made(of).inverse_dynamics(many, wanted) for of in (damped, plain))
    assert np.array_equal(found, expected)
    drag = float(damped.load.damping)
    own = build_model(biorbd, damped, damped=True)
    q, v, _ = own_coordinates(*made(damped)._joint.coordinates(at(many, 0)))
    theirs = own.InverseDynamics(q, v, wanted.angular[0]).to_array()
    assert norm(theirs - found[0] + drag * many.angular_velocity[0]) <= 1e-13 * norm(found[0])


def test_forward_dynamics_answers_with_a_number_too_many() -> None:
    """As long as Q, which has four numbers, where there are three accelerations."""
    found = bare([]).ForwardDynamics(UPRIGHT, SPIN, TORQUE).to_array()
    assert (len(found), bare([]).nbQddot()) == (4, 3)
    for load in ("all", "pivot_all"):
        of = system("full", load)
        joint = made(of)._joint
        q, v = joint.coordinates(place_on_pivot(of, at(states(1, seed=5), 0)))
        assert len(joint.motion.acceleration(q, v)) == len(v)


@pytest.mark.parametrize("load", ["all", "pivot_all"])
@pytest.mark.parametrize("length", [0.5, 1.0, 3.0])
def test_a_quaternion_that_is_not_unit_is_one_of_its_direction(load: str, length: float) -> None:
    """The stages of a scheme have such. biorbd refuses them, or turns by them as they are."""
    of = system("full", load)
    q, v = made(of)._joint.coordinates(place_on_pivot(of, at(states(1, seed=6, fast=2.0), 0)))
    longer = q.copy()
    longer[-4:] *= length
    motion = made(of)._joint.motion
    found, expected = motion.acceleration(longer, v), motion.acceleration(q, v)
    assert norm(found - expected) <= 64 * EPS * norm(expected)


def test_damping_is_that_of_the_joint() -> None:
    """Caught: damping that acts twice, in the model and as a torque."""
    of = replace(
        system("full", "pivot_damping"), load=Load(pivot=np.zeros(3), damping=np.array(DRAG))
    )
    start = place_on_pivot(of, at(states(1, seed=28, far=1.0, fast=2.0), 0))
    joint = made(of)._joint
    q, v = joint.coordinates(start)
    for scheme in ("lie-rk4", "linearly-implicit-euler"):
        own = SCHEMES[scheme].step(body_motion(of, "body-spatial"), q, v, 0.005)
        found = SCHEMES[scheme].step(joint.motion, q, v, 0.005)
        for ours, theirs in zip(own, found, strict=True):
            assert norm(theirs - ours) <= 20 * 64 * EPS * norm(ours)


def test_a_velocity_is_that_of_the_origin_in_world_axes() -> None:
    of = system("full")
    state = at(states(1, seed=7), 0)
    joint = made(of)._joint
    q, v = joint.coordinates(state)
    _, own, unit = own_coordinates(q, v)
    assert norm(own[:3] - rotate(np.array(unit), v[:3])) <= 8 * EPS * norm(v[:3])
    assert np.array_equal(own[3:], v[3:])


def test_importing_the_adapter_leaves_the_engine_alone() -> None:
    code = "import sys, omegadot.adapters.biorbd.adapter; sys.exit('biorbd' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_it_describes_itself() -> None:
    native = BiorbdAdapter().native()
    assert native["conventions"] == {
        "quaternion order": "x, y, z, w",
        "linear velocity frame": "world axes",
        "angular velocity frame": "body axes",
        "segmentAngularVelocity frame": "world axes",
        "numbers that ForwardDynamics answers with, of 6": "7",
        "damping in InverseDynamics": "subtracted",
    }
    assert native["defaults"] == {"gravity": "(0, 0, -9.81)"}
