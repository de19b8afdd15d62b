"""Wrong equations that are the right one and a few terms more, each with a factor that is fitted.

``found = true + sum of p_k phi_k(state)``: linear in the factors, so that one solve finds them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.system import Acceleration, Array, State, System

AXES = "xyz"
NOTHING = 1e-6  # of the largest factor
EVEN = 1e-3  # relative: factors that are one

Basis = Callable[[System, State, Acceleration], Array]


@dataclass(frozen=True)
class Terms:
    """Terms of one kind.

    basis: (k, n, 3) at states (n,), rad/s^2 in body axes, or m/s^2 in world axes where `linear`.
    text: the cause, with the factors (k,).  reported: what comes out is another than what moves
    the body; the centre of mass of a pivoted body does not follow.  stepped: of what steps do
    alone.  by_rows: the components of one vector are scaled, each by its own factor.
    """

    name: str
    basis: Basis
    text: Callable[[System, Array], str]
    linear: bool = False
    reported: bool = False
    stepped: bool = False
    by_rows: bool = False

    def made(self, evidence: Evidence, p: Array) -> Acceleration:
        """The accelerations with these factors."""
        true, system, states = evidence.true, evidence.system, evidence.states
        more = np.tensordot(p, self.basis(system, states, true), 1)
        if self.linear:
            return Acceleration(true.angular, true.linear + more)
        angular = true.angular + more
        if system.load.pivot is None or self.reported:
            return Acceleration(angular, true.linear)
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))

    def fit(self, evidence: Evidence) -> Array | None:
        """The factors with which this is the engine's equation; None where none are."""
        basis = self.basis(evidence.system, evidence.states, evidence.true)
        kind = "linear" if self.linear else "angular"
        bound = evidence.linear_bound if self.linear else evidence.angular_bound
        rest = getattr(evidence.found, kind) - getattr(evidence.true, kind)
        weight = np.where(np.isfinite(bound) & (bound > 0.0), 1.0 / bound, 0.0)[:, None]
        lines = np.stack([np.ravel(one * weight) for one in basis], axis=-1)
        sizes = norm(lines.T)
        used = sizes > 0.0
        target = np.ravel(rest * weight)
        if not used.any() or not (np.isfinite(lines).all() and np.isfinite(target).all()):
            return None
        found = np.zeros(len(basis))
        scaled, *_ = np.linalg.lstsq(lines[:, used] / sizes[used], target, rcond=None)
        found[used] = scaled / sizes[used]
        seen = np.abs(scaled) > NOTHING * np.max(np.abs(scaled))
        found[np.flatnonzero(used)[~seen]] = 0.0
        even = len(found) > 1 and np.ptp(found) <= EVEN * float(np.max(np.abs(found)))
        if even and self.by_rows:
            return None  # a whole vector is scaled, which is another cause
        if not np.any(found) or not evidence.fits(self.made(evidence, found)):
            return None
        return found
