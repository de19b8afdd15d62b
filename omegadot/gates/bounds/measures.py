"""How far two motions are apart, channel by channel, and how far rounding alone may take them."""

from __future__ import annotations

from copy import copy

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.bounds.roundings import PLAIN, Roundings
from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_STEP,
    BodyScale,
    angular_size,
    between_ellipsoids,
    body_scale,
    momentum_of_place,
    norm,
    products_in_momentum,
    stays_on_ellipsoids,
)
from omegadot.reference_impl.energy import kinetic_energy, total_energy
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.momentum import angular_momentum, linear_momentum
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State, System

TRAJECTORY_UNITS = {"omega": "1", "attitude": "rad", "position": "m"}
THIN = 2.0  # times its own rate: more than a body does that is not thin
INVARIANT_CHANNELS = ("energy", "angular_momentum", "linear_momentum")


def _same(one: State, other: State) -> NDArray[np.bool_]:
    """(n,): whether all numbers are the same; q and -q are one attitude."""
    pairs = zip(vars(one).values(), vars(other).values(), strict=True)
    same = [np.all(a == b, axis=-1) for a, b in pairs]
    same[0] |= np.all(one.orientation == -other.orientation, axis=-1)
    return np.asarray(np.all(same, axis=0))


class Yardstick:
    """The sizes of one exact motion, against which its imitations are measured.

    rate: rad/s, the greatest |omega|; where the body never turns, the rate that its greatest
    omega-dot would reach over the motion.  eps: that of the precision which the imitations are
    computed in.  per_rounding: by how much omega turns, relative, where what is stepped is off by
    one part.
    """

    def __init__(self, system: System, times: Array, exact: State) -> None:
        self.system, self.eps, self.exact, self.times = system, EPS, exact, times
        self.per_rounding = 1.0
        self._open: Array | None = None
        self.roundings = PLAIN
        self.scale: BodyScale = body_scale(system)
        acceleration = forward_dynamics(system, exact)
        self.acceleration = float(np.max(angular_size(system, exact, acceleration)))
        duration = float(times[-1])
        self.rate = float(np.max(norm(exact.angular_velocity))) or self.acceleration * duration
        self.rate = self.rate or 1.0 / duration
        self.speed = float(np.max(norm(exact.linear_velocity))) + self.rate * self.scale.lever
        self.reach = float(np.max(norm(exact.position))) + self.scale.lever
        self.gravity = float(norm(system.load.gravity))
        # What accelerates a lever from the body's place to itself, over it, and its integral.
        turns = norm(exact.angular_velocity) ** 2 + norm(acceleration.angular)
        turns = turns * (system.load.pivot is None)
        steps = np.maximum(turns[1:], turns[:-1]) * np.diff(times)
        self._turns, self._sharpest = np.append(0.0, np.cumsum(steps)), float(np.max(turns))
        kinetic = float(np.max(kinetic_energy(system, exact)))
        turning = float(np.max(norm(angular_momentum(system, exact))))
        moving = float(np.max(norm(linear_momentum(system, exact))))
        smallest, mass = self.scale.smallest, self.scale.mass
        spin = norm(apply(moving_inertia(system), exact.angular_velocity))
        self._momentum = max(1.0, float(np.max(spin)) / (smallest * self.rate))
        products = float(np.max(products_in_momentum(system, exact.angular_velocity)))
        self._products = max(1.0, products / (smallest * self.rate))
        self._carried = float(np.max(momentum_of_place(system, exact))) / (smallest * self.rate)
        gyration = float(np.sqrt(float(np.trace(system.body.inertia)) / mass))
        self.sizes = {
            "energy": kinetic or 0.5 * smallest * self.rate**2,
            "angular_momentum": turning or smallest * self.rate,
            # a body that stays in place has that of its turning
            "linear_momentum": moving or mass * self.rate * gyration,
        }

    @property
    def thin_rate(self) -> float:
        """rad/s: ``|omega| sqrt(J / lambda)``, how fast the body may turn about its thinnest axis.

        The energy of |omega| about the axis of the largest moment J, in that of the least, lambda.
        """
        moments = np.linalg.eigvalsh(np.asarray(moving_inertia(self.system), dtype=float))
        return float(self.rate * np.sqrt(moments[-1] / moments[0]))

    @property
    def by_momentum(self) -> float:
        """``|J omega| / lambda`` over the rate: how far omega turns as the momentum is off by all.

        J's least eigenvalue is lambda.
        """
        return self._momentum

    def with_eps(self, eps: float) -> Yardstick:
        """The same sizes for imitations in another precision.

        In single precision the rounding of every step shows, and what is stepped may be the angular
        momentum, the sum of products that may cancel: omega is then off by ``||J| |omega|| /
        lambda``, lambda J's least eigenvalue.
        """
        other = copy(self)
        other.eps, other.per_rounding = eps, self._products if eps > EPS else 1.0
        return other

    def of_momentum(self) -> Yardstick:
        """The same sizes for a scheme that may step the angular momentum, rounded at every step.

        In double it may be that about the world's origin, which holds ``m x times v`` besides.
        """
        other = copy(self)
        other.per_rounding = self._momentum + (self._carried if self.eps <= EPS else 0.0)
        return other

    def of_roundings(self, roundings: Roundings) -> Yardstick:
        """The same sizes for steps that round otherwise than most."""
        other = copy(self)
        other.roundings = roundings
        return other

    def is_stiff(self, timestep: float) -> bool:
        """Whether steps of the momentum in world axes are beyond the stability of explicit schemes.

        An error of the attitude then turns omega at the rate ``|J omega| / lambda``, of a thin body
        many times its own, and grows at every step that is longer than one over this.
        """
        return self._momentum > THIN and timestep * self.rate * self._momentum > 1.0

    def of_kept(self, omega: Array, steps: Array) -> Yardstick:
        """The same sizes for a scheme that keeps energy and momentum to rounding.

        omega: (n, 3), after so many steps (n,).  It puts omega back on the ellipsoids of both after
        every step, each time off by as many roundings as `between_ellipsoids` has; over a run, by
        their mean until then.
        """
        if not stays_on_ellipsoids(self.system, omega, omega[0], steps, self.eps):
            return self
        exact, other = self.exact.angular_velocity, copy(self)
        roundings = between_ellipsoids(self.system, exact, self.eps)[1]
        other._open = np.cumsum(roundings) / np.arange(1.0, len(roundings) + 1.0)
        return other

    def distance(self, channel: str, one: State, other: State) -> Array:
        """(n,): |one - other| in this channel.

        omega: over the rate.  attitude: rad, or how much longer a quaternion is, whichever is more.
        position: m.  energy, momenta: over their sizes.  The same numbers are nowhere apart, though
        no distance can be worked out with them.
        """
        found = self._distance(channel, one, other)
        if np.isfinite(found).all():
            return found
        return np.where(_same(one, other), 0.0, found)

    def _distance(self, channel: str, one: State, other: State) -> Array:
        # An engine that has gone astray may be where squares overflow: that far away is infinite.
        with np.errstate(over="ignore", invalid="ignore"):
            if channel == "omega":
                return np.asarray(norm(one.angular_velocity - other.angular_velocity) / self.rate)
            if channel == "attitude":
                length = np.abs(norm(one.orientation) - norm(other.orientation))
                return np.maximum(attitude_angle(one.orientation, other.orientation), length)
            if channel == "position":
                return norm(one.position - other.position)
            if channel == "energy":
                gap = np.abs(total_energy(self.system, one) - total_energy(self.system, other))
            elif channel == "linear_momentum":  # of the velocity as reported, on a pivot too
                gap = self.scale.mass * norm(one.linear_velocity - other.linear_velocity)
            else:
                turned = (angular_momentum(self.system, state) for state in (one, other))
                gap = norm(next(turned) - next(turned))
            return np.asarray(gap / self.sizes[channel])

    def faster(self, state: State, timestep: float) -> Array:
        """(n,): how many times faster than in the exact motion the body has been, at least one.

        Infinite from where a scheme that diverges turns by more than half a turn in a step, which
        the exact motion does not: charts of the rotation differ by whole turns there.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            times: Array = norm(state.linear_velocity) / (self.speed or np.inf)
            turn = timestep * norm(state.angular_velocity)
        lost = turn > np.maximum(np.pi, timestep * self.rate)
        times = np.where(np.isfinite(times) & ~lost, times, np.inf)
        return np.maximum.accumulate(np.maximum(times, 1.0))

    @np.errstate(over="ignore", invalid="ignore")  # a motion may be where squares overflow
    def round_off(
        self,
        timestep: float | Array,
        steps: Array,
        growth: Array,
        faster: Array | float = 1.0,
    ) -> dict[str, Array]:
        """(n,) per channel: how far rounding may take a sound engine after so many steps.

        Each step adds ``c eps (k + h A / rate)`` (k is `per_rounding`, and A the greatest size of
        omega-dot, so that an ill-conditioned inertia counts), and what was added earlier grows by
        at most `growth`: ``theta = c eps (n + 1) (k + h A / rate) growth``, for attitude in rad and
        for omega / rate alike. The others follow from it to first order; a velocity that is kept in
        body axes is turned by theta, as far as steps do not turn it back: ``h rate`` of it a
        radian. An engine's lever that is the difference of two places in the world is off by a
        rounding of x, of which ``|omega|^2 + |omega-dot|`` is an acceleration. Velocities that are
        differences over a step have the roundings of a turn over h, and of x over h.
        faster: of a scheme whose velocity grows beyond the exact one, and rounding with it, see
        `faster`; ``m |v|^2`` may be among the terms of omega-dot. From where theta reaches one in
        such a run, rounding has made another motion, of which growth says nothing: no bound.
        """
        amount = self.roundings.per_step * self.eps * (steps + 1.0)
        turning = timestep * self.acceleration * faster**2 / self.rate
        time = timestep * steps
        opened = 0.0 if self._open is None else np.interp(time, self.times, self._open)
        of_turn = 1.0 / (timestep * self.rate) if self.roundings.of_turns else 0.0
        theta = amount * (np.maximum(self.per_rounding, of_turn) + opened + turning) * growth
        swift = self.speed * faster
        speed = amount * (swift + self.gravity * time) + theta * self.rate * self.scale.lever
        speed = speed + (amount * self.reach / timestep if self.roundings.of_places else 0.0)
        speed = speed + theta * swift * np.minimum(1.0, timestep * self.rate**2 * time)
        turned = np.interp(time, self.times, self._turns) + timestep * self._sharpest
        speed = speed + ROUNDINGS_PER_STEP * self.eps * self.reach * turned * faster**2
        reach = amount * self.reach + time * speed + theta * self.scale.lever
        found = {
            "omega": theta,
            "attitude": theta,
            "position": reach,
            **self.invariant_round_off(theta, speed, reach, swift),
        }
        lost = np.maximum.accumulate(np.atleast_1d((theta >= 1.0) & (np.asarray(faster) > 1.0)))
        if not lost.any():
            return found
        return {channel: np.where(lost, np.inf, bound) for channel, bound in found.items()}

    def apart_by(self, theta: Array, times: Array) -> dict[str, Array]:
        """(n,) per channel: how far apart motions are whose attitude and omega are by theta, rad.

        times: (n,) s, over which a velocity that is off moves the place.
        """
        speed = theta * self.rate * self.scale.lever
        reach = theta * self.scale.lever + times * speed
        own = {"omega": theta, "attitude": theta, "position": reach}
        return {**own, **self.invariant_round_off(theta, speed, reach)}

    def invariant_round_off(
        self, theta: Array, speed: Array, reach: Array, swift: Array | float | None = None
    ) -> dict[str, Array]:
        """(n,) per invariant: how far it is off where omega and attitude are off by theta, the
        velocity by speed in m/s and the position by reach in m, to second order: of a motion that
        blows up the squares are all there is, and of a body at rest.

        swift: m/s, the body's own greatest speed, if it is not that of the exact motion.
        """
        own = (self.speed if swift is None else swift) + speed
        mass, spin = self.scale.mass, self.scale.largest * self.rate
        turning = 2.0 * spin * theta * (1.0 + theta)  # |I d_omega| + |d_theta x I omega|, squares
        moving = mass * own * speed + mass * self.gravity * reach
        lever = mass * (self.scale.lever * speed + own * reach)
        pivoted = 0.0 if self.system.load.pivot is None else lever
        return {
            "energy": (turning * self.rate + moving) / self.sizes["energy"],
            "angular_momentum": (turning + pivoted) / self.sizes["angular_momentum"],
            "linear_momentum": mass * speed / self.sizes["linear_momentum"],
        }
