"""Faults of the model: the engine holds another body than it was given."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.faults.fault import Spoiled, fault, fault_by
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, Body, System

NEXT_AXIS = np.array([1, 2, 0])


class OtherBody(Spoiled):
    """The engine is given the body that `body` makes of the one requested."""

    def body(self, body: Body) -> Body:
        """The wrong body."""
        return body

    def loaded(self, system: System) -> System:
        """The system with the wrong body."""
        return replace(system, bodies=tuple(self.body(one) for one in system.bodies))


class OtherInertia(OtherBody):
    """The engine is given the tensor that `inertia` makes of the one requested."""

    def inertia(self, tensor: Array) -> Array:
        """The wrong tensor."""
        return tensor

    def body(self, body: Body) -> Body:
        """The body with the wrong tensor."""
        return replace(body, inertia=self.inertia(body.inertia))


other_body = partial(fault_by, OtherBody, "body", "model", "model")
other_inertia = partial(fault_by, OtherInertia, "inertia", "model", "model")


@other_inertia("full-inertia", named="only the diagonal of the inertia")
def InertiaDiagonal(tensor: Array) -> Array:
    """Only the diagonal of the inertia is used."""
    return np.diag(np.diag(tensor))


@other_inertia("full-inertia", named="the rotation of their axes is dropped")
def InertiaPrincipal(tensor: Array) -> Array:
    """The principal moments are taken for the diagonal: the axes' rotation is dropped."""
    return np.diag(np.linalg.eigvalsh(tensor))


@other_inertia("full-inertia", named="products of inertia have the wrong sign")
def InertiaProductsReversed(tensor: Array) -> Array:
    """The products of inertia have the other sign."""
    return np.asarray(2 * np.diag(np.diag(tensor)) - tensor)


@other_inertia("full-inertia", named="principal axes looks transposed")
def InertiaTransposedAxes(tensor: Array) -> Array:
    """The principal axes' rotation is transposed: ``R^T D R`` stands for ``R D R^T``."""
    moments, axes = np.linalg.eigh(tensor)
    return np.asarray(axes.T @ np.diag(moments) @ axes)


@other_inertia("asymmetric", named="the inertia's axes are permuted")
def InertiaPermuted(tensor: Array) -> Array:
    """The inertia's axes are permuted."""
    permuted: Array = tensor[np.ix_(NEXT_AXIS, NEXT_AXIS)]
    return permuted


@other_inertia(named="the inertia is inverted")
def InertiaInverted(tensor: Array) -> Array:
    """The inertia is inverted: its reciprocal tensor is used."""
    return np.linalg.inv(tensor)


@other_inertia(named="the inertia is 1.001 times")
def InertiaSlightlyOff(tensor: Array) -> Array:
    """The inertia is 0.1 % too large, which a free body's omega cannot show."""
    return 1.001 * tensor


@other_body("offset", named="the inertia is about the body's origin")
def InertiaAboutOrigin(body: Body) -> Body:
    """The inertia is that about the body's origin instead of the centre of mass."""
    shifted = body.inertia + parallel_axis(body.mass, body.center_of_mass)
    return replace(body, inertia=shifted)


@fault("model", "equation", "asymmetric", named="those of another inertia")
class InertiaUnseen(OtherInertia):
    """One moment is 0.1 % off in the dynamics, and the model reads back as requested."""

    def inertia(self, tensor: Array) -> Array:
        """One moment, in its own axes."""
        moments, axes = np.linalg.eigh(tensor)
        return np.asarray(axes @ np.diag(moments * [1.0, 1.001, 1.0]) @ axes.T)

    def model(self) -> tuple[Body, ...]:
        """What was requested."""
        return self.system.bodies


@other_body(named="the mass is 1.001 times")
def MassSlightlyOff(body: Body) -> Body:
    """The mass is 0.1 % too large."""
    return replace(body, mass=1.001 * body.mass)


@other_body("offset", named="the centre of mass is ignored")
def CenterOfMassIgnored(body: Body) -> Body:
    """The centre of mass is put at the body's origin."""
    return replace(body, center_of_mass=np.zeros_like(body.center_of_mass))


@other_body("offset", named="the centre of mass has the wrong sign")
def CenterOfMassMirrored(body: Body) -> Body:
    """The centre of mass lies on the other side of the body's origin."""
    return replace(body, center_of_mass=-body.center_of_mass)
