"""iDynTree's models, how rounding depends on the unit of length, and its reader of URDF."""

from __future__ import annotations

import gc
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, OFFSET, PIVOT, at, norm, states, system

from omegadot.adapters.idyntree import model as idyntree_model
from omegadot.adapters.idyntree.adapter import IDynTreeAdapter
from omegadot.adapters.idyntree.joint import IDynTreeJoint
from omegadot.adapters.idyntree.model import build_model, read_model
from omegadot.adapters.idyntree.motion import dynamics_of
from omegadot.adapters.protocol import Setup, UnsupportedError
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, Body, State, System

idyntree = pytest.importorskip("idyntree.bindings")

free_and_pivoted = pytest.mark.parametrize("load", ["none", "all", "pivot", "pivot_all"])


def adapter_of(of: System, setup: Setup = "physics", via: Any = "") -> IDynTreeAdapter:
    adapter = IDynTreeAdapter(setup)
    adapter._take(of, via)
    return adapter


def in_lengths_of(length: float, load: str = "none") -> System:
    """The full body, its lengths as many times those of its own."""
    of = system("full", load)
    body = of.body
    scaled = Body(body.mass, body.center_of_mass * length, body.inertia * length**2)
    return replace(of, bodies=(scaled,))


def error(of: System, many: State, setup: Setup) -> Array:
    """Of omega-dot, in parts of ``|ω|²``."""
    found = adapter_of(of, setup).forward_dynamics(many).angular
    size = np.sum(many.angular_velocity**2, axis=-1)
    relative: Array = norm(found - forward_dynamics(of, many).angular) / size
    return relative


@pytest.mark.parametrize("length", [1e-4, 1e-2, 1e2, 1e4])
def test_omega_dot_does_not_depend_on_the_unit_of_length(length: float) -> None:
    """The condition of the tensor is below 3."""
    of, many = in_lengths_of(length), states(40, seed=31, fast=0.0)
    many = replace(many, linear_velocity=0.0 * many.linear_velocity)
    assert np.max(error(of, many, "physics")) <= 64 * EPS


def test_as_shipped_it_loses_digits_with_the_unit_of_length() -> None:
    """Moments of 1e8 kg m^2 beside a mass of 2 kg, as of a body of 10 km."""
    of, many = in_lengths_of(1e4), states(40, seed=31, fast=0.0)
    many = replace(many, linear_velocity=0.0 * many.linear_velocity)
    shipped, ours = (np.max(error(of, many, setup)) for setup in ("as-shipped", "physics"))
    assert shipped >= 100 * ours
    assert IDynTreeAdapter("physics").description.switched_off
    assert IDynTreeAdapter("as-shipped").description.switched_off == ()


@pytest.mark.parametrize("setup", ["physics", "as-shipped"])
@pytest.mark.parametrize("scheme", ["semi-implicit-euler", "lie-rk4"])
def test_both_setups_step_the_same_coordinates(setup: Setup, scheme: str) -> None:
    of, stepped = system("full", "all"), SCHEMES[scheme]
    start = at(states(1, seed=28, far=1.0, fast=2.0), 0)
    joint = IDynTreeJoint(idyntree, of, build_model(idyntree, of), setup)
    q, v = joint.coordinates(start)
    own = stepped.step(body_motion(of, "body-spatial"), q, v, 0.005)
    found = stepped.step(joint.motion, q, v, 0.005)
    for ours, theirs in zip(own, found, strict=True):
        assert np.max(np.abs(theirs - ours)) <= 20 * 64 * EPS * np.max(np.abs(ours))


def test_the_mass_matrix_of_a_pivoted_body_is_its_inertia_about_the_pivot() -> None:
    """What the articulated-body algorithm refuses is solved of it: caught, a base that moves."""
    of = system("full", "pivot")
    dynamics, mass = dynamics_of(idyntree, build_model(idyntree, of)), idyntree.MatrixDynSize(9, 9)
    dynamics.getFreeFloatingMassMatrix(mass)
    inertia = moving_inertia(of)
    np.testing.assert_allclose(mass.toNumPy()[6:, 6:], inertia, atol=64 * EPS * inertia.max())


@free_and_pivoted
def test_a_urdf_is_the_same_body(load: str) -> None:
    """Its type "spherical" is iDynTree's own. A reader's roundings are those of a turned tensor."""
    of = system("full", load)
    many = place_on_pivot(of, states(10, seed=29, far=1.0, fast=2.0))
    read, built = adapter_of(of, via="urdf"), adapter_of(of)
    (one,), (other,) = read.model(), built.model()
    assert one.mass == other.mass
    far = norm(OFFSET) + norm(PIVOT)
    assert np.max(np.abs(one.center_of_mass - other.center_of_mass)) <= 4 * EPS * far
    assert np.max(np.abs(one.inertia - other.inertia)) <= 64 * EPS * np.max(other.inertia)
    found, expected = (adapter.forward_dynamics(many).angular for adapter in (read, built))
    assert np.max(norm(found - expected)) <= 1e-13 * np.max(norm(expected))


def test_a_urdf_that_it_refuses_is_unsupported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(idyntree_model, "urdf_of", lambda *_: "<robot></robot")
    with pytest.raises(UnsupportedError, match="URDF"):
        read_model(idyntree, system())


def test_a_misread_tensor_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    """Caught: a reader that ignores how the inertial frame is turned."""
    writer = idyntree_model.urdf_of
    monkeypatch.setattr(
        idyntree_model, "urdf_of", lambda *given: writer(*given).replace("rpy", "ypr")
    )
    of = system("diagonal")
    (found,) = adapter_of(of, via="urdf").model()
    assert np.max(np.abs(found.inertia - of.body.inertia)) > 0.1


def test_the_link_that_stands_still_has_no_mass() -> None:
    """An inertia that is not set is what was in memory, and the centre of all links is off."""
    for _ in range(20):
        kept = [idyntree.SpatialInertia(float(n), idyntree.Position(), idyntree.RotationalInertia())
                for n in range(1, 40)]  # fmt: skip
        del kept
        model = build_model(idyntree, system("full", "pivot"))
        assert model.getTotalMass() == 2.0


@free_and_pivoted
def test_what_is_read_is_no_reference_to_what_is_gone(load: str) -> None:
    """Caught: a rotation of a transform, or a wrench of torques, that Python has freed."""
    of = system("full", load)
    adapter, many = adapter_of(of), place_on_pivot(of, states(1, seed=30, far=1.0, fast=2.0))
    adapter.set_state(at(many, 0))
    first, wanted = adapter.get_state(), adapter.forward_dynamics(many)
    torque = adapter.inverse_dynamics(many, wanted)
    for n in range(50):
        kept = [idyntree.Transform.Identity() for _ in range(n)]
        again = adapter.get_state()
        for one, other in zip(vars(first).values(), vars(again).values(), strict=True):
            assert np.array_equal(one, other)
        assert np.array_equal(adapter.inverse_dynamics(many, wanted), torque)
        del kept
        gc.collect()


def test_an_inertia_is_kept_about_the_links_frame() -> None:
    """At a kilometre it has lost ``m c² / I`` roundings of that about the centre of mass."""
    center = np.array([1000.1, 2000.3, -500.7])
    of = System((Body(np.array(1.3), center, np.diag([1.1, 2.2, 2.7])),))
    (found,) = adapter_of(of).model()
    lost = np.max(np.abs(found.inertia - of.body.inertia))
    assert 1e3 * EPS <= lost <= 8 * EPS * 1.3 * float(center @ center)


def test_it_describes_itself() -> None:
    native = IDynTreeAdapter().native()
    found = native["conventions"]
    assert found["BODY_FIXED: linear velocity frame"] == "body axes"
    assert found["BODY_FIXED: angular velocity frame"] == "body axes"
    assert found["MIXED: angular velocity frame"] == "world axes"
    assert found["INERTIAL_FIXED: linear velocity point"] == "the world's origin"
    assert found["spherical joint velocity frame"] == "body axes"
    assert found["articulated-body algorithm, spherical joint"] == "refused"
    assert native["defaults"]["velocity representation"] == "MIXED"
    assert native["defaults"]["spherical joint damping"] == "0"


def test_several_bodies_are_refused() -> None:
    body = system().body
    with pytest.raises(UnsupportedError, match="one body"):
        adapter_of(System((body, body)))
