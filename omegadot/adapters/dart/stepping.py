"""The loads of a DART body as external torques, and its steps, logged in the joint's coordinates.

A step costs what `World.step` costs in a loop of one's own: a torque that is constant in body axes
is set once, for a step without a reset keeps it; samples become states after the run.
"""

from collections.abc import Callable
from functools import partial
from itertools import repeat
from typing import Any

import numpy as np

from omegadot.adapters.dart.model import DartModel
from omegadot.reference_impl.system import Array, Load

LOOKED_AT = 64  # samples between two looks at whether a run is still finite
ROOT_OF_LARGEST = 2.0**512  # the least number whose square is not finite


class DartStepper:
    """Steps the world of a `DartModel` under a load."""

    def __init__(self, model: DartModel, load: Load) -> None:
        self._model = model
        self.push = _torques(model.node, load)
        self._constant = not (load.damping or np.any(load.torque_world))

    def run(self, counts: list[int]) -> list[Array]:
        """Positions and velocities, in turns, before the first and after each count of steps.

        A run that is no longer finite is soon not stepped on: its later samples are missing.
        """
        positions, velocities = self._model.joint.getPositions, self._model.joint.getVelocities
        step, push = self._model.world.step, self.push
        logged = [positions(), velocities()]
        log, constant = logged.append, self._constant
        push()
        for first in range(0, len(counts), LOOKED_AT):
            for count in counts[first : first + LOOKED_AT]:
                if constant and count == 1:  # a loop of one would cost a tenth of a step
                    step(False)
                elif constant:
                    for _ in repeat(None, count):
                        step(False)
                else:
                    for _ in repeat(None, count):
                        push()
                        step(False)
                log(positions())
                log(velocities())
            if not are_finite(*logged[-2:]):
                break
        self._model.skeleton.clearExternalForces()
        return logged


def _torques(node: Any, load: Load) -> Callable[[], None]:
    """A call that sets damping and applied torques at the present state as external torques."""
    velocity, put, add = node.getCOMSpatialVelocity, node.setExtTorque, node.addExtTorque
    against = np.full(3, -float(load.damping))
    body, world = np.array(load.torque_body, float), np.array(load.torque_world, float)
    damped, driven, in_world = bool(against.any()), bool(body.any()), bool(world.any())

    def damp() -> None:
        torque = against * velocity()[:3]
        put(body + torque if driven else torque, True)
        if in_world:
            add(world, False)

    def drive() -> None:
        put(body, True)
        add(world, False)

    if damped:
        return damp
    if in_world and driven:
        return drive
    return partial(put, world, False) if in_world else partial(put, body, True)


def are_finite(positions: Array, velocities: Array) -> Any:
    """Whether positions and the squares of velocities, (..., dofs), are finite: (...)."""
    slow = np.abs(velocities).max(axis=-1) < ROOT_OF_LARGEST
    return slow & np.isfinite(positions).all(axis=-1)
