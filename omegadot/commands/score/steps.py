"""A trace whose step, or scheme and step, is declared, compared with the schemes that are known."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import reduce
from math import gcd

import numpy as np

from omegadot.commands.score.declared import OTHERS, USUAL, Declared
from omegadot.commands.score.exact_trajectory import Rounding, joined, part_of
from omegadot.commands.score.measured import Measured, distance, filled
from omegadot.gates.bounds.likeness import Likeness, likeness, share_of
from omegadot.reference_impl.coordinates import Coordinates, distinct
from omegadot.reference_impl.flight.schemes import FLIGHT_SCHEMES, step_flight
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.solutions.companion import Steps, companion
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.system import Array, State

# All schemes are stepped to the first samples, and only those that fit there to the end: so many
# steps take seconds, not minutes.
MOST_STEPS_OF_ALL = 300_000
FIRST_SAMPLES = 4
# A scheme that leaves this part of an error is the nearest, though something is left.
NEAR = 0.01


@dataclass(frozen=True)
class Comparison:
    """A trace against one scheme of the reference's. bound: (n,) by channel, rounding and digits.

    left: (n,) by channel, the distance from the scheme's own trajectory.  own_start: the
    trajectory begins at the trace's first sample, which is not the scenario's state.
    """

    scheme: str
    left: dict[str, Array]
    bound: Rounding
    found: Likeness
    own_start: bool = False

    def agrees(self, channel: str) -> bool:
        """Whether rounding and digits account for what is left in a channel."""
        return share_of(self.left[channel], self.bound[channel]) <= 1.0

    def near(self, channel: str, error: Array) -> bool:
        """Whether next to nothing of an error is left."""
        left = self.left[channel]
        return bool(np.max(left) <= NEAR * np.max(error[: len(left)]))


@dataclass(frozen=True)
class Compared:
    """The schemes that were compared over the whole trace; the declared one, if any, comes first.

    not_sought: why no others were; empty where they were.
    """

    schemes: list[Comparison]
    not_sought: str = ""


def compare_schemes(held: Measured, declared: Declared) -> Compared:
    """The scheme that is declared; every scheme if none is, or if it is another that was stepped.

    The declared one comes first; from the trace's own start, where that makes it agree.
    """
    named = declared.scheme
    first = [] if named is None else [_against(held, declared, named)]
    if named is not None and not first[0].found.agree and _starts_elsewhere(held):
        own = _against(held, declared, named, own_start=True)
        first = [own] if own.found.agree else first
    if first and all(first[0].agrees(channel) for channel in held.error):
        return Compared(first)
    sought = _sought(held, declared, [name for name in USUAL if name != named])
    found = [*first, *sought.schemes]
    if not any(one.found.agree for one in found) and not sought.not_sought:
        others = _sought(held, declared, [name for name in OTHERS if name != named])
        found += [one for one in others.schemes if one.found.agree]
    return replace(sought, schemes=found)


def _sought(held: Measured, declared: Declared, names: list[str]) -> Compared:
    """Of these schemes those that fit the first samples, stepped through the whole trace."""
    steps, count = declared.numbers, min(FIRST_SAMPLES, len(declared.numbers))
    while count > 2 and len(names) * steps[count - 1] > MOST_STEPS_OF_ALL:
        count -= 1
    if len(names) * steps[count - 1] > MOST_STEPS_OF_ALL:
        return Compared([], f"not sought, the trace has {steps[-1]:.0f} steps")
    early = [_against(held, declared, name, count=count) for name in names]
    known = list(held.error)
    channels = [c for c in known if c in ("omega", "attitude")] or known
    fitting = [
        one.scheme
        for one in early
        if any(one.agrees(c) or one.near(c, held.error[c]) for c in channels)
    ]
    if len(fitting) * steps[-1] > MOST_STEPS_OF_ALL:
        few = ", ".join(fitting[:3]) + (f" and {len(fitting) - 3} more" if fitting[3:] else "")
        return Compared(
            [], f"not sought to the end, the trace has {steps[-1]:.0f} steps; {few} fit its first"
        )
    found = [_against(held, declared, name) for name in fitting]
    if _starts_elsewhere(held) and not any(one.found.agree for one in found):
        own = [_against(held, declared, name, own_start=True) for name in fitting]
        found = [one for one in own if one.found.agree] + found
    return Compared(found)


def _starts_elsewhere(held: Measured) -> bool:
    """Whether a first sample at the start of all is not the scenario's state."""
    known = [c for c in ("omega", "attitude") if c in held.error]
    off = any(held.error[c][0] > held.bound[c][0] for c in known)
    return bool(held.trace.times[0] == 0.0 and len(known) == 2 and off)


def _against(
    held: Measured,
    declared: Declared,
    scheme: str,
    own_start: bool = False,
    count: int | None = None,
) -> Comparison:
    """The nearest of the coordinates in which the scheme's steps differ.

    count: of the samples that are compared, the first ones.
    """
    ways: Iterable[Coordinates] = ("com-world",)
    if scheme in SCHEMES:
        known = SCHEMES[scheme].coordinates
        ways = [way for way in distinct(held.case.system) if way in known]
    found = [_stepped(held, declared, scheme, own_start, way, count) for way in ways]
    return min(found, key=lambda one: sum(np.any(one.left[c] > one.bound[c]) for c in one.left))


def _trajectory(
    held: Measured, declared: Declared, scheme: str, start: State, way: Coordinates, rows: slice
) -> tuple[State, Array]:
    """The scheme's states at the samples, and how rounding grows along them."""
    numbers = declared.numbers[rows].astype(int)
    every = reduce(gcd, (int(n) for n in numbers), 0) or 1
    plan = Steps(declared.timestep, int(numbers[-1]), every)
    system = held.case.system
    if scheme in SCHEMES:
        run = companion(system, start, scheme, held.rate, [plan], way)[0]
        return part_of(run.state, numbers // every), run.growth[numbers // every]
    how = (declared.timestep, plan.steps, every, declared.angles)
    state = step_flight(FLIGHT_SCHEMES[scheme], system, start, *how)
    growth = growth_along(system, plan.times, state, held.rate)
    return part_of(state, numbers // every), growth[numbers // every]


def _stepped(
    held: Measured,
    declared: Declared,
    scheme: str,
    own_start: bool,
    way: Coordinates,
    count: int | None,
) -> Comparison:
    rows, yardstick, start = slice(count), held.truth.yardstick, held.case.initial
    digits = {channel: values[rows] for channel, values in held.values_open.items()}
    if own_start:
        start = part_of(held.state, 0)
        start = replace(start, orientation=normalize(start.orientation))
    # A scheme that blows up at this step is infinitely far off.
    with np.errstate(all="ignore"):
        state, growth = _trajectory(held, declared, scheme, start, way, rows)
        rounding = yardstick.round_off(declared.timestep, declared.numbers[rows], growth)
        bound = joined(rounding, digits)
        if own_start:
            bound = joined(bound, _start_open(digits, growth))
        own = filled(held.trace.at(rows), state)
        left = {c: distance(held.truth, held.trace, c, own, state) for c in held.error}
        spins = {c: left[c] for c in left if c in ("omega", "attitude")} or left
        still = dict.fromkeys(("omega", "attitude"), np.zeros(len(growth)))
        found = likeness({**still, **spins}, bound)
    return Comparison(scheme, left, bound, found, own_start)


def _start_open(digits: Rounding, growth: Array) -> Rounding:
    """What the digits of the first sample become: in omega and attitude they grow."""
    start = growth * (digits["omega"][0] + digits["attitude"][0])
    still = {c: np.full(len(growth), values[0]) for c, values in digits.items()}
    return {**still, "omega": start, "attitude": start}
