"""A trace whose step, or scheme and step, is declared, compared with the reference's schemes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import reduce
from math import gcd

import numpy as np

from omegadot.commands.score.exact_trajectory import Rounding, joined, part_of
from omegadot.commands.score.measured import Measured, distance
from omegadot.commands.score.trace import Trace
from omegadot.gates.likeness import Likeness, likeness
from omegadot.gates.scales import EPS
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.companion import Steps, companion
from omegadot.reference_impl.coordinates import Coordinates, distinct
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array

MOST_STEPS = 1_000_000
# All schemes are stepped only where that takes seconds, not minutes.
MOST_STEPS_OF_ALL = 10_000


@dataclass(frozen=True)
class Declared:
    """How a trace was made, as declared. numbers: (n,), the steps that its samples stand at."""

    scheme: str | None
    timestep: float
    numbers: Array


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


def declared_of(trace: Trace, scheme: str | None, timestep: float | None) -> Declared | None:
    """The declaration, if there is one and it can be. Raises UsageError."""
    if scheme is not None and scheme not in SCHEMES:
        raise UsageError(
            f"--integrator-scheme {scheme}: there is no such scheme; {nearest(scheme, SCHEMES)}."
        )
    if timestep is None:
        if scheme is not None:
            raise UsageError(f"--integrator-scheme {scheme}: its step is missing; give --timestep.")
        return None
    if not (np.isfinite(timestep) and timestep > 0.0):
        raise UsageError(f"--timestep {timestep:g}: not a positive number of seconds; give one.")
    ratio = trace.times / timestep
    numbers = np.round(ratio)
    # A stamp is off by its digits at most, and by the rounding of a sum of so many steps.
    allowed = trace.open["times"] / timestep + 4 * EPS * np.maximum(ratio, 1) ** 2
    off = np.abs(ratio - numbers)
    worst = int(np.argmax(off - allowed))
    if off[worst] > allowed[worst] or numbers[0] < 0.0:
        raise UsageError(
            f"--timestep {timestep:g}: the sample at {trace.times[worst]:.9g} s stands at no whole "
            "number of steps; give the step that the simulator took."
        )
    if numbers[-1] > MOST_STEPS:
        raise UsageError(
            f"--timestep {timestep:g}: makes {numbers[-1]:.0f} steps; give at most {MOST_STEPS:,}."
        )
    return Declared(scheme, timestep, numbers)


def compare_schemes(held: Measured, declared: Declared) -> list[Comparison]:
    """The scheme that is declared; every scheme if none is, or if it is another that was stepped.

    The declared one comes first; from the trace's own start, where that makes it agree.
    """
    named = declared.scheme
    first = [] if named is None else [_against(held, declared, named)]
    if named is not None and not first[0].found.agree and _starts_elsewhere(held):
        own = _against(held, declared, named, own_start=True)
        first = [own] if own.found.agree else first
    if (first and first[0].found.agree) or declared.numbers[-1] > MOST_STEPS_OF_ALL:
        return first
    return first + [_against(held, declared, name) for name in SCHEMES if name != named]


def _starts_elsewhere(held: Measured) -> bool:
    """Whether a first sample at the start of all is not the scenario's state."""
    known = [c for c in ("omega", "attitude") if c in held.error]
    off = any(held.error[c][0] > held.bound[c][0] for c in known)
    return bool(held.trace.times[0] == 0.0 and len(known) == 2 and off)


def _against(
    held: Measured, declared: Declared, scheme: str, own_start: bool = False
) -> Comparison:
    """The nearest of the coordinates in which the scheme's steps differ."""
    ways = [way for way in distinct(held.case.system) if way in SCHEMES[scheme].coordinates]
    found = [_stepped(held, declared, scheme, own_start, way) for way in ways]
    return min(found, key=lambda one: sum(np.any(one.left[c] > one.bound[c]) for c in one.left))


def _stepped(
    held: Measured, declared: Declared, scheme: str, own_start: bool, way: Coordinates
) -> Comparison:
    numbers, yardstick = declared.numbers.astype(int), held.truth.yardstick
    every = reduce(gcd, (int(n) for n in numbers), 0) or 1
    plan = [Steps(declared.timestep, int(numbers[-1]), every)]
    start = held.case.initial
    if own_start:
        start = part_of(held.state, 0)
        start = replace(start, orientation=normalize(start.orientation))
    # A scheme that blows up at this step is infinitely far off.
    with np.errstate(over="ignore", invalid="ignore"):
        run = companion(held.case.system, start, scheme, held.rate, plan, way)[0]
        rows = numbers // every
        state, growth = part_of(run.state, rows), run.growth[rows]
        rounding = yardstick.round_off(declared.timestep, declared.numbers, growth)
        bound = joined(rounding, held.digits)
        if own_start:
            bound = joined(bound, _start_open(held.digits, growth))
        left = {c: distance(held.truth, held.trace, c, held.state, state) for c in held.error}
        spins = {c: left[c] for c in left if c in ("omega", "attitude")} or left
        still = dict.fromkeys(("omega", "attitude"), np.zeros(len(rows)))
        found = likeness({**still, **spins}, bound)
    return Comparison(scheme, left, bound, found, own_start)


def _start_open(digits: Rounding, growth: Array) -> Rounding:
    """What the digits of the first sample become: in omega and attitude they grow."""
    start = growth * (digits["omega"][0] + digits["attitude"][0])
    still = {c: np.full(len(growth), values[0]) for c, values in digits.items()}
    return {**still, "omega": start, "attitude": start}
