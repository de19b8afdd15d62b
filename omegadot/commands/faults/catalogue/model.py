"""Faults of the model: the engine holds another body than it was given."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.commands.faults.fault import OtherSystem, fault_by
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Body, System

NEXT_AXIS = np.array([1, 2, 0])


class OtherBody(OtherSystem):
    """The engine is given the body that `body` makes of the one requested."""

    body: Callable[[Body], Body]

    def loaded(self, system: System) -> System:
        """The system with the wrong body."""
        return replace(system, bodies=tuple(self.body(one) for one in system.bodies))


other_body = partial(fault_by, OtherBody, "body", "model", "model")


@other_body("full-inertia", named="only the diagonal of the inertia")
def InertiaDiagonal(body: Body) -> Body:
    """Only the diagonal of the inertia is used."""
    return replace(body, inertia=np.diag(np.diag(body.inertia)))


@other_body("full-inertia", named="the rotation of their axes is dropped")
def InertiaPrincipal(body: Body) -> Body:
    """The principal moments are taken for the diagonal: the axes' rotation is dropped."""
    return replace(body, inertia=np.diag(np.linalg.eigvalsh(body.inertia)))


@other_body("full-inertia", named="products of inertia have the wrong sign")
def InertiaProductsReversed(body: Body) -> Body:
    """The products of inertia have the other sign."""
    return replace(body, inertia=2 * np.diag(np.diag(body.inertia)) - body.inertia)


@other_body("full-inertia", named="principal axes looks transposed")
def InertiaTransposedAxes(body: Body) -> Body:
    """The principal axes' rotation is transposed: ``R^T D R`` stands for ``R D R^T``."""
    moments, axes = np.linalg.eigh(body.inertia)
    return replace(body, inertia=axes.T @ np.diag(moments) @ axes)


@other_body("asymmetric", named="the inertia's axes are permuted")
def InertiaPermuted(body: Body) -> Body:
    """The inertia's axes are permuted."""
    return replace(body, inertia=body.inertia[np.ix_(NEXT_AXIS, NEXT_AXIS)])


@other_body(named="the inertia is inverted")
def InertiaInverted(body: Body) -> Body:
    """The inertia is inverted: its reciprocal tensor is used."""
    return replace(body, inertia=np.linalg.inv(body.inertia))


@other_body(named="the inertia is 1.001 times")
def InertiaSlightlyOff(body: Body) -> Body:
    """The inertia is 0.1 % too large, which a free body's omega cannot show."""
    return replace(body, inertia=1.001 * body.inertia)


@other_body("offset", named="the inertia is about the body's origin")
def InertiaAboutOrigin(body: Body) -> Body:
    """The inertia is that about the body's origin instead of the centre of mass."""
    shifted = body.inertia + parallel_axis(body.mass, body.center_of_mass)
    return replace(body, inertia=shifted)


class UnseenBody(OtherBody):
    """The engine is given another body, and its model reads back as requested."""

    def model(self) -> tuple[Body, ...]:
        """What was requested."""
        return self.system.bodies


@fault_by(UnseenBody, "body", "model", "equation", "asymmetric", named="those of another inertia")
def InertiaUnseen(body: Body) -> Body:
    """One moment is 0.1 % off in the dynamics, and the model reads back as requested."""
    moments, axes = np.linalg.eigh(body.inertia)
    return replace(body, inertia=axes @ np.diag(moments * [1.0, 1.001, 1.0]) @ axes.T)


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
