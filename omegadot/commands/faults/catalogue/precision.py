"""Faults of storage: what is kept in single precision, or in another order."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.load import other_load
from omegadot.commands.faults.catalogue.model import UnseenBody, other_body
from omegadot.commands.faults.fault import Spoiled, fault_by, logged
from omegadot.commands.faults.features import NEAR
from omegadot.diagnosis.stepping.step_ends import single_precision
from omegadot.reference_impl.system import Array, Body, Load

SINGLE = ("single precision", "digits")

unseen_body = partial(fault_by, UnseenBody, "body", "model", "equation")


def in_single(values: Array) -> Array:
    """Rounded to single precision, as doubles."""
    return np.asarray(np.asarray(values, np.float32), float)


@other_body("odd-mass", named=SINGLE)
def MassInSinglePrecision(body: Body) -> Body:
    """The mass is kept in single precision, and read back so."""
    return replace(body, mass=in_single(body.mass))


@unseen_body("odd-mass pivot lever", named=SINGLE)
def MassInSinglePrecisionUnseen(body: Body) -> Body:
    """The mass is kept in single precision in the dynamics, and read back as requested."""
    return replace(body, mass=in_single(body.mass))


@unseen_body("asymmetric", named=SINGLE)
def BodyInSinglePrecision(body: Body) -> Body:
    """All of the body is kept in single precision in the dynamics, and reads back as requested."""
    return Body(*map(in_single, (body.mass, body.center_of_mass, body.inertia)))


@other_load("odd-load", named=SINGLE)
def LoadInSinglePrecision(load: Load) -> Load:
    """The loads are kept in single precision."""
    kept: dict[str, Any] = {k: v if v is None else in_single(v) for k, v in vars(load).items()}
    return Load(**kept)


@logged("logging", "scheme", named=SINGLE)
def LogsInSinglePrecision(self: Spoiled, trajectory: Trajectory) -> Trajectory:
    """What is reported of a run was stored in single precision; the run itself is in double."""
    state = trajectory.state
    return Trajectory(trajectory.time, single_precision(state, state, 0.0))


def reordered(body: Body) -> Body:
    """With Ixy, Ixz, Iyz read as Ixy, Iyz, Ixz."""
    tensor = body.inertia.copy()
    tensor[0, 2] = tensor[2, 0] = body.inertia[1, 2]
    tensor[1, 2] = tensor[2, 1] = body.inertia[0, 2]
    return replace(body, inertia=tensor)


@other_body("full-inertia", named=("products of inertia", "another inertia"))
def InertiaProductsReordered(body: Body) -> Body:
    """The products of inertia stand in another order: Ixz and Iyz are swapped."""
    return reordered(body)


@unseen_body("full-inertia", named=("products of inertia", "another inertia"))
def InertiaProductsReorderedUnseen(body: Body) -> Body:
    """Ixz and Iyz are swapped in the dynamics, and the model reads back as requested."""
    return reordered(body)


@unseen_body("full-inertia", named=("products of inertia", "another inertia"))
def InertiaProductsReversedUnseen(body: Body) -> Body:
    """The products of inertia have the other sign in the dynamics alone."""
    return replace(body, inertia=2 * np.diag(np.diag(body.inertia)) - body.inertia)


@other_body("unsorted-moments", named=("axes are permuted", "principal axes", "another inertia"))
def InertiaMomentsSorted(body: Body) -> Body:
    """The diagonal of a diagonal inertia is sorted, and the axes are not."""
    off = body.inertia - np.diag(np.diag(body.inertia))
    moments = np.sort(np.diag(body.inertia))
    return body if np.any(off) else replace(body, inertia=np.diag(moments))


@unseen_body("near-pair", named=("another inertia", "moments"))
def NearMomentsMerged(body: Body) -> Body:
    """Principal moments within 1 % of each other are taken for their mean in the dynamics."""
    moments, axes = np.linalg.eigh(body.inertia)
    for first in (0, 1):
        pair = moments[first : first + 2]
        if pair[1] - pair[0] <= NEAR * pair[1]:
            pair[:] = pair.mean()
    return replace(body, inertia=axes @ np.diag(moments) @ axes.T)
