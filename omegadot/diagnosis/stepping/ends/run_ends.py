"""Runs whose last sample is the state of another step, or by another scheme; others are right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import (
    CHANNELS,
    MOST_STEPS,
    SLACK,
    KeptRun,
    SchemeOf,
    bounds_of_samples,
    plain_names,
    scheme_of,
)
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Sweep
from omegadot.gates.truth import Truth
from omegadot.reference_impl.rotations import normalize, rotation_between
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.scheme import Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

MISSING = "the last step is missing: the end is the state one step before"
EVERY = "the last sample of every run is the state {} its time"
OTHER = "the last step of every run is by {}, not by {}"
OF_FIELD = "the {} of the last sample of every run {} of the step {} its time"
FIELDS: Mapping[tuple[str, ...], tuple[str, str]] = {
    ("attitude",): ("attitude", "is that"),
    ("omega",): ("omega", "is that"),
    ("position",): ("position", "is that"),
    ("velocity",): ("linear velocity", "is that"),
    ("attitude", "position"): ("attitude and position", "are those"),
    ("omega", "velocity"): ("omega and linear velocity", "are those"),
    ("position", "velocity"): ("position and linear velocity", "are those"),
    ("omega", "attitude"): ("omega and attitude", "are those"),
}
SHORT = "the last sample, after an interval shorter than the others, is the state {} its time"
MOST_SHIFT = 3  # steps
COUNTS = ("", "one step", "two steps", "three steps")
ROTATION = ("omega", "attitude")
LEAST = 3  # runs, of two scenarios at least, whose last sample is another step's


@dataclass(frozen=True)
class RunEnd:
    """The last two samples of a run (2, ...), with as many steps between them.

    bounds: per channel, what rounding may do there.  fails: whether the run fails a gate.
    """

    name: str
    system: System
    sweep: Sweep
    state: State
    steps: int
    bounds: dict[str, float]
    fails: bool

    @property
    def is_short(self) -> bool:
        """Whether its last interval is shorter than the others."""
        return self.steps < self.sweep.every


@dataclass(frozen=True)
class Ends:
    """statement: what the last sample of runs is.  names: of the scenarios that this explains."""

    statement: str
    names: frozenset[str]


def run_end(
    name: str, truth: Truth, sweep: Sweep, state: State, growth: Array, fails: bool
) -> RunEnd | None:
    """None where a sample is not finite, or too many steps lie between the two."""
    numbers, last = sweep.sample_steps, slice(-2, None)
    finite = all(bool(np.isfinite(f[last]).all()) for f in vars(state).values())
    if sweep.accuracy is not None or len(numbers) < 2 or not finite:
        return None
    steps = int(numbers[-1] - numbers[-2])
    if steps > MOST_STEPS:
        return None
    each = bounds_of_samples(truth, sweep, growth, last)
    bounds = {channel: float(values[-1]) for channel, values in each.items()}
    kept = State(*(np.array(f[last]) for f in vars(state).values()))
    return RunEnd(name, truth.yardstick.system, sweep, kept, steps, bounds, fails)


def other_ends(
    integrator: Integrator, ends: Sequence[RunEnd], kept: Sequence[KeptRun]
) -> Ends | None:
    """Which other step the last sample of all runs is of, or by which other scheme the last step.

    None where one is not, or where none is.
    """
    with np.errstate(all="ignore"):
        by = scheme_of(integrator, kept) if any(one.fails for one in ends) else None
        if by is None:
            return None
        shifts = [sign * k for k in range(1, MOST_SHIFT + 1) for sign in (1, -1)]
        for short in (False, True):
            for shift in shifts:
                shown = _shown(ends, by, shift, short)
                if shown:
                    names = frozenset(shown - _wrong_before(kept, by))
                    return Ends(statement_of(shift, short), names)
        for fields, (what, are) in FIELDS.items():
            for shift, where in ((-1, "before"), (1, "after")):
                shown = _shown(ends, by, shift, False, of=fields)
                if shown:
                    text = OF_FIELD.format(what, are, where)
                    return Ends(text, frozenset(shown - _wrong_before(kept, by)))
        others = [one for one in SCHEMES.values() if by.coordinates in one.coordinates]
        shows = {one.name: _shown(ends, by, 0, False, one) for one in others if one != by.scheme}
        shows = {name: shown for name, shown in shows.items() if shown}
        plain = plain_names([*shows])
        if not plain:
            return None
        text = OTHER.format(" or ".join(plain), by.scheme.name)
        return Ends(text, frozenset(shows[plain[0]] - _wrong_before(kept, by)))


def statement_of(shift: int, short: bool) -> str:
    """Which step the last sample is of. short: of runs alone whose last interval is shorter."""
    if shift == -1 and not short:
        return MISSING
    off = f"{COUNTS[abs(shift)]} {'further than' if shift > 0 else 'before'}"
    return (SHORT if short else EVERY).format(off)


def _shown(
    ends: Sequence[RunEnd],
    by: SchemeOf,
    shift: int,
    short: bool,
    last: Scheme | None = None,
    of: Sequence[str] = CHANNELS,
) -> set[str]:
    """The scenarios that show it; none where one run contradicts it.

    last: the scheme of the last step.  of: what is of another step.
    """
    names, count = set[str](), 0
    # of the runs that fail those of few steps rule most out
    for end in sorted(ends, key=lambda one: (not one.fails, one.steps)):
        moved = end.is_short or not short
        rest = [channel for channel in CHANNELS if channel not in of]
        if rest and end.system.load.pivot is not None:  # attitude and omega make the others
            rest, of_this = ([c for c in some if c in ROTATION] for some in (rest, of))
        else:
            of_this = [*of]
        if not _is_after(end, by, end.steps + shift * moved, last, of_this):
            return set()
        if rest and not _is_after(end, by, end.steps, None, rest):
            return set()
        if moved and not _is_after(end, by, end.steps):
            names.add(end.name)
            count += 1
    return names if count >= LEAST and len(names) > 1 else set()


def _is_after(
    end: RunEnd,
    by: SchemeOf,
    steps: int,
    last: Scheme | None = None,
    of: Sequence[str] = CHANNELS,
) -> bool:
    """Whether so many steps of the scheme lead from the sample before to the last.

    Below none they lead from the last to the one before. last: the scheme of the last of them.  of:
    what of the state is compared.
    """
    start, came = (end.state[:1], end.state[1:])[:: -1 if steps < 0 else 1]
    steps = abs(steps)
    unit = State(**{**vars(start), "orientation": normalize(start.orientation)})
    own = ((by.scheme, steps),) if last is None else ((by.scheme, steps - 1), (last, 1))
    found = unit
    for scheme, count in own:
        plan = (end.sweep.timestep, count, max(count, 1), by.coordinates)
        found = step_body(scheme, end.system, found, *plan)[1][-1]
    apart = {
        "omega": came.angular_velocity - found.angular_velocity,
        "attitude": rotation_between(found.orientation, came.orientation),
        "velocity": came.linear_velocity - found.linear_velocity,
        "position": came.position - found.position,
    }
    return all(bool(norm(apart[c])[0] <= SLACK * end.bounds[c]) for c in of)


def _wrong_before(kept: Sequence[KeptRun], by: SchemeOf) -> set[str]:
    """Scenarios of which a failed run is wrong before its last sample as well."""
    found = set[str]()
    for run in (run.short for run in kept if run.fails):
        if run.name not in found:
            whole = len(run.times) == len(run.sweep.times)
            sound = run.sound(by)
            if not (sound[:-1] if whole else sound).all():
                found.add(run.name)
    return found
