"""Runs of whose samples single fields are those of the step before or after; the others are right.

So it may be of the first sample alone, or of all but this one.
From samples that are of two steps no scheme leads on, so the runs are stepped from their starts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.ends.last_fields import FIELDS, ROTATION, SHIFTS
from omegadot.diagnosis.stepping.ends.moved_samples import Moved
from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.schemes import COMMON, SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

LEAST = 3  # scenarios that show it
SAMPLES, MOST_STEPS = 4, 32  # of each run that is stepped, and between two of its samples
NAMES = dict(
    zip(CHANNELS, ("angular_velocity", "orientation", "linear_velocity", "position"), strict=True)
)


@dataclass(frozen=True)
class _Law:
    """fields: of `CHANNELS`, of the step so many further.  first: in the first sample alone."""

    fields: tuple[str, ...]
    shift: int
    statement: str
    first: bool = False


NOTHING = _Law((), 0, "")


def lagging_fields(
    integrator: Integrator, kept: Sequence[KeptRun], given: Mapping[str, State]
) -> Moved | None:
    """Which fields of samples are of another step; None where none are, or others in a run.

    given: by scenario, the state that its runs are given.
    """
    shown = _one_each([run for run in kept if run.fails])
    if len(shown) < LEAST or integrator.knob != "timestep":
        return None
    sound = _one_each([run for run in kept if not run.fails])[:LEAST]
    with np.errstate(all="ignore"):
        for by in _schemes(integrator):
            stepped = _stepped(shown[:LEAST], by, given)
            if any(_is_made(run, own, NOTHING) for run, own in stepped):
                continue
            for law in _laws():
                if not all(_is_made(run, own, law) for run, own in stepped):
                    continue
                every = [(run, _is_made(run, own, law)) for run, own in _stepped(shown, by, given)]
                if all(_is_made(run, own, law) for run, own in _stepped(sound, by, given)):
                    return Moved(law.statement, frozenset(run.name for run, made in every if made))
    return None


def _one_each(runs: Sequence[KeptRun]) -> list[KeptRun]:
    """Of each scenario the run of the fewest steps between two samples, the fewest of all first."""
    found: dict[str, KeptRun] = {}
    for run in sorted(runs, key=lambda run: run.sweep.every):
        if run.sweep.every <= MOST_STEPS and len(run.times) > 2:
            found.setdefault(run.name, run)
    return [*found.values()]


def _schemes(integrator: Integrator) -> list[SchemeOf]:
    if integrator.scheme is None:
        return [
            SchemeOf(one, "com-world") for one in COMMON.values() if "com-world" in one.coordinates
        ]
    known = SCHEMES.get(integrator.scheme)
    return [SchemeOf(known, integrator.coordinates)] if known is not None else []


def _laws() -> Iterator[_Law]:
    for (fields, (what, are)), (shift, where) in product(FIELDS.items(), SHIFTS):
        text = f"the {what} of every sample after the start {are} of the step {where} its time"
        yield _Law(fields, shift, text)
    for fields, (what, are) in FIELDS.items():
        text = f"the {what} of the first sample, at the start, {are} of after the first step"
        yield _Law(fields, 1, text, first=True)


def _stepped(
    runs: Sequence[KeptRun], by: SchemeOf, given: Mapping[str, State]
) -> list[tuple[KeptRun, State]]:
    """With every step of the first samples, and one more, from the state that was given."""
    found = []
    for run in runs:
        steps = int(run.sweep.sample_steps[_count(run)]) + 1
        plan = (run.sweep.timestep, steps, 1, by.coordinates)
        start = given.get(run.name, run.state[0])
        found.append((run, step_body(by.scheme, run.system, start, *plan)[1]))
    return found


def _count(run: KeptRun) -> int:
    return min(SAMPLES, len(run.times) - 1)


def _is_made(run: KeptRun, stepped: State, law: _Law) -> bool:
    """Whether the first samples are these steps, with some fields of other steps."""
    count = _count(run)
    at = run.sweep.sample_steps[: count + 1]
    moved = at + law.shift * ((np.arange(count + 1) == 0) == law.first)
    other = {NAMES[channel] for channel in law.fields}
    made = State(
        **{name: values[moved if name in other else at] for name, values in vars(stepped).items()}
    )
    # the first sample is held to what is given as the others are to the steps from there
    samples = (np.concatenate((f[:1], f[: count + 1])) for f in vars(run.state).values())
    apart = replace(run, state=State(*samples)).apart(made)
    pivoted = run.system.load.pivot is not None  # then attitude and omega make the others
    return all(
        bool(np.all(norm(apart[c]) <= SLACK * np.cumsum(run.bounds[c][[0, *range(count)]])))
        for c in (ROTATION if pivoted else CHANNELS)
    )
