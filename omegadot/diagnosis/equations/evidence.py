"""What an engine did at known states of one scenario, and how far a hypothesis is from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.equation_form import Form, accelerations, stacked
from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    body_scale,
    linear_size,
    norm,
    torque_size,
)
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

# A fitted number has rounding of its own, of about as many terms as there are components.
SLACK = 4.0
# Nothing within a few bounds has a cause: the bounds are of sound engines, and not exact.
BEYOND_ROUNDING = 16.0
DIGITS = 3  # of fitted numbers that are printed
FAR_FROM_ROUNDING = SLACK * 10.0**DIGITS  # of which what a fit leaves is less than the last digit
SCREENED = 10  # states at which every hypothesis is tried; only what fits there is tried at all
LANES = 512
# Where evidence comes from: forward dynamics at drawn states and along the trajectory, inverse
# dynamics, and these as the forward dynamics with the same torques wrong.
FORWARD, ALONG = "forward", "along the trajectory"
INVERSE, INVERTED = "inverse", "inverse, as forward"


@dataclass(frozen=True)
class Evidence:
    """Accelerations of one engine at states (n,) of a system.

    source: where they come from, "forward" for forward dynamics, "steps" for steps that vanish.
    angular_bound and linear_bound: (n,) rad/s^2 and m/s^2, what rounding may account for.
    eps: of the engine's precision.
    """

    source: str
    system: System
    states: State
    found: Acceleration
    angular_bound: Array
    linear_bound: Array
    eps: float = EPS

    @cached_property
    def true(self) -> Acceleration:
        """The right accelerations."""
        return forward_dynamics(self.system, self.states)

    @cached_property
    def solve(self) -> Array:
        """The inverse of the moving inertia, (3, 3)."""
        return inverse(moving_inertia(self.system))

    @cached_property
    def sound(self) -> NDArray[np.bool_]:
        """(n,): the states at which the engine is right."""
        return self.shares(self.true) <= 1.0

    @property
    def finite(self) -> bool:
        """Whether the engine gave numbers at every state."""
        return bool(np.isfinite(self.found.angular).all() and np.isfinite(self.found.linear).all())

    @property
    def clear(self) -> bool:
        """Whether the engine is off by more than a few times what rounding may account for."""
        return not bool(np.all(self.shares(self.true) <= BEYOND_ROUNDING))

    @property
    def far(self) -> bool:
        """Whether it is off by so much that several numbers that fit it are no chance."""
        return bool(np.quantile(self.shares(self.true), 0.75) > FAR_FROM_ROUNDING)

    def shares(self, candidate: Acceleration) -> Array:
        """(..., n): the distance of a candidate (..., n, 3) from the engine's, in bounds."""
        return self.shares_between(candidate, self.found)

    def shares_between(self, one: Acceleration, other: Acceleration) -> Array:
        """(..., n): the distance of two accelerations, in bounds."""
        angular = _share(norm(other.angular - one.angular), self.angular_bound)
        if self.linear_is_apart:
            return angular
        linear = _share(norm(other.linear - one.linear), self.linear_bound)
        return np.maximum(angular, linear)

    @cached_property
    def linear_is_apart(self) -> bool:
        """Whether a pivoted body's linear accelerations are right and its omega-dot is not.

        They follow from omega-dot on a pivot, so that the engine computes them another way: what
        is wrong shows in omega-dot alone.
        """
        if self.system.load.pivot is None:
            return False
        true = self.true
        linear = _share(norm(self.found.linear - true.linear), self.linear_bound)
        angular = _share(norm(self.found.angular - true.angular), self.angular_bound)
        return bool(np.all(linear <= 1.0) and np.any(angular > BEYOND_ROUNDING))

    def fits(self, candidate: Acceleration, slack: float | Array = SLACK) -> bool:
        """Whether a candidate is the engine's at every state."""
        angular = _share(norm(self.found.angular - candidate.angular), self.angular_bound)
        if not np.all(angular <= slack):  # most are not, and the rest need not be worked out
            return False
        return self.linear_is_apart or bool(np.all(self.shares(candidate) <= slack))

    def visible(self, candidate: Acceleration) -> bool:
        """Whether a candidate differs from the right equation beyond rounding."""
        return not bool(np.all(self.shares_between(candidate, self.true) <= SLACK))

    def fitting(self, forms: Sequence[Form | None]) -> list[int]:
        """The numbers of the forms that are the engine's at every state."""
        few = self.few(SCREENED)
        if len(few.angular_bound) == 0:
            return []
        known = [k for k, form in enumerate(forms) if form is not None]
        kept: list[int] = []
        for begin in range(0, len(known), LANES):
            lanes = known[begin : begin + LANES]
            tried = accelerations(stacked([f for k in lanes if (f := forms[k])]), few.states)
            close = np.max(few.shares(tried), axis=-1)
            kept += [
                k
                for k, off in zip(lanes, close, strict=True)
                if off <= SLACK
                or (off <= self._decisive and (f := forms[k]) and off <= self.slack_of(f))
            ]
        return [k for k in kept if (f := forms[k]) and self.is_of(f)]

    def is_of(self, form: Form) -> bool:
        """Whether a form is the engine's equation at every state."""
        made = accelerations(form, self.states)
        return self.fits(made) or (self._decisive > SLACK and self.fits(made, self.slack_of(form)))

    def slack_of(self, form: Form) -> float:
        """In bounds: an inertia of a larger condition than the right one rounds more."""
        right = np.linalg.cond(np.asarray(moving_inertia(self.system), dtype=float))
        more = float(np.linalg.cond(form.solve) / right) if np.all(np.isfinite(form.solve)) else 1.0
        return float(np.clip(SLACK * more, SLACK, max(SLACK, self._decisive)))

    @cached_property
    def _decisive(self) -> float:
        """In bounds, within which a fit has three digits of all that the engine is off by."""
        return float(np.quantile(self.shares(self.true), 0.25)) / 10.0**DIGITS

    def few(self, count: int) -> Evidence:
        """The evidence of so many states, spread over all."""
        places = np.linspace(0, len(self.angular_bound) - 1, count).round().astype(int)
        return self.at(np.unique(places))

    def at(self, places: NDArray[np.intp]) -> Evidence:
        """The evidence of these states alone."""
        found = Acceleration(self.found.angular[places], self.found.linear[places])
        bounds = (self.angular_bound[places], self.linear_bound[places])
        part = Evidence(self.source, self.system, self.states[places], found, *bounds, self.eps)
        if self.source == INVERSE:
            true = self.true
            vars(part)["true"] = Acceleration(true.angular[places], true.linear[places])
        return part

    def weighted(self, one: Acceleration, other: Acceleration) -> Array:
        """All components of a difference in one row, each state's in parts of its bound."""
        angular = (one.angular - other.angular) / self.angular_bound[:, None]
        linear = (one.linear - other.linear) / self.linear_bound[:, None]
        row = np.concatenate([np.ravel(angular), np.ravel(linear)])
        return np.where(np.isfinite(row), row, 0.0)


def _share(apart: Array, bound: Array) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):
        share: Array = apart / bound
    share[apart == 0.0] = 0.0
    share[np.isnan(share)] = np.inf
    return share


def of_forward_dynamics(
    system: System, states: State, found: Acceleration, eps: float = EPS
) -> Evidence:
    """Forward dynamics at states, within the equation gate's bounds."""
    true, smallest = forward_dynamics(system, states), body_scale(system).smallest
    sizes = [torque_size(system, states, one) for one in (true, _finite(found, true))]
    linear = [linear_size(system, states, one, eps) for one in (true, _finite(found, true))]
    bound = ROUNDINGS_PER_EVALUATION * eps
    bounds = (bound * np.maximum(*sizes) / smallest, bound * np.maximum(*linear))
    return Evidence(FORWARD, system, states, found, *bounds, eps)


def of_inverse_dynamics(
    system: System, states: State, requested: Acceleration, torque: Array, eps: float = EPS
) -> Evidence:
    """Inverse dynamics as the omega-dot that a wrong torque would make, next to the requested one.

    omega-dot of this evidence is the requested one.
    """
    off = torque - inverse_dynamics(system, states, requested)
    angular = requested.angular + apply(inverse(moving_inertia(system)), off)
    linear = requested.linear
    if system.load.pivot is not None:
        linear = center_of_mass_acceleration(system, states, angular)
    bound = ROUNDINGS_PER_EVALUATION * eps * torque_size(system, states, requested)
    bounds = (bound / body_scale(system).smallest, np.full(len(bound), np.inf))
    made = Evidence(INVERSE, system, states, Acceleration(angular, linear), *bounds, eps)
    vars(made)["true"] = requested
    return made


def inverted(
    system: System, states: State, requested: Acceleration, torque: Array, eps: float = EPS
) -> Evidence:
    """Inverse dynamics as forward dynamics in which the same term of the torque is wrong.

    ``I omega_dot = tau + d`` there is ``tau = I omega_dot - d`` here.
    """
    known = of_inverse_dynamics(system, states, requested, torque, eps)
    true = forward_dynamics(system, states)
    angular = true.angular - (known.found.angular - requested.angular)
    linear = true.linear
    if system.load.pivot is not None:
        linear = center_of_mass_acceleration(system, states, angular)
    bound = ROUNDINGS_PER_EVALUATION * eps * torque_size(system, states, true)
    bound = known.angular_bound + bound / body_scale(system).smallest
    found = Acceleration(angular, linear)
    return Evidence(INVERTED, system, states, found, bound, known.linear_bound, eps)


def _finite(found: Acceleration, true: Acceleration) -> Acceleration:
    """An engine's own terms may be larger than the right ones, and then round more."""
    pairs = zip(vars(found).values(), vars(true).values(), strict=True)
    return Acceleration(*(np.where(np.isfinite(one), one, two) for one, two in pairs))
