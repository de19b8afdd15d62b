"""The Drake plant of one body: its joint and its loads.

A free body is on a `QuaternionFloatingJoint` at its origin, a pivoted one on a `BallRpyJoint` at
the pivot. Drake has no ball joint without Euler angles.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any, Literal

import numpy as np

from omegadot.adapters.body_files import NAME, mjcf_of, origin_at_pivot, urdf_of
from omegadot.adapters.protocol import Format, UnsupportedError
from omegadot.reference_impl.system import Body, System

SWITCHED_OFF = (
    "collision: bodies have no shapes, and no SceneGraph is there",
    "the accuracy of 1e-3 or so to which fixed implicit steps are solved: 1e-12, or 1e-8 of "
    "velocity_implicit_euler",
)
SETTINGS = ("set_target_accuracy",)


@dataclass(frozen=True)
class Stepping:
    """What a plant is built for.

    timestep: s, of a discrete plant; 0 for a continuous one.  approximation: the discrete plant's
    contact approximation, "" for Drake's own choice.
    """

    timestep: float = 0.0
    approximation: str = ""


class DrakeModel:
    """plant, joint and node (the body) are Drake's objects.

    root: what a simulator steps: the plant alone, which costs less than a diagram does, or the
    diagram of it and of the propeller that drives it.

    Raises UnsupportedError where Drake refuses a file of the body, or its inertia.
    """

    def __init__(
        self,
        drake: ModuleType,
        system: System,
        via: Format | Literal[""] = "",
        stepping: Stepping | None = None,
    ) -> None:
        stepping = stepping or Stepping()
        self._drake: Any = drake
        self.system, self.free = system, system.load.pivot is None
        self._origin = origin_at_pivot(system)
        self.plant: Any = drake.MultibodyPlant(stepping.timestep)
        if stepping.approximation:
            known = drake.DiscreteContactApproximation.__members__
            self.plant.set_discrete_contact_approximation(known[stepping.approximation])
        self.node = self._read(via) if via else self._made()
        self.joint: Any = self._joint()
        gravity = np.array(system.load.gravity, float)
        self.plant.mutable_gravity_field().set_gravity_vector(gravity)
        self.plant.Finalize()
        self._size = float(np.linalg.norm(system.load.torque_body))
        self.root: Any = self._driven() if self._size else self.plant

    def _made(self) -> Any:
        """The body by Drake's API. Its inertia is per unit of mass, about the body's origin."""
        drake, body = self._drake, self.system.body
        inertia = np.array(body.inertia, float)
        moments, products = np.diagonal(inertia), inertia[[0, 0, 1], [1, 2, 2]]
        center = np.array(body.center_of_mass, float) - self._origin
        about_center = drake.RotationalInertia(*moments, *products)
        made = drake.SpatialInertia.MakeFromCentralInertia(float(body.mass), center, about_center)
        return self.plant.AddRigidBody(NAME, made)

    def _read(self, via: str) -> Any:
        """The body by Drake's parser. The link of a URDF has no joint; its frame is the joint's."""
        if via == "mjcf":
            text, kind, self._origin = mjcf_of(self.system), "xml", np.zeros(3)
        else:
            text, kind = urdf_of(self.system, self._origin), via
        try:
            self._drake.Parser(self.plant).AddModelsFromString(text, kind)
        except RuntimeError as error:
            reason = " ".join(str(error).split())
            raise UnsupportedError(f"Drake refuses the {via} of this body: {reason}") from error
        return self.plant.GetBodyByName(NAME)

    def _joint(self) -> Any:
        """The joint that the parser has made, of a ball joint in an MJCF, or one of our own."""
        if made := self.plant.GetJointIndices(self.node.model_instance()):
            return self.plant.get_joint(made[0])
        kind = self._drake.QuaternionFloatingJoint if self.free else self._drake.BallRpyJoint
        ends = (self.plant.world_frame(), self.node.body_frame())
        return self.plant.AddJoint(kind("joint", *ends))

    def _driven(self) -> Any:
        """With a propeller without thrust: its torque is along its z-axis, fixed in the body."""
        drake, builder = self._drake, self._drake.DiagramBuilder()
        along = np.array(self.system.load.torque_body, float) / self._size
        turned = drake.RotationMatrix.MakeFromOneVector(along, 2)
        pose, index = drake.RigidTransform(turned, np.zeros(3)), self.node.index()
        blades = drake.Propeller(index, pose, thrust_ratio=0.0, moment_ratio=1.0)
        plant, self._blades = builder.AddSystem(self.plant), builder.AddSystem(blades)
        poses, forces = plant.get_body_poses_output_port(), blades.get_spatial_forces_output_port()
        builder.Connect(poses, blades.get_body_poses_input_port())
        builder.Connect(forces, plant.get_applied_spatial_force_input_port())
        return builder.Build()

    def context(self) -> tuple[Any, Any]:
        """A new context of the root with the loads set, and the plant's part of it."""
        load, root = self.system.load, self.root.CreateDefaultContext()
        own = self.plant.GetMyContextFromRoot(root)
        damping = np.zeros(self.plant.num_velocities())
        damping[:3] = load.damping  # velocities are (angular, linear), angular ones in world axes
        self.joint.SetDampingVector(own, damping)
        couple = np.zeros(len(damping))
        couple[:3] = load.torque_world
        if couple.any():
            self.plant.get_applied_generalized_force_input_port().FixValue(own, couple)
        if self._size:
            blades = self._blades.GetMyContextFromRoot(root)
            self._blades.get_command_input_port().FixValue(blades, [self._size])
        return root, own

    def body(self, own: Any) -> Body:
        """Mass, centre of mass and inertia about it, as the body has them in a plant's context."""
        held = self.node.CalcSpatialInertiaInBodyFrame(own)
        mass, center = held.get_mass(), held.get_com()
        about_center = held.Shift(center).CalcRotationalInertia().CopyToFullMatrix3()
        return Body(np.array(mass), center + self._origin, about_center)
