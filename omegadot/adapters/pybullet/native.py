"""Conventions and defaults of the installed PyBullet, measured on it, not read in its documents."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from omegadot.adapters.native_axes import GIVEN, TURNED_QUATERNION, axes_observed, described
from omegadot.reference_impl.system import Array

TURNING, SLOWING = 0.5, 2.0**-10  # s, steps: one that turns far, one that is short


@contextmanager
def _world(pybullet: Any) -> Iterator[int]:
    client = pybullet.connect(pybullet.DIRECT)
    try:
        yield client
    finally:
        pybullet.disconnect(client)


def _seen(pybullet: Any, maximal: int) -> tuple[Array, Array]:
    """Linear and angular velocity in world axes, from a step at velocities ``GIVEN``.

    The body is a sphere, so that omega stays what it is; its attitude tells what it was.
    """
    with _world(pybullet) as client:
        body = _sphere(pybullet, client, maximal)
        pybullet.resetBasePositionAndOrientation(body, [0.0] * 3, TURNED_QUATERNION, client)
        pybullet.resetBaseVelocity(body, GIVEN.tolist(), GIVEN.tolist(), client)
        place, before = pybullet.getBasePositionAndOrientation(body, client)
        pybullet.setTimeStep(TURNING, client)
        _undamped(pybullet, client, body)
        pybullet.stepSimulation(client)
        place, after = pybullet.getBasePositionAndOrientation(body, client)
    r1, r0 = (_matrix(q) for q in (after, before))
    turn = r1 @ r0.T
    skewed = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return np.array(place) / TURNING, skewed / (2 * np.sin(TURNING))


def _matrix(q: Any) -> Array:
    x, y, z, w = q
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix: Array = np.eye(3) + 2 * w * skew + 2 * skew @ skew
    return matrix


def _sphere(pybullet: Any, client: int, maximal: int) -> int:
    body: int = pybullet.createMultiBody(
        baseMass=1.0, useMaximalCoordinates=maximal, physicsClientId=client
    )
    pybullet.changeDynamics(
        body, -1, mass=1.0, localInertiaDiagonal=[1.0] * 3, physicsClientId=client
    )
    return body


def _undamped(pybullet: Any, client: int, body: int) -> None:
    pybullet.changeDynamics(body, -1, linearDamping=0.0, angularDamping=0.0, physicsClientId=client)


def _slowed(pybullet: Any, maximal: int) -> float:
    """1/s: the part of omega that a sphere at 1 rad/s loses in a step, by the step."""
    with _world(pybullet) as client:
        body = _sphere(pybullet, client, maximal)
        pybullet.resetBaseVelocity(body, [0.0] * 3, GIVEN.tolist(), client)
        pybullet.setTimeStep(SLOWING, client)
        pybullet.stepSimulation(client)
        spin = pybullet.getBaseVelocity(body, client)[1]
    return float(round((1.0 - spin[0]) / SLOWING, 9))


def conventions(pybullet: Any) -> dict[str, str]:
    """As measured, name to value."""
    found = {}
    for name, maximal in (("multibody", 0), ("maximal", 1)):
        linear, angular = _seen(pybullet, maximal)
        found[f"{name} linear velocity frame"] = axes_observed(linear)
        found[f"{name} angular velocity frame"] = axes_observed(angular)
    with _world(pybullet) as client:
        body = _sphere(pybullet, client, 0)
        q = pybullet.getBasePositionAndOrientation(body, client)[1]
    return found | {"quaternion order": "x, y, z, w" if q[3] == 1.0 else "w, x, y, z"}


def defaults(pybullet: Any) -> dict[str, str]:
    """As they come, name to value."""
    found = {}
    with _world(pybullet) as client:
        for name, value in sorted(pybullet.getPhysicsEngineParameters(client).items()):
            found[f"physics engine {name}"] = described(value)
    for name, maximal in (("multibody", 0), ("maximal", 1)):
        lost = described(_slowed(pybullet, maximal))
        found[f"{name} part of omega lost in 1 s at 1 rad/s, in a short step"] = lost
    return found
