"""A system as an iDynTree model, built by its API or read by its own reader of URDF."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from omegadot.adapters.body_files import NAME, origin_at_pivot, urdf_of
from omegadot.adapters.protocol import UnsupportedError
from omegadot.reference_impl.system import Body, System

WORLD = "world"  # the link that stands still where the body is pivoted, as `urdf_of` names it
CENTER = "center"  # the frame at the body's centre of mass


def build_model(engine: ModuleType, system: System) -> Any:
    """A free link, its frame at the body's origin, or one on a spherical joint at the pivot.

    iDynTree has every model float: its base is the body, or the link that carries the joint.
    """
    of: Any = engine
    model, link = of.Model(), of.Link()
    link.setInertia(_inertia(of, system))
    if system.load.pivot is None:
        model.addLink(NAME, link)
    else:
        world, none = of.Link(), of.SpatialInertia()
        none.zero()  # a new one is what was in memory
        world.setInertia(none)
        model.addLink(WORLD, world)
        joint = of.SphericalJoint(of.Transform.Identity())
        model.addJointAndLink(WORLD, "joint", joint, NAME, link)
    return model


def read_model(engine: ModuleType, system: System) -> Any:
    """The same of a URDF. iDynTree knows the joint type "spherical", which URDF does not.

    Raises UnsupportedError where it refuses the file.
    """
    of: Any = engine
    joint = "" if system.load.pivot is None else "spherical"
    loader = of.ModelLoader()
    if not loader.loadModelFromString(urdf_of(system, origin_at_pivot(system), joint), "urdf"):
        raise UnsupportedError("iDynTree refuses the URDF of this body.")
    return loader.model().copy()  # what it gives is a reference into the loader


def _inertia(of: Any, system: System) -> Any:
    body, found = system.body, of.SpatialInertia()
    lever = np.array(body.center_of_mass, float) - origin_at_pivot(system)
    tensor = of.RotationalInertia(np.array(body.inertia, float))
    place = of.Position.FromPython(lever)
    found.fromRotationalInertiaWrtCenterOfMass(float(body.mass), place, tensor)
    return found


def read_back(model: Any) -> Body:
    """Mass, centre of mass from the link's frame, and inertia about it, as the model holds them."""
    inertia = model.getLink(model.getLinkIndex(NAME)).getInertia()
    return Body(
        np.array(inertia.getMass()),
        inertia.getCenterOfMass().toNumPy(),
        inertia.getRotationalInertiaWrtCenterOfMass().toNumPy(),
    )


def gyration(model: Any) -> float:
    """The radius of gyration about the link's frame in m, as a power of two."""
    inertia = model.getLink(model.getLinkIndex(NAME)).getInertia()
    tensor = inertia.getRotationalInertiaWrtFrameOrigin().toNumPy()
    square = float(np.trace(tensor)) / (3 * inertia.getMass())
    return float(2.0 ** np.round(np.log2(square) / 2))


def in_unit(engine: ModuleType, model: Any, length: float) -> Any:
    """The free body again, with a unit of length of so many m, a power of two."""
    of: Any = engine
    inertia, found, link = (
        model.getLink(model.getLinkIndex(NAME)).getInertia(),
        of.Model(),
        of.Link(),
    )
    center = of.Position.FromPython(inertia.getCenterOfMass().toNumPy() / length)
    tensor = inertia.getRotationalInertiaWrtFrameOrigin().toNumPy() / length**2
    link.setInertia(of.SpatialInertia(inertia.getMass(), center, of.RotationalInertia(tensor)))
    found.addLink(NAME, link)
    return found


def with_center(engine: ModuleType, model: Any) -> Any:
    """The model with a frame at the body's centre of mass."""
    of: Any = engine
    center = of.Position.FromPython(read_back(model).center_of_mass)
    model.addAdditionalFrameToLink(NAME, CENTER, of.Transform(of.Rotation.Identity(), center))
    return model
