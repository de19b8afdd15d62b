"""Faults of the model: the engine holds another body than it was given."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.commands.faults.fault import Spoiled, fault
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


@fault("model", "model", "full-inertia")
class InertiaDiagonal(OtherInertia):
    """Only the diagonal of the inertia is used."""

    def inertia(self, tensor: Array) -> Array:
        """Its diagonal alone."""
        return np.diag(np.diag(tensor))


@fault("model", "model", "full-inertia")
class InertiaPrincipal(OtherInertia):
    """The principal moments are taken for the diagonal: the axes' rotation is dropped."""

    def inertia(self, tensor: Array) -> Array:
        """Its eigenvalues on the diagonal."""
        return np.diag(np.linalg.eigvalsh(tensor))


@fault("model", "model", "full-inertia")
class InertiaProductsReversed(OtherInertia):
    """The products of inertia have the other sign."""

    def inertia(self, tensor: Array) -> Array:
        """Off the diagonal, the other sign."""
        return np.asarray(2 * np.diag(np.diag(tensor)) - tensor)


@fault("model", "model", "full-inertia")
class InertiaTransposedAxes(OtherInertia):
    """The principal axes' rotation is transposed: ``R^T D R`` stands for ``R D R^T``."""

    def inertia(self, tensor: Array) -> Array:
        """The same moments about axes turned the other way."""
        moments, axes = np.linalg.eigh(tensor)
        return np.asarray(axes.T @ np.diag(moments) @ axes)


@fault("model", "model", "asymmetric")
class InertiaPermuted(OtherInertia):
    """The inertia's axes are permuted."""

    def inertia(self, tensor: Array) -> Array:
        """X for z, y for x, z for y."""
        permuted: Array = tensor[np.ix_(NEXT_AXIS, NEXT_AXIS)]
        return permuted


@fault("model", "model")
class InertiaInverted(OtherInertia):
    """The inertia is inverted: its reciprocal tensor is used."""

    def inertia(self, tensor: Array) -> Array:
        """The inverse, in 1/(kg m^2) and taken for kg m^2."""
        return np.linalg.inv(tensor)


@fault("model", "model")
class InertiaSlightlyOff(OtherInertia):
    """The inertia is 0.1 % too large, which a free body's omega cannot show."""

    def inertia(self, tensor: Array) -> Array:
        """A thousandth more."""
        return 1.001 * tensor


@fault("model", "model", "offset")
class InertiaAboutOrigin(OtherBody):
    """The inertia is that about the body's origin instead of the centre of mass."""

    def body(self, body: Body) -> Body:
        """The parallel axis added once too often."""
        shifted = body.inertia + parallel_axis(body.mass, body.center_of_mass)
        return replace(body, inertia=shifted)


@fault("model", "equation", "asymmetric")
class InertiaUnseen(OtherInertia):
    """One moment is 0.1 % off in the dynamics, and the model reads back as requested."""

    def inertia(self, tensor: Array) -> Array:
        """One moment, in its own axes."""
        moments, axes = np.linalg.eigh(tensor)
        return np.asarray(axes @ np.diag(moments * [1.0, 1.001, 1.0]) @ axes.T)

    def model(self) -> tuple[Body, ...]:
        """What was requested."""
        return self.system.bodies


@fault("model", "model")
class MassSlightlyOff(OtherBody):
    """The mass is 0.1 % too large."""

    def body(self, body: Body) -> Body:
        """A thousandth more, the inertia as requested."""
        return replace(body, mass=1.001 * body.mass)


@fault("model", "model", "offset")
class CenterOfMassIgnored(OtherBody):
    """The centre of mass is put at the body's origin."""

    def body(self, body: Body) -> Body:
        """No offset."""
        return replace(body, center_of_mass=np.zeros_like(body.center_of_mass))


@fault("model", "model", "offset")
class CenterOfMassMirrored(OtherBody):
    """The centre of mass lies on the other side of the body's origin."""

    def body(self, body: Body) -> Body:
        """The offset from the centre of mass taken for that to it."""
        return replace(body, center_of_mass=-body.center_of_mass)
