"""Conventions and defaults of the installed Basilisk, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.basilisk.attitude import of_quaternion
from omegadot.adapters.native_axes import GIVEN, TURNED_QUATERNION, axes_observed, described

ADAPTIVE = ("svIntegratorRKF45", "svIntegratorRKF78")
SETTINGS = (
    *("relTol", "absTol", "safetyFactorForNextStepSize"),
    *("maximumFactorIncreaseForNextStepSize", "minimumFactorDecreaseForNextStepSize"),
)


def _turned(basilisk: Any) -> Any:
    """A turned hub of unit inertia whose omega and velocity are ``GIVEN``."""
    craft = basilisk.Spacecraft()
    craft.hub.sigma_BNInit = of_quaternion(np.array(TURNED_QUATERNION)).tolist()
    craft.hub.omega_BN_BInit = craft.hub.v_CN_NInit = GIVEN.tolist()
    craft.Reset(0)
    return craft


def conventions(basilisk: Any) -> dict[str, str]:
    """As measured, name to value. With unit inertia the angular momentum is omega."""
    craft = _turned(basilisk)
    craft.computeEnergyMomentum(0.0)
    seen = np.array(craft.totRotAngMomPntC_N).ravel()
    moved = np.array(craft.dynManager.getStateObject("hubPosition").getStateDeriv()).ravel()
    return {
        "omega frame, sigma world-from-body": axes_observed(seen),
        "linear velocity frame": axes_observed(moved),
    }


def defaults(basilisk: Any) -> dict[str, str]:
    """As they come, name to value."""
    craft, found = basilisk.Spacecraft(), {}
    for kind in ADAPTIVE:
        own = getattr(basilisk, kind)(craft)
        for name in SETTINGS:
            found[f"{kind} {name}"] = described(getattr(own, name))
    hub = craft.hub
    found["hub mHub"] = described(hub.mHub)
    found["hub IHubPntBc_B"] = described(np.array(hub.IHubPntBc_B))
    return found
