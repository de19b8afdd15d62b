"""Runs of whose samples single fields are those of the step before or after; the others are right.

From samples that are of two steps no scheme leads on, so the runs are stepped from their starts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.ends.last_fields import FIELDS, ROTATION, SHIFTS
from omegadot.diagnosis.stepping.ends.moved_samples import Moved
from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

LEAST = 3  # scenarios that show it
SAMPLES, MOST_STEPS = 4, 32  # of each run that is stepped, and between two of its samples
NAMES = dict(
    zip(CHANNELS, ("angular_velocity", "orientation", "linear_velocity", "position"), strict=True)
)


@dataclass(frozen=True)
class _Law:
    """fields: of `CHANNELS`, of the step so many further."""

    fields: tuple[str, ...]
    shift: int
    statement: str


NOTHING = _Law((), 0, "")


def lagging_fields(integrator: Integrator, kept: Sequence[KeptRun]) -> Moved | None:
    """Which fields of every sample are of another step; None where none are, or others in a run."""
    shown = _one_each([run for run in kept if run.fails])
    if len(shown) < LEAST or integrator.knob != "timestep":
        return None
    sound = _one_each([run for run in kept if not run.fails])[:LEAST]
    with np.errstate(all="ignore"):
        for by in _schemes(integrator):
            stepped = _stepped(shown[:LEAST], by)
            if any(_is_made(run, own, NOTHING) for run, own in stepped):
                continue
            for law in _laws():
                if not all(_is_made(run, own, law) for run, own in stepped):
                    continue
                every = [(run, _is_made(run, own, law)) for run, own in _stepped(shown, by)]
                if all(_is_made(run, own, law) for run, own in _stepped(sound, by)):
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
            SchemeOf(one, "com-world") for one in SCHEMES.values() if "com-world" in one.coordinates
        ]
    known = SCHEMES.get(integrator.scheme)
    return [SchemeOf(known, integrator.coordinates)] if known is not None else []


def _laws() -> Iterator[_Law]:
    for (fields, (what, are)), (shift, where) in product(FIELDS.items(), SHIFTS):
        text = f"the {what} of every sample after the start {are} of the step {where} its time"
        yield _Law(fields, shift, text)


def _stepped(runs: Sequence[KeptRun], by: SchemeOf) -> list[tuple[KeptRun, State]]:
    """With every step of the first samples, and one more."""
    found = []
    for run in runs:
        steps = int(run.sweep.sample_steps[_count(run)]) + 1
        plan = (run.sweep.timestep, steps, 1, by.coordinates)
        found.append((run, step_body(by.scheme, run.system, run.state[0], *plan)[1]))
    return found


def _count(run: KeptRun) -> int:
    return min(SAMPLES, len(run.times) - 1)


def _is_made(run: KeptRun, stepped: State, law: _Law) -> bool:
    """Whether the first samples are these steps, with some fields of other steps."""
    count = _count(run)
    at = run.sweep.sample_steps[1 : count + 1]
    other = {NAMES[channel] for channel in law.fields}
    ends = State(
        **{
            name: values[at + law.shift if name in other else at]
            for name, values in vars(stepped).items()
        }
    )
    apart = run.apart(ends, count)
    pivoted = run.system.load.pivot is not None  # then attitude and omega make the others
    return all(
        bool(np.all(norm(apart[c]) <= SLACK * np.cumsum(run.bounds[c][:count])))
        for c in (ROTATION if pivoted else CHANNELS)
    )
