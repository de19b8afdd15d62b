"""Attitudes of all samples that go through another convention on their way out; steps are sound.

Where steps of no length lead, from many states of all scenarios, shows the convention. Runs that
are stepped from the state given, and read out so, are then the samples reported.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.models.attitude_misread import attitude_misread
from omegadot.diagnosis.models.attitudes_read import IN_RUNS
from omegadot.diagnosis.stepping.ends.start_rules import (
    KNOWN_TO,
    convention_of_attitudes,
    same_start,
)
from omegadot.diagnosis.stepping.kept_run import SLACK, KeptRun, SchemeOf, scheme_of
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State

RUNS = 2  # of a scenario, that are stepped again


@dataclass(frozen=True)
class ReadOut:
    """statement: how attitudes are read.  names: of the scenarios that this explains."""

    statement: str
    names: frozenset[str]


def samples_read(
    integrator: Integrator,
    steps: Mapping[str, VanishingSteps],
    given: Mapping[str, State],
    kept: Sequence[KeptRun],
) -> ReadOut | None:
    """The convention through which attitudes of samples go; None without one.

    steps and given: by scenario, first steps from many states, and the state that its runs are
    given.
    """
    with np.errstate(all="ignore"):
        text = convention_of_attitudes([*steps.values()])
        by = scheme_of(integrator, kept) if text else None
        if by is None:
            return None
        jumping = {
            name
            for name, one in steps.items()
            if not same_start(one, "orientation", one.states.orientation).all()
        }
        names = _held(text, by, jumping, given, [run for run in kept if run.name in given])
    return ReadOut(f"{IN_RUNS}{text}", frozenset(names)) if names else None


def _held(
    text: str,
    by: SchemeOf,
    jumping: set[str],
    given: Mapping[str, State],
    kept: Sequence[KeptRun],
) -> set[str]:
    """The scenarios that show it: runs are sound in all but attitudes, and these are read so."""
    looked, wrong, shown = Counter[str](), set[str](), set[str]()
    pairs = list[tuple[str, Array, Array]]()
    for run in sorted((run for run in kept if run.fails), key=lambda run: run.sweep.every):
        if looked[run.name] >= RUNS or run.name in wrong:
            continue
        looked[run.name] += 1
        own = _stepped(run, by, given[run.name])
        if not _is_sound_beside(run, own):
            wrong.add(run.name)
            continue
        # the start may be logged as it was given
        right, came = own.orientation[1:], run.state.orientation[1:]
        bound = SLACK * run.bounds["attitude"]
        known = bound <= KNOWN_TO
        pairs.append((run.name, right[known], came[known]))
        off = attitude_angle(right, came) > bound
        if np.any(off & known) or attitude_misread(right, came, float(np.max(bound))) == text:
            shown.add(run.name)
    pairs = [one for one in pairs if one[0] not in wrong]
    if not pairs:
        return set()
    right, came = (np.concatenate([one[k] for one in pairs]) for k in (1, 2))
    if attitude_misread(right, came, KNOWN_TO) != text:
        return set()
    return (jumping | shown) - wrong


def _stepped(run: KeptRun, by: SchemeOf, given: State) -> State:
    """Its samples (n, ...) by the scheme, from the state given."""
    every = run.sweep.every
    plan = (run.sweep.timestep, every * (len(run.times) - 1), every, by.coordinates)
    return step_body(by.scheme, run.system, given, *plan)[1]


def _is_sound_beside(run: KeptRun, own: State) -> bool:
    """Whether all but the attitudes is as stepped; a pivoted body's place follows from these."""
    fields = {"omega": "angular_velocity"}
    if run.system.load.pivot is None:
        fields |= {"velocity": "linear_velocity", "position": "position"}
    apart = {c: norm(getattr(run.state, f) - getattr(own, f))[1:] for c, f in fields.items()}
    return all(bool(np.all(off <= SLACK * run.bounds[c])) for c, off in apart.items())
