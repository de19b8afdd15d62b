"""The PyBullet body of one system, in a world of its own.

A free body is a base. A pivoted one is a link on a spherical joint to a base that is fixed at the
world's origin. PyBullet keeps a body in the frame of its inertia: the origin is the centre of mass,
the axes are the principal ones.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.body_files import origin_at_pivot
from omegadot.adapters.mujoco.model import principal_frame
from omegadot.adapters.protocol import Setup, UnsupportedError, mends
from omegadot.adapters.pybullet.integrators import Kind
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, Body, Load, System

BASE = -1  # the number that PyBullet gives it
FASTEST = 1e300  # rad/s and m/s
NO_TURN = (0.0, 0.0, 0.0, 1.0)
SWITCHED_OFF = (
    "linearDamping and angularDamping of 0.04 of multibodies",
    "maxJointVelocity of 100, to which each component of omega and velocity is cut, in rad/s and "
    "m/s",
    "the motor of a spherical joint, which stops it",
    "the axes of a link in LINK_FRAME, which are those of a step before: a torque in body axes is "
    "one of the spherical joint (TORQUE_CONTROL)",
    "the inertia in world axes of the attitude before, with which a body in maximal coordinates "
    "begins: a step at rest is taken first",
    "the cut of a turn to 45 degrees in a step: the adapter refuses to go on there",
)
SETTINGS = ("linearDamping", "angularDamping", "maxJointVelocity")


class PyBulletModel:
    """body, link: PyBullet's numbers of the body in the world of a client.

    frame: the quaternion of the principal axes in body axes.  Raises UnsupportedError for what
    PyBullet has not.
    """

    def __init__(self, engine: Any, client: int, system: System, kind: Kind, setup: Setup) -> None:
        _refuse(system.load)
        self._engine, self.client, self.system = engine, client, system
        self.kind, self.free, self.strict = kind, system.load.pivot is None, setup == "physics"
        inertia = np.array(system.body.inertia, float)
        self.moments, self.frame = principal_frame(0.5 * (inertia + inertia.T))
        self._origin = origin_at_pivot(system)
        self._center = (np.array(system.body.center_of_mass, float) - self._origin).tolist()
        engine.resetSimulation(physicsClientId=client)
        self.link = BASE if self.free else 0
        self.body: int = self._base() if self.free else self._on_a_joint()
        engine.changeDynamics(
            self.body,
            self.link,
            # both at once, as the moments alone take the mass away in maximal coordinates
            mass=float(system.body.mass),
            localInertiaDiagonal=self.moments.tolist(),
            jointDamping=float(system.load.damping),
            physicsClientId=client,
        )
        self._mend(setup)

    def _base(self) -> int:
        made: int = self._engine.createMultiBody(
            baseMass=float(self.system.body.mass),
            baseInertialFramePosition=self._center,
            baseInertialFrameOrientation=ordered(self.frame),
            useMaximalCoordinates=int(self.kind == "maximal"),
            physicsClientId=self.client,
        )
        return made

    def _on_a_joint(self) -> int:
        made: int = self._engine.createMultiBody(
            baseMass=0.0,
            linkMasses=[float(self.system.body.mass)],
            linkCollisionShapeIndices=[-1],
            linkVisualShapeIndices=[-1],
            linkPositions=[[0.0, 0.0, 0.0]],
            linkOrientations=[NO_TURN],
            linkInertialFramePositions=[self._center],
            linkInertialFrameOrientations=[ordered(self.frame)],
            linkParentIndices=[0],
            linkJointTypes=[self._engine.JOINT_SPHERICAL],
            linkJointAxis=[[0.0, 0.0, 1.0]],
            physicsClientId=self.client,
        )
        return made

    def _mend(self, setup: Setup) -> None:
        engine, client = self._engine, self.client
        values = dict(zip(SETTINGS, (0.0, 0.0, FASTEST), strict=True))
        mended = {name: value for name, value in values.items() if mends(setup, name)}
        if self.strict:
            mended["activationState"] = engine.ACTIVATION_STATE_DISABLE_SLEEPING
        engine.changeDynamics(self.body, BASE, **mended, physicsClientId=client)
        if self.strict and not self.free:
            engine.setJointMotorControlMultiDof(
                self.body,
                self.link,
                engine.POSITION_CONTROL,
                targetPosition=NO_TURN,
                positionGain=0.0,
                velocityGain=0.0,
                force=[0.0, 0.0, 0.0],
                physicsClientId=client,
            )

    def read_back(self) -> Body:
        """Mass, centre of mass and inertia about it, of `getDynamicsInfo`."""
        found = self._engine.getDynamicsInfo(self.body, self.link, self.client)
        mass, moments, center, (x, y, z, w) = found[0], found[2], found[3], found[4]
        axes = rotation_matrix(np.array([w, x, y, z]))
        return Body(np.array(mass), center + self._origin, axes @ np.diag(moments) @ axes.T)


def ordered(q: Array) -> list[float]:
    """A quaternion (w, x, y, z) in PyBullet's order, (x, y, z, w)."""
    w, x, y, z = q.tolist()
    return [x, y, z, w]


def _refuse(load: Load) -> None:
    if load.damping and load.pivot is None:
        raise UnsupportedError(
            "PyBullet's angularDamping goes with omega and the moments of inertia, and with omega "
            "squared; a free body has no torque that goes with its omega alone"
        )
