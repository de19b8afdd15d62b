"""The rate that steps made ever smaller tend to, and how far rounding lets it be off.

One step from a state x leads to ``Phi_h(x)``, and for every consistent scheme, whatever its order,
``(Phi_h(x) - x) / h`` tends to the equation's rate at x. The limit is extrapolated from halved
steps (Richardson 1911); what a scheme adds vanishes in it, and what a fault adds does not.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.gates.bounds.roundings import (
    PLAIN,
    Roundings,
    is_change_of_attitude,
    is_change_of_place,
)
from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    angular_size,
    between_ellipsoids,
    body_scale,
    linear_size,
    momentum_of_place,
    norm,
    products_in_momentum,
    stays_on_ellipsoids,
)
from omegadot.gates.steps.probe import SINGLE, Ladder, Probe, ladder_of
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State, System
from omegadot.written import written


def _extrapolants(quotients: Array) -> tuple[Array, Array, Array]:
    """The last three extrapolants to no step, the best first, of (..., 5, c) at halved steps."""
    last, table = [], quotients
    for level in range(1, quotients.shape[-2]):
        table = (2.0**level * table[..., 1:, :] - table[..., :-1, :]) / (2.0**level - 1.0)
        last.append(table[..., -1, :])
    return last[-1], last[-2], last[-3]


def extrapolated(values: Array) -> Array:
    """The limit at no step of (..., 5, c) at halved steps."""
    return np.asarray(_extrapolants(values)[0])


FEWEST = 3  # states that show of which kind rounding is
FARTHER = 64.0  # times: half way, by factors, from 16 to 256
GROWN = 4.0  # times: half way, by factors, from 1 of a wrong equation to 16
_WEIGHTS = np.abs(_extrapolants(np.eye(5))[0])
_AMPLIFIED = float(np.sum(_WEIGHTS))  # what the extrapolation makes of roundings of the rates


@dataclass(frozen=True)
class Limit:
    """One quantity's rate at no step by each range of steps, (r, m, 3), and the equation's (m, 3).

    bound: (r, m), how far the extrapolants differ, and what rounding makes of it. Where they
    converge, the difference of two is the error of the worse.
    jump: (m,), by how much the quantity changes in steps that vanish; zero where that vanishes too.
    rounding: (r, m), what rounding alone makes of the limit.
    """

    found: Array
    expected: Array
    bound: Array
    jump: Array | None = None
    rounding: Array = field(default_factory=lambda: np.zeros((2, 1)))

    def shares(self, factor: float = 1.0) -> Array:
        """(m,): the distance from `factor` times the equation's rate, in parts of its bound."""
        apart = norm(self.found - factor * self.expected)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.where(apart == 0.0, 0.0, apart / self.bound)
        least: Array = np.min(np.where(np.isnan(shares), np.inf, shares), axis=0)
        return least

    def jumps(self, unit: str) -> str:
        """By how much the quantity changes in steps that vanish, in its unit; "" if it does not.

        unit: of the rate.
        """
        place = int(np.argmax(self.shares()))
        if self.jump is None or self.jump[place] == 0.0:
            return ""
        own = unit.replace("/s^2", "/s") if unit.endswith("/s^2") else unit.removesuffix("/s")
        return f"{written(self.jump[place], 2)} {own}"

    def off(self, unit: str) -> str:
        """How far it is from the equation's at the worst of the states, relative or in its unit."""
        place = int(np.argmax(self.shares()))
        apart = float(np.min(norm(self.found - self.expected)[:, place]))
        size = float(norm(self.expected[place]))
        if size <= float(np.max(self.bound[:, place])):
            return f"it is {written(apart, 2)} {unit} instead of nothing"
        nearest = int(np.argmin(norm(self.found - self.expected)[:, place]))
        acting = float(norm(self.found[nearest, place]))
        rates = (written(acting, 2), written(size, 2))
        # sizes that differ by less than the vectors do are not what is wrong
        turned = ", in another direction" * (abs(acting - size) < 0.5 * apart)
        instead = f" ({rates[0]} {unit} instead of {rates[1]}{turned})"
        return f"the relative error is {written(apart / size, 2)}{instead * (rates[0] != rates[1])}"


@dataclass(frozen=True)
class Tolerated:
    """What an error-controlled integrator may be off, relative: in a run, and in each radian."""

    in_a_run: float = 0.0
    in_a_radian: float = 0.0


NOTHING = Tolerated()


def limits(
    system: System,
    probe: Probe,
    stepped: State,
    eps: float = EPS,
    tolerated: Tolerated = NOTHING,
    known: bool = True,
    roundings: Roundings = PLAIN,
) -> dict[str, Limit]:
    """The rates at no step by channel. stepped: (m, k, ...), the states after one step each.

    A step rounds what it steps by ``16 eps``, which is divided by the step. What it steps may be
    the angular momentum, whose products of the entries of J and omega may cancel: omega is then
    rounded by ``16 eps ||J| |omega|| / lambda``, J the inertia, lambda its least eigenvalue, and
    |J| |omega| of absolute values; and by velocities so rounded attitude and position move. A screw
    motion is a turn about an axis at the distance |v| / |omega|, which is rounded as places are.
    Of a scheme that steps the momentum in world axes an error of the attitude grows at the rate
    |J omega| / lambda. One that is not known may step the momentum about the world's origin, which
    holds ``m x times v`` besides. One that puts omega back on its ellipsoids leaves it open in one
    direction (`between_ellipsoids`). One that takes velocities from two places rounds them by parts
    of these over h (`Roundings`). What moves a body from rest is the velocity within the step, and
    that is rounded by h times the rounding of its rate. A velocity that is nothing at the start has
    no size: an accuracy is absolute there, in rad/s or m/s. Single precision has no steps that are
    short against that of a thin body: there the bound is infinite.
    """
    states, h = probe.states, probe.timesteps
    before = states[:, None]
    true, scale = acceleration_of(system)(states), body_scale(system)
    w, v, lever = states.angular_velocity, states.linear_velocity, scale.lever
    spinning = products_in_momentum(system, w) / scale.smallest
    direction, between = between_ellipsoids(system, w, eps)
    kept = stays_on_ellipsoids(system, stepped.angular_velocity, w, np.ones(1), eps)
    opened = np.where(kept, between * norm(w), 0.0)
    elsewhere = 0.0 if known or eps > EPS else 1.0  # in single precision no engine could
    carried = elsewhere * momentum_of_place(system, states) / scale.smallest
    turning = spinning + opened + carried
    moving = norm(v) + lever * turning
    step, evaluation = roundings.per_step * eps, ROUNDINGS_PER_EVALUATION * eps
    of_omega = evaluation * angular_size(system, states, true)
    of_velocity = evaluation * linear_size(system, states, true, eps)
    turn = rotation_between(before.orientation, stepped.orientation)
    spin = stepped.angular_velocity - before.angular_velocity
    way, push = stepped.position - before.position, stepped.linear_velocity - before.linear_velocity
    # Turns much shorter than this are taken by their series, which is no turn about an axis.
    least_turn = eps**0.25 / h[:, 0]
    place = norm(states.position) + lever + norm(v) / np.maximum(norm(w), least_turn)
    of_turns = step / h * roundings.of_turns
    of_places = step * norm(states.position)[:, None] / h * roundings.of_places
    more = {
        "omega": of_turns,
        "linear_momentum": of_places + lever * of_turns,
        "attitude": h**2 * of_omega[:, None],
        "position": h**2 * (of_velocity + lever * of_omega)[:, None],
    }
    parts = {  # what changes, its rate, and the roundings of what is stepped and of the rate
        "attitude": (turn, w, step * np.ones(len(w)), step * turning),
        "omega": (spin, true.angular, step * (spinning + carried), of_omega),
        "position": (way, v, step * place, step * moving),
        "linear_momentum": (push, true.linear, step * moving, of_velocity),
    }
    nothing = {"omega": norm(w) == 0.0, "linear_momentum": norm(v) == 0.0}
    found, ladder = {}, ladder_of(eps)
    growth = h[:, -1] * norm(apply(moving_inertia(system), w)) / scale.smallest
    grows = growth > 1.0 if ladder is SINGLE else np.zeros(len(w), bool)
    follows = ("attitude", "omega") if system.load.pivot is None else tuple(parts)
    for channel, (change, rate, rounding, per_rate) in parts.items():
        size = rounding / step
        loose = tolerated.in_a_radian * ladder.radians / h[:, 0] * size
        # What changes from nothing has the size of its change: a rate may be off by such parts.
        parts_of_rate = tolerated.in_a_run + tolerated.in_a_radian * ladder.radians
        loose = loose + parts_of_rate * norm(rate)
        absolute = np.where(nothing.get(channel, False), 1.0, 0.0)
        own = rounding + tolerated.in_a_run * np.maximum(size, absolute)
        per_rate = np.where(grows & (channel in follows), np.inf, per_rate + loose)
        rounded = own[:, None] + more.get(channel, np.zeros_like(h))
        found[channel] = _limit(ladder.ranges, h, change, rate, rounded, per_rate)
    found["omega"] = _opened(found["omega"], ladder, h, direction, step * opened)
    return found


def roundings_of(
    system: System, probe: Probe, stepped: State, eps: float, per_step: float
) -> Roundings:
    """Which velocities are taken from places, as single steps show.

    The rounding of a velocity that is stepped is ``eps / h`` in its rate; that of places, over h,
    is ``eps / h^2``. By steps 16 times shorter the one is off 16 times as far, the other 256 times;
    and a wrong equation as far as before. A few states, whose ratio is left to chance, show it
    where the velocity is the change of place, or of attitude, over h, and the rate is off farther.
    Single precision has no such steps: there that alone shows it, of omega as well where that is
    the turn over h.
    """
    if len(ladder_of(eps).ranges) < 2:
        given = State(*(f.astype(np.float32).astype(float) for f in vars(probe.states).values()))
        steps = (given[:, None], stepped, probe.timesteps, eps)
        own = is_change_of_place(*steps)
        return Roundings(own, own and is_change_of_attitude(*steps), per_step)
    found = limits(system, probe, stepped, eps)
    steps = (probe.states[:, None], stepped, probe.timesteps, eps)
    changes = {"linear_momentum": is_change_of_place, "omega": is_change_of_attitude}
    taken = dict[str, bool]()
    for channel, is_change in changes.items():
        one = found[channel]
        long, short = norm(one.found - one.expected)[:2]
        seen = (long > 0.0) & (short > one.rounding[1])  # of what is stepped nothing is this far
        ratios = np.log(short[seen] / long[seen])
        few = 0 < len(ratios) < FEWEST
        grows = len(ratios) > 0 and bool(np.mean(ratios) > np.log(GROWN if few else FARTHER))
        taken[channel] = grows and (not few or is_change(*steps))
    return Roundings(taken["linear_momentum"], taken["omega"], per_step)


def _opened(limit: Limit, ladder: Ladder, h: Array, direction: Array, rounding: Array) -> Limit:
    """The limit, as near the equation's rate as rounding omega in one direction may bring it."""
    off = np.sum((limit.found - limit.expected) * direction, axis=-1)
    rounded = [rounding * np.sum(_WEIGHTS / h[:, steps], axis=-1) for steps in ladder.ranges]
    nearer = np.clip(off, -np.array(rounded), np.array(rounded))
    return replace(limit, found=limit.found - nearer[..., None] * direction)


def _limit(
    ranges: tuple[slice, ...],
    h: Array,
    change: Array,
    expected: Array,
    rounding: Array,
    per_rate: Array,
) -> Limit:
    """rounding: (m, k), of what changes in each of the steps."""
    found, bounds, rounded = [], [], []
    for steps in ranges:
        best, worse, worst = _extrapolants(change[:, steps] / h[:, steps, None])
        found.append(best)
        own = np.sum(rounding[:, steps] * _WEIGHTS / h[:, steps], axis=-1)
        rounded.append(own + per_rate * _AMPLIFIED)
        bounds.append(norm(best - worse) + norm(worse - worst) + rounded[-1])
    left = norm(extrapolated(change[:, ranges[0]]))
    jumps = left > 0.5 * norm(change[:, ranges[0].start])  # of the longest of these steps
    jumps &= left > np.sum(rounding[:, ranges[0]] * _WEIGHTS, axis=-1)
    jump = np.where(jumps, left, 0.0)
    return Limit(np.array(found), expected, np.array(bounds), jump, np.array(rounded))
