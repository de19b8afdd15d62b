"""The Basilisk spacecraft of one body: its hub and its loads.

The hub's point B is the body's origin. Gravity is that of a point mass `FAR` away, whose field is
uniform to rounding: Basilisk has no uniform field, and a force by `ExtForceTorque` acts at B, where
it turns a body whose centre of mass is elsewhere.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.protocol import UnsupportedError
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, Body, Load, System

# m. A spacecraft within 2e9 m of the world's origin is at one place, as seen from there.
FAR = 2.0**84
DEFAULT = "svIntegratorRK4"


class BasiliskModel:
    """craft: Basilisk's `Spacecraft`.

    integrator: the class of its integrator.  relative, absolute: the tolerances of one that is
    error-controlled, None for Basilisk's own.
    Raises UnsupportedError for what a spacecraft has not.
    """

    def __init__(
        self,
        basilisk: Any,
        system: System,
        integrator: str = DEFAULT,
        relative: float | None = None,
        absolute: float | None = None,
    ) -> None:
        _refuse(system.load)
        self.system, self._basilisk = system, basilisk
        self.center = np.array(system.body.center_of_mass, float)
        self.craft: Any = basilisk.Spacecraft()
        self.craft.ModelTag = "body"
        hub = self.craft.hub
        hub.mHub, hub.r_BcB_B = float(system.body.mass), self.center.tolist()
        inertia = np.array(system.body.inertia, float)
        hub.IHubPntBc_B = (0.5 * (inertia + inertia.T)).tolist()  # it refuses what rounding leaves
        # Basilisk holds them by bare pointers, so that they live as long as this does.
        self._held = [self._planet(), self._torque()]
        if integrator != DEFAULT:
            own = getattr(basilisk, integrator)(self.craft)
            if relative is not None:
                own.setRelativeTolerance(relative)
            if absolute is not None:
                own.setAbsoluteTolerance(absolute)
            self.craft.setIntegrator(own)
            self._held.append(own)

    def _planet(self) -> Any:
        gravity = np.array(self.system.load.gravity, float)
        size = float(np.linalg.norm(gravity))
        if not size:
            return None
        at = self._basilisk.SpicePlanetStateMsgPayload()
        at.PositionVector = (FAR * (gravity / size)).tolist()
        at.J20002Pfix = np.eye(3).tolist()
        message = self._basilisk.SpicePlanetStateMsg().write(at)
        planet = self._basilisk.GravBodyData()
        planet.planetName, planet.mu = "far", size * FAR * FAR
        planet.planetBodyInMsg.subscribeTo(message)
        self.craft.gravField.gravBodies = self._basilisk.GravBodyVector([planet])
        return planet, message

    def _torque(self) -> Any:
        torque = np.array(self.system.load.torque_body, float)
        if not np.any(torque):
            return None
        acting = self._basilisk.ExtForceTorque()
        acting.extTorquePntB_B = torque.tolist()
        self.craft.addDynamicEffector(acting)
        return acting

    def begin(self, sigma: Array, omega: Array, position: Array, velocity: Array) -> None:
        """The state at the next Reset: position and velocity of the centre of mass."""
        hub = self.craft.hub
        hub.sigma_BNInit, hub.omega_BN_BInit = sigma.tolist(), omega.tolist()
        hub.r_CN_NInit, hub.v_CN_NInit = position.tolist(), velocity.tolist()

    def reset(self) -> None:
        """Put it in that state at time 0, and let it know where the far mass is.

        Raises UnsupportedError where Basilisk refuses the body.
        """
        try:
            self.craft.Reset(0)
        except self._basilisk.Refusal as error:
            raise UnsupportedError(f"Basilisk refuses this body: {error}") from error
        self.craft.gravField.UpdateState(0)

    def read_back(self) -> Body:
        """Mass, centre of mass and inertia about it, of the spacecraft's message of them."""
        held = self.craft.scMassOutMsg.read()
        mass, center = float(held.massSC), np.array(held.c_B, float)
        about_origin = np.array(held.ISC_PntB_B, float)
        return Body(np.array(mass), center, about_origin - parallel_axis(mass, center))


def _refuse(load: Load) -> None:
    if load.pivot is not None:
        raise UnsupportedError("Basilisk's spacecraft is a free body: nothing holds a point of it")
    if load.damping:
        raise UnsupportedError("Basilisk's spacecraft has no torque that goes with its omega")
    if np.any(load.torque_world):
        raise UnsupportedError(
            "Basilisk's ExtForceTorque has torques in body axes alone, and none in world axes"
        )
