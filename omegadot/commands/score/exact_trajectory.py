"""The exact trajectory at a trace's own times, and what a perfect trace may be off it by.

That is its printed digits, rounding, and the resolvable floor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.commands.score.trace import Trace
from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION, ROUNDINGS_PER_STEP, norm
from omegadot.gates.truth import Truth
from omegadot.reference_impl.closed_forms import closed_form_of
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.momentum import angular_momentum, linear_momentum
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.system import Array, State, System

# Growth and floor change over turns of the body, not over samples.
MOST_FOLLOWED = 1000
ExactTrajectory = Callable[[Array], State]
Rounding = dict[str, Array]


def part_of(state: State, rows: object) -> State:
    """The states at some samples."""
    return State(*(values[rows] for values in vars(state).values()))


def exact_trajectory(system: System, initial: State) -> ExactTrajectory:
    """The exact motion as a function of rising times (n,) s, none of them negative."""
    form = closed_form_of(system, initial)
    if form is not None:
        return form

    def by_series(times: Array) -> State:
        if times[0] == 0.0:
            return solve_series(system, initial, times)
        found = solve_series(system, initial, np.concatenate(([0.0], times)))
        return part_of(found, slice(1, None))

    return by_series


def _spread(times: Array, known: Array, values: Array) -> Array:
    """Values at some of the times, reported at all: the greater of both neighbours."""
    right = np.clip(np.searchsorted(known, times), 1, len(known) - 1)
    return np.asarray(np.maximum(values[right - 1], values[right]))


def truth_at(system: System, initial: State, times: Array) -> Truth:
    """The exact states at `times`, (n,) s, the growth of rounding up to there, and the floor."""
    rows = np.unique(np.linspace(0, len(times) - 1, MOST_FOLLOWED).round().astype(int))
    some = times[rows]
    if some[0] > 0.0:  # what grows, grows from the start
        some = np.concatenate(([0.0], some))
    exact = exact_solution(system, initial, some)
    state = exact_trajectory(system, initial)(times)
    yardstick = Yardstick(system, times, state)
    growth = growth_along(system, some, exact.state, yardstick.rate)
    floor = {
        "omega": exact.floor.angular_velocity / yardstick.rate,
        "attitude": exact.floor.attitude,
    }
    return Truth(
        source=exact.source,
        times=times,
        state=state,
        omega_dot=forward_dynamics(system, state).angular,
        growth=_spread(times, some, growth),
        floor={channel: _spread(times, some, values) for channel, values in floor.items()},
        yardstick=yardstick,
    )


def _slope(times: Array, values: Array) -> Array:
    """(n,) per s: how fast a quantity changes, for what an inexact time stamp makes of it."""
    if len(times) < 3:
        return np.zeros(len(times))
    rate = np.gradient(values, times, axis=0)
    return np.asarray(np.abs(rate) if rate.ndim == 1 else norm(rate))


def _digits_open(truth: Truth, trace: Trace, rotation_alone: bool) -> Rounding:
    """(n,) by channel, in its units: the resolution by the digits of values and of time stamps.

    To first order, each in its worst direction; a stamp's part is the exact rate of change times
    what is open of the time. rotation_alone: whether the energy is that of the rotation.
    """
    yardstick, exact, when = truth.yardstick, truth.state, trace.open["times"]
    nothing = np.zeros(len(trace.times))
    turn, spin, place, speed = (trace.open.get(part, nothing) for part in vars(exact))
    moment = norm(angular_momentum(yardstick.system, exact))
    mass, scale = yardstick.scale.mass, yardstick.scale.largest
    rate, velocity = norm(exact.angular_velocity), norm(exact.linear_velocity)
    lever = yardstick.scale.lever if yardstick.system.load.pivot is not None else 0.0
    energy = moment * spin
    if not rotation_alone:
        energy = energy + mass * velocity * speed
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


def bounds_of(
    truth: Truth, trace: Trace, rotation_alone: bool
) -> tuple[Rounding, Rounding, Rounding]:
    """(n,) by channel: the resolution by the digits, and the whole of what is left open.

    The third is the resolution by the digits of the values alone, of stamps that are known exactly.
    The whole is the digits, the rounding of a change of units and frames, and the resolvable floor.
    The chain of roundings is that of an evaluation, not of a step.
    """
    digits, count = _digits_open(truth, trace, rotation_alone), len(truth.times)
    once = truth.yardstick.round_off(0.0, np.zeros(count), np.ones(count))
    chain = ROUNDINGS_PER_EVALUATION / ROUNDINGS_PER_STEP
    read = {c: chain * bound + truth.floor.get(c, 0.0) for c, bound in once.items()}
    still = replace(trace, open={**trace.open, "times": np.zeros(count)})
    return digits, joined(digits, read), _digits_open(truth, still, rotation_alone)


def joined(*bounds: Rounding) -> Rounding:
    """The sum of several bounds, channel by channel."""
    return {c: np.asarray(np.sum([b[c] for b in bounds], axis=0)) for c in bounds[0]}
