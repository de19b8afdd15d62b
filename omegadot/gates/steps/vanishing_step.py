"""Gate 3: steps made ever smaller must follow the equation.

One step from a state x leads to ``Phi_h(x)``, and for every consistent scheme, whatever its order,
``(Phi_h(x) - x) / h`` tends to the equation's rate at x. The limit is extrapolated from halved
steps (Richardson 1911); what a scheme adds vanishes in it, and what a fault adds does not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    ROUNDINGS_PER_STEP,
    angular_size,
    between_ellipsoids,
    body_scale,
    linear_size,
    momentum_of_place,
    norm,
    stays_on_ellipsoids,
)
from omegadot.gates.rows import Row, within
from omegadot.gates.states.equation import EvaluationStates
from omegadot.reference_impl.body_motion import attitude_motion
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State, System

GATE = "scheme"
METRIC = "rate_at_no_step"
UNITS = {"attitude": "rad/s", "omega": "rad/s^2", "position": "m/s", "linear_momentum": "m/s^2"}
UNDETERMINED = "not judged: in this precision the inverse of the inertia has no digit"
TOO_LONG = "not judged: of so thin a body no steps in this precision are short enough"
PROBES = 6  # of the random states, and as many along the exact trajectory


@dataclass(frozen=True)
class Ladder:
    """Halved steps: the radians r of the longest, and the ranges of five that give a limit each.

    Relative to a rate, five steps leave about ``r^5 / 2^10`` of the scheme's own terms, and
    ``80 * 16 eps / r`` of rounding. The two are equal at 0.026 rad in double and at 0.73 rad in
    single precision, and a part of that is taken.
    digits: those of a step's length that rounding leaves certain.
    """

    radians: float
    ranges: tuple[slice, ...]
    digits: int

    @property
    def count(self) -> int:
        """How many steps there are."""
        return int(self.ranges[-1].stop)


# A scheme may take short turns by a shorter formula, which breaks the smoothness at one length of
# step. Such a break lies in one of two ranges of steps only, and a fault shows in both.
DOUBLE = Ladder(2.0**-7, (slice(0, 5), slice(4, 9)), 4)
# Shorter steps are hidden by rounding here, and so is the break of a formula that is sound.
SINGLE = Ladder(2.0**-1, (slice(0, 5),), 2)


def ladder_of(eps: float) -> Ladder:
    """The steps for engines of this precision."""
    return DOUBLE if eps <= EPS else SINGLE


@dataclass(frozen=True)
class Probe:
    """States (m, ...) to take one step from, and the steps (m, k) in s to try there."""

    states: State
    timesteps: Array


def probe_of(system: System, evaluation_states: EvaluationStates, eps: float = EPS) -> Probe:
    """States to step from, (m,), and steps (m, k) s, short against all that goes on there."""
    count = len(evaluation_states.path.angular_velocity)
    along = np.unique(np.linspace(0, count - 1, PROBES).round().astype(int))
    random, path = vars(evaluation_states.random), vars(evaluation_states.path)
    pairs = zip(random.values(), path.values(), strict=True)
    states = State(*(np.concatenate([one[:PROBES], two[along]]) for one, two in pairs))
    turning = (states.orientation, states.angular_velocity)
    w_dot, jacobian = acceleration_and_jacobian(attitude_motion(system), *turning)
    slopes = np.max(np.abs(jacobian), axis=(-1, -2))
    rate = np.maximum.reduce((norm(states.angular_velocity), np.sqrt(norm(w_dot)), slopes))
    ladder = ladder_of(eps)
    longest = ladder.radians / np.where(rate > 0.0, rate, 1.0)
    return Probe(states, longest[:, None] / 2.0 ** np.arange(ladder.count))


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


_WEIGHTS = np.abs(_extrapolants(np.eye(5))[0])
_AMPLIFIED = float(np.sum(_WEIGHTS))  # what the extrapolation makes of roundings of the rates


@dataclass(frozen=True)
class Limit:
    """One quantity's rate at no step by each range of steps, (r, m, 3), and the equation's (m, 3).

    bound: (r, m), how far the extrapolants differ, and what rounding makes of it. Where they
    converge, the difference of two is the error of the worse.
    """

    found: Array
    expected: Array
    bound: Array

    def shares(self, factor: float = 1.0) -> Array:
        """(m,): the distance from `factor` times the equation's rate, in parts of its bound."""
        apart = norm(self.found - factor * self.expected)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares = np.where(apart == 0.0, 0.0, apart / self.bound)
        least: Array = np.min(np.where(np.isnan(shares), np.inf, shares), axis=0)
        return least

    def off(self, unit: str) -> str:
        """How far it is from the equation's at the worst of the states, relative or in its unit."""
        place = int(np.argmax(self.shares()))
        apart = float(np.min(norm(self.found - self.expected)[:, place]))
        size = float(norm(self.expected[place]))
        if size <= float(np.max(self.bound[:, place])):
            return f"it is {apart:.1e} {unit} instead of nothing"
        return f"the relative error is {apart / size:.1e}"


@dataclass(frozen=True)
class Tolerated:
    """What an error-controlled integrator may be off, relative: in a run, and in each radian."""

    in_a_run: float = 0.0
    in_a_radian: float = 0.0


def limits(
    system: System,
    probe: Probe,
    stepped: State,
    eps: float = EPS,
    tolerated: Tolerated = Tolerated(),
    known: bool = True,
) -> dict[str, Limit]:
    """The rates at no step by channel. stepped: (m, k, ...), the states after one step each.

    A step rounds what it steps by ``16 eps``, which is divided by the step. What it steps may be
    the angular momentum: omega is then rounded by ``16 eps |J omega| / lambda``, J the inertia and
    lambda its least eigenvalue; and by velocities so rounded attitude and position move. A screw
    motion is a turn about an axis at the distance |v| / |omega|, which is rounded as places are.
    Of a scheme that steps the momentum in world axes an error of the attitude grows at the rate
    |J omega| / lambda. One that is not known may step the momentum about the world's origin, which
    holds ``m x times v`` besides. One that puts omega back on its ellipsoids leaves it open in one
    direction (`between_ellipsoids`). Single precision has no steps that are short against that of a
    thin body: there the bound is infinite.
    """
    states, h = probe.states, probe.timesteps
    before = states[:, None]
    true, scale = acceleration_of(system)(states), body_scale(system)
    w, v, lever = states.angular_velocity, states.linear_velocity, scale.lever
    spinning = norm(apply(moving_inertia(system), w)) / scale.smallest
    direction, roundings = between_ellipsoids(system, w, eps)
    kept = stays_on_ellipsoids(system, stepped.angular_velocity, w, np.ones(1), eps)
    opened = np.where(kept, roundings * norm(w), 0.0)
    elsewhere = 0.0 if known or eps > EPS else 1.0  # in single precision no engine could
    carried = elsewhere * momentum_of_place(system, states) / scale.smallest
    turning = spinning + opened + carried
    moving = norm(v) + lever * turning
    step, evaluation = ROUNDINGS_PER_STEP * eps, ROUNDINGS_PER_EVALUATION * eps
    of_omega = evaluation * angular_size(system, states, true)
    of_velocity = evaluation * linear_size(system, states, true, eps)
    turn = rotation_between(before.orientation, stepped.orientation)
    spin = stepped.angular_velocity - before.angular_velocity
    way, push = stepped.position - before.position, stepped.linear_velocity - before.linear_velocity
    # Turns much shorter than this are taken by their series, which is no turn about an axis.
    least_turn = eps**0.25 / h[:, 0]
    place = norm(states.position) + lever + norm(v) / np.maximum(norm(w), least_turn)
    parts = {  # what changes, its rate, and the roundings of what is stepped and of the rate
        "attitude": (turn, w, step * np.ones(len(w)), step * turning),
        "omega": (spin, true.angular, step * (spinning + carried), of_omega),
        "position": (way, v, step * place, step * moving),
        "linear_momentum": (push, true.linear, step * moving, of_velocity),
    }
    found, ladder = {}, ladder_of(eps)
    grows = h[:, -1] * spinning > 1.0 if ladder is SINGLE else np.zeros(len(w), bool)
    follows = ("attitude", "omega") if system.load.pivot is None else tuple(parts)
    for channel, (change, rate, rounding, per_rate) in parts.items():
        size = rounding / step
        loose = tolerated.in_a_radian * ladder.radians / h[:, 0] * size
        # What changes from nothing has the size of its change: a rate may be off by such parts.
        parts_of_rate = tolerated.in_a_run + tolerated.in_a_radian * ladder.radians
        loose = loose + parts_of_rate * norm(rate)
        own = rounding + tolerated.in_a_run * size
        per_rate = np.where(grows & (channel in follows), np.inf, per_rate + loose)
        found[channel] = _limit(ladder.ranges, h, change, rate, own, per_rate)
    found["omega"] = _opened(found["omega"], ladder, h, direction, step * opened)
    return found


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
    found, bounds = [], []
    for steps in ranges:
        best, worse, worst = _extrapolants(change[:, steps] / h[:, steps, None])
        rounded = rounding * np.sum(_WEIGHTS / h[:, steps], axis=-1)
        found.append(best)
        bounds.append(norm(best - worse) + norm(worse - worst) + rounded + per_rate * _AMPLIFIED)
    return Limit(np.array(found), expected, np.array(bounds))


def _common_factor(found: dict[str, Limit]) -> float | None:
    """The factor by which all rates are off: the step is longer than requested by that factor."""
    weights = [np.where(one.bound[0] > 0.0, 1.0 / one.bound[0], 0.0) for one in found.values()]
    pairs = list(zip(found.values(), weights, strict=True))
    rates = np.concatenate([np.ravel(one.found[0] * part[:, None]) for one, part in pairs])
    true = np.concatenate([np.ravel(one.expected * part[:, None]) for one, part in pairs])
    factor = float(rates @ true / (true @ true))
    return factor if all(np.all(one.shares(factor) <= 1.0) for one in found.values()) else None


def rows(
    system: System,
    probe: Probe,
    stepped: State,
    eps: float = EPS,
    tolerated: Tolerated = Tolerated(),
    known: bool = True,
) -> list[Row]:
    """Per channel, how far the steps' own rate is from the equation's, in parts of its bound.

    known: whether the scheme is.  Where ``64 eps J / lambda`` reaches one, rounding leaves no digit
    of the inertia's inverse.
    """
    scale, digits = body_scale(system), ladder_of(eps).digits
    with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
        found = limits(system, probe, stepped, eps, tolerated, known)
        shares = {channel: float(np.max(one.shares())) for channel, one in found.items()}
        wrong = not all(share <= 1.0 for share in shares.values())
        factor = _common_factor(found) if wrong else None
        if wrong and ROUNDINGS_PER_EVALUATION * eps * scale.largest >= scale.smallest:
            worst = max(shares, key=lambda channel: shares[channel])
            return [Row(GATE, worst, METRIC, shares[worst], "1", 1.0, "info", UNDETERMINED)]
        notes = {
            channel: _note(one, factor, digits, UNITS[channel]) for channel, one in found.items()
        }
        return [
            Row(GATE, channel, METRIC, 0.0, "1", 1.0, "info", TOO_LONG)
            if np.all(np.isinf(found[channel].bound))
            else within(GATE, channel, METRIC, share, "1", 1.0, notes[channel])
            for channel, share in shares.items()
        ]


def _note(limit: Limit, factor: float | None, digits: int, unit: str) -> str:
    if not np.all(np.isfinite(limit.found)):
        return "a step leads to numbers that are not finite"
    if factor is not None and abs(factor) < 10.0**-digits:  # it would read 100 % too short
        return "a run of one step does not move"
    if factor is not None:
        off = f"{100 * abs(factor - 1.0):.{digits}g} %"
        return f"steps are {off} too {'long' if factor > 1 else 'short'}"
    return f"as the step vanishes, its rate is not the equation's: {limit.off(unit)}"
