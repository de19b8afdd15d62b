"""What a perfect trace may be off by: its printed digits, rounding, and the resolvable floor."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.commands.score.trace import Trace
from omegadot.gates.scales import ROUNDINGS_PER_EVALUATION, ROUNDINGS_PER_STEP, norm
from omegadot.gates.truth import Truth
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.momentum import angular_momentum, linear_momentum
from omegadot.reference_impl.system import Array, State, System

Rounding = dict[str, Array]


def _slope(times: Array, values: Array) -> Array:
    """(n,) per s: how fast a quantity changes, for what an inexact time stamp makes of it."""
    if len(times) < 3:
        return np.zeros(len(times))
    rate = np.gradient(values, times, axis=0)
    return np.asarray(np.abs(rate) if rate.ndim == 1 else norm(rate))


def digits_open(truth: Truth, trace: Trace) -> Rounding:
    """(n,) by channel, in its units: the resolution by the digits of values and of time stamps.

    To first order, each in its worst direction; a stamp's part is the exact rate of change times
    what is open of the time.
    """
    yardstick, exact, when = truth.yardstick, truth.state, trace.open["times"]
    nothing = np.zeros(len(trace.times))
    spin = trace.open.get("angular_velocity", nothing)
    turn = trace.open.get("orientation", nothing)
    place = trace.open.get("position", nothing)
    speed = trace.open.get("linear_velocity", nothing)
    moment = norm(angular_momentum(yardstick.system, exact))
    mass, scale = yardstick.scale.mass, yardstick.scale.largest
    rate, velocity = norm(exact.angular_velocity), norm(exact.linear_velocity)
    lever = yardstick.scale.lever if yardstick.system.load.pivot is not None else 0.0
    energy = moment * spin + mass * velocity * speed
    energy = energy + mass * yardstick.gravity * (place + lever * turn)
    found = {
        "omega": (spin + norm(truth.omega_dot) * when) / yardstick.rate,
        "attitude": turn + rate * when,
        "position": place + velocity * when + lever * turn,
    }
    conserved: dict[str, tuple[Array, Callable[[System, State], Array]]] = {
        "energy": (energy, total_energy),
        "angular_momentum": (scale * spin + moment * turn, angular_momentum),
        "linear_momentum": (mass * speed, linear_momentum),
    }
    for channel, (own, quantity) in conserved.items():
        late = _slope(truth.times, quantity(yardstick.system, exact)) * when
        found[channel] = (own + late) / yardstick.sizes[channel]
    return found


def reading_bound(truth: Truth) -> Rounding:
    """(n,) by channel: the rounding of a change of units and frames, and the resolvable floor.

    The chain of roundings is that of an evaluation, not of a step.
    """
    count = len(truth.times)
    once = truth.yardstick.round_off(0.0, np.zeros(count), np.ones(count))
    chain = ROUNDINGS_PER_EVALUATION / ROUNDINGS_PER_STEP
    return {c: chain * bound + truth.floor.get(c, 0.0) for c, bound in once.items()}


def joined(*bounds: Rounding) -> Rounding:
    """The sum of several bounds, channel by channel."""
    return {c: np.asarray(np.sum([b[c] for b in bounds], axis=0)) for c in bounds[0]}
