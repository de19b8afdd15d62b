"""The Exudyn system of one body: its node, its loads, and what holds its pivot.

The node is at the body's origin, or at the pivot. A pivot is three `ObjectConnectorCoordinate`,
each of which holds one coordinate of the node's place at zero. With an `ObjectJointSpherical` away
from the node, accelerations at the start are wrong: Exudyn takes the constraint's second derivative
from a difference quotient in the rotation vector along omega, which is not the vector's rate.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from omegadot.adapters.exudyn.axes import Axes
from omegadot.adapters.exudyn.nodes import NODES, Kind
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, Body, System

# Exudyn's order of an inertia's six numbers.
ROWS, COLUMNS = [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]


class ExudynModel:
    """mbs, node and body are Exudyn's system and the indices of its items.

    axes: of the node, and of the body in Exudyn.  driven: whether damping and applied torques act.
    stepped: whether it is for steps; if not, its accelerations alone are taken.
    Coordinates are those of `nodes`.
    """

    def __init__(
        self,
        exudyn: Any,
        system: System,
        kind: Kind,
        axes: Axes,
        driven: bool = True,
        stepped: bool = True,
    ) -> None:
        self._items: Any = exudyn.itemInterface
        self.kinds: Any = exudyn.OutputVariableType
        self.system, self.axes, self.node_kind = system, axes, NODES[kind]
        pivot = system.load.pivot
        self.origin = np.zeros(3) if pivot is None else np.array(pivot, float)
        self.center = np.array(system.body.center_of_mass, float) - self.origin
        self._container = exudyn.SystemContainer()  # the system lives as long as this does
        self.mbs: Any = self._container.AddSystem()
        self.node = self._node()
        self.body = self._body()
        self._loads(driven)
        if pivot is not None:
            self._held(1.0 if stepped else self._constraint_factor())
        self._sensors = [self._sensor(kind) for kind in ("Coordinates", "Coordinates_t")]
        self.mbs.Assemble()

    def _node(self) -> Any:
        node = getattr(self._items, self.node_kind.name)
        return self.mbs.AddNode(node(referenceCoordinates=self.node_kind.reference.tolist()))

    def _body(self) -> Any:
        body = self.system.body
        about = np.array(body.inertia, float) + parallel_axis(body.mass, self.center)
        about = self.axes.tensor_in_node(about)
        made = self._items.ObjectRigidBody(
            mass=float(body.mass),
            inertia=about[ROWS, COLUMNS].tolist(),
            centerOfMass=self.axes.in_node(self.center).tolist(),
            nodeNumber=self.node,
        )
        return self.mbs.AddObject(made)

    def _loads(self, driven: bool) -> None:
        load, items, mbs = self.system.load, self._items, self.mbs
        if np.any(load.gravity):
            marker = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=self.body))
            gravity = np.array(load.gravity, float).tolist()
            mbs.AddLoad(items.LoadMassProportional(markerNumber=marker, loadVector=gravity))
        torques = ((load.torque_body, True), (load.torque_world, False))
        for torque, fixed in torques if driven else ():
            if np.any(torque):
                acting = np.array(torque, float)
                acting = self.axes.in_node(acting) if fixed else acting
                given = {"loadVector": acting.tolist(), "bodyFixed": fixed}
                mbs.AddLoad(items.LoadTorqueVector(markerNumber=self._at(self.body), **given))
        if driven and load.damping:
            ground = mbs.AddObject(items.ObjectGround())
            against = np.diag([0.0, 0.0, 0.0, *np.full(3, float(load.damping))])
            ends = [self._at(ground), self._at(self.body)]
            damper = items.ObjectConnectorRigidBodySpringDamper
            mbs.AddObject(damper(markerNumbers=ends, damping=against))

    def _at(self, body: Any) -> Any:
        """A marker at the origin of a body."""
        return self.mbs.AddMarker(self._items.MarkerBodyRigid(bodyNumber=body))

    def _held(self, factor: float) -> None:
        mbs, items = self.mbs, self._items
        marker: Callable[..., Any] = items.MarkerNodeCoordinate
        fixed = mbs.AddMarker(marker(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0))
        for axis in range(3):
            ends = [fixed, mbs.AddMarker(marker(nodeNumber=self.node, coordinate=axis))]
            held = items.ObjectConnectorCoordinate
            mbs.AddObject(held(markerNumbers=ends, factorValue1=factor))

    def _constraint_factor(self) -> float:
        """By what the pivot's equations ``x = 0`` are multiplied: a power of 2, nothing is rounded.

        They are then larger than the body's own equations, m and m |c| in the columns of x, so that
        a solver which chooses its pivots by size begins with them, and solves omega-dot apart. The
        tolerance of steps is about these equations as they are.
        """
        size = float(self.system.body.mass) * max(1.0, float(np.linalg.norm(self.center)))
        return 2.0 ** math.ceil(math.log2(size) + 1)

    def _sensor(self, kind: str) -> Any:
        """What logs the node's coordinates, or their rates, in native code."""
        logged = getattr(self.kinds, kind)
        sensor = self._items.SensorNode(
            nodeNumber=self.node, storeInternal=True, outputVariableType=logged
        )
        return self.mbs.AddSensor(sensor)

    def logged(self) -> tuple[Array, Array]:
        """Times (n,) in s, and coordinates with their rates (n, 2 k), of the run before."""
        places, rates = (np.array(self.mbs.GetSensorStoredData(own)) for own in self._sensors)
        return places[:, 0], np.hstack((places[:, 1:], rates[:, 1:]))

    def read_back(self) -> Body:
        """Mass, centre of mass and inertia about it, as the body has them."""
        held = self.mbs.GetObject(self.body)
        mass = float(held["mass"])
        center = self.axes.in_body(np.array(held["centerOfMass"], float))
        inertia = np.empty((3, 3))
        inertia[ROWS, COLUMNS] = inertia[COLUMNS, ROWS] = held["inertia"]
        about_center = self.axes.tensor_in_body(inertia) - parallel_axis(mass, center)
        return Body(np.array(mass), center + self.origin, about_center)
