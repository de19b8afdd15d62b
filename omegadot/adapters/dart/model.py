"""The DART world of one body: a FreeJoint at the body origin, or a BallJoint at the pivot."""

from __future__ import annotations

from types import ModuleType
from typing import Any, Literal

import numpy as np

from omegadot.adapters.body_files import urdf_of
from omegadot.adapters.protocol import Format, Setup, UnsupportedError, mends
from omegadot.reference_impl.system import Array, System

SWITCHED_OFF = (
    "deactivation of slow bodies (World.setDeactivationOptions, where the version has it)",
    "enforcement of joint limits (Joint.setLimitEnforcement)",
    "collision: bodies have no shapes",
    "the alignment of joint frames with the world: they are turned by 120 degrees about (1, 1, 1), "
    "so that attitudes near the identity are not rotation vectors below 1e-3 rad, which DART "
    "expands to second order",
)
SETTINGS = ("setDeactivationOptions", "setTransformFromParentBodyNode")
# math::expMapRot takes 1 + [r] + [r]^2/2 for |r| < 1e-3, off by |r|^3/6. A permutation of the axes
# turns without rounding.
TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def _read(dart: Any, system: System) -> Any:
    """The skeleton that DART reads from a URDF of the body, its frame at the body's origin."""
    reader = dart.utils.DartLoader()
    found = reader.parseSkeletonString(urdf_of(system, np.zeros(3)), dart.common.Uri(""))
    if found is None:
        raise UnsupportedError("DART refuses the URDF of this body.")
    return found


class DartModel:
    """world, skeleton, joint and node are DART's objects; frame is DART's world frame.

    isometry: DART's, of a (3, 3) rotation and a (3,) translation.
    turn: (3, 3), the attitude of the joint's frame in the world.
    """

    def __init__(
        self,
        engine: ModuleType,
        system: System,
        via: Format | Literal[""] = "",
        *,
        setup: Setup,
    ) -> None:
        dynamics: Any = engine.dynamics
        self.isometry: Any = engine.math.Isometry3
        self.world: Any = engine.simulation.World()
        self.world.setGravity(np.array(system.load.gravity, float))
        self.frame: Any = dynamics.Frame.World()
        self.skeleton, self.joint, self.node = self._made(engine, system, via)
        self.world.addSkeleton(self.skeleton)
        self.turn: Array = np.eye(3)
        self._mend(setup)

    def _made(
        self, engine: ModuleType, system: System, via: Format | Literal[""]
    ) -> tuple[Any, Any, Any]:
        """Skeleton, joint and body node. A URDF has no ball joint: what was read gives it its body.

        Raises UnsupportedError where DART refuses the file.
        """
        pivot, read = system.load.pivot, _read(engine, system) if via else None
        if read is not None and pivot is None:
            return read, read.getJoint(0), read.getBodyNode(0)
        skeleton = engine.dynamics.Skeleton()
        if pivot is None:
            joint, node = skeleton.createFreeJointAndBodyNodePair()
        else:
            joint, node = skeleton.createBallJointAndBodyNodePair()
            joint.setTransformFromChildBodyNode(self.isometry(np.eye(3), np.array(pivot, float)))
        if read is not None:
            node.setInertia(read.getBodyNode(0).getInertia())
        else:
            body = system.body
            center, inertia = np.array(body.center_of_mass, float), np.array(body.inertia, float)
            node.setInertia(engine.dynamics.Inertia(float(body.mass), center, inertia))
        return skeleton, joint, node

    def _mend(self, setup: Setup) -> None:
        """What ``SWITCHED_OFF`` lists; old versions lack some of it."""
        sleeps = hasattr(self.world, "setDeactivationOptions")
        if sleeps and mends(setup, "setDeactivationOptions"):
            options = self.world.getDeactivationOptions()
            options.mEnabled = False
            self.world.setDeactivationOptions(options)
        if setup == "physics":
            self.joint.setLimitEnforcement(False)
        if mends(setup, "setTransformFromParentBodyNode"):
            self.turn = TURN
            self.joint.setTransformFromParentBodyNode(self.isometry(TURN, np.zeros(3)))
