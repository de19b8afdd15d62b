"""Conventions and defaults of the installed Exudyn, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.exudyn.nodes import NODES, Kind
from omegadot.adapters.native_axes import (
    GIVEN,
    TURNED_QUATERNION,
    axes_observed,
    described,
)
from omegadot.reference_impl.system import Array

SETTINGS = (
    *("adaptiveStep", "automaticStepSize", "absoluteTolerance", "relativeTolerance"),
    *("minimumStepSize", "numberOfSteps", "solverType"),
    *("explicit.eliminateConstraints", "explicit.useLieGroupIntegration"),
    *("generalizedAlpha.spectralRadius", "generalizedAlpha.lieGroupSimplifiedKinematicRelations"),
    *("newton.absoluteTolerance", "newton.relativeTolerance", "newton.useModifiedNewton"),
)


def _seen(exudyn: Any, kind: Kind) -> tuple[Array, Array]:
    """Angular and linear velocity in world axes of a turned node whose rates are ``GIVEN``.

    Those of an attitude are its rates where it has omega as such, else of omega ``GIVEN`` in body
    axes.
    """
    container, node_kind = exudyn.SystemContainer(), NODES[kind]
    mbs = container.AddSystem()
    attitude, rates = node_kind.given(np.array(TURNED_QUATERNION), GIVEN)
    made = getattr(exudyn.itemInterface, node_kind.name)(
        referenceCoordinates=node_kind.reference.tolist(),
        initialCoordinates=[0.0, 0.0, 0.0, *attitude],
        initialVelocities=[*GIVEN, *rates],
    )
    node = mbs.AddNode(made)
    body = exudyn.itemInterface.ObjectRigidBody(
        mass=1.0, inertia=[1.0, 1.0, 1.0, 0.0, 0.0, 0.0], nodeNumber=node
    )
    mbs.AddObject(body)
    mbs.Assemble()
    kinds, when = exudyn.OutputVariableType, exudyn.ConfigurationType.Initial
    spin = np.array(mbs.GetNodeOutput(node, kinds.AngularVelocity, when))
    return spin, np.array(mbs.GetNodeOutput(node, kinds.Velocity, when))


def conventions(exudyn: Any) -> dict[str, str]:
    """As measured, name to value."""
    angular, linear = _seen(exudyn, "rotation-vector")
    parameters, _ = _seen(exudyn, "euler-parameters")
    return {
        "rotation vector's rate": f"omega in {axes_observed(angular)}",
        "linear velocity frame": axes_observed(linear),
        "Euler parameters, order (w, x, y, z) with q' = q (0, omega) / 2": axes_observed(
            parameters
        ),
    }


def defaults(exudyn: Any) -> dict[str, str]:
    """As they come, name to value."""
    plain = exudyn.SimulationSettings()
    found = {}
    for name in SETTINGS:
        value = plain.timeIntegration
        for part in name.split("."):
            value = getattr(value, part)
        found[f"timeIntegration {name}"] = (
            described(value) if isinstance(value, bool | int | float) else str(value)
        )
    found["solution.file write"] = described(plain.solution.file.write)
    return found
