"""An implicit term that has the length of another step than the one that is taken, in all runs.

A linearly implicit step is ``(1 - g J) dv = h vdot`` with g = h. Its factor may be kept of a run
before, with that one's g, or be one of a fixed length. As steps vanish such a g stays, so that
their equation looks like one with more inertia: an armature of g times the damping.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, scheme_of
from omegadot.diagnosis.stepping.turns.implicit_factors import TERMS, follow, linear, rates, reached
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.diagnosis.wording.digits import number
from omegadot.diagnosis.wording.kinds import either

MOST_STEPS = 16  # between two samples


@dataclass(frozen=True)
class OtherLengths:
    """statement: of which run the length is.  names: of the scenarios that this explains."""

    statement: str
    names: frozenset[str]


@dataclass(frozen=True)
class _Seen:
    """Of one scenario: its runs, steps as they vanish, and lengths as they were requested."""

    name: str
    runs: tuple[KeptRun, ...]
    steps: VanishingSteps | None
    requested: tuple[float, ...]


def other_lengths(
    integrator: Integrator,
    steps: Mapping[str, VanishingSteps],
    kept: Sequence[KeptRun],
    requested: Mapping[str, Sequence[float]],
) -> OtherLengths | None:
    """The run whose length makes every interval of all runs, and all steps as they vanish.

    requested: by scenario, the lengths of runs in the order in which they were requested.  None
    where no length does, or each run's own.
    """
    with np.errstate(all="ignore"):
        if integrator.scheme not in (None, *TERMS) or not _any_wrong(steps):
            return None
        by = scheme_of(integrator, kept)
        if by is None or by.scheme.name not in TERMS:
            return None
        every = list[_Seen]()
        for name, own in steps.items():
            runs = tuple(r.short for r in kept if r.name == name and r.sweep.every <= MOST_STEPS)
            every.append(_Seen(name, runs, own, tuple(requested.get(name, ()))))
        wrong = [one for one in every if not _made(one, by, None)]
        texts = [*_of_first(by, every, wrong), *_of_fixed(by, every, wrong)]
        names = frozenset(one.name for one in wrong)
        return OtherLengths(either(texts)[0], names) if texts else None


def _any_wrong(steps: Mapping[str, VanishingSteps]) -> bool:
    """Steps that vanish have that length still."""
    return any(not np.all(one.evidence.sound) for one in steps.values() if one.turns)


def _of_first(by: SchemeOf, every: Sequence[_Seen], wrong: Sequence[_Seen]) -> Iterator[str]:
    known = all(one.requested and _made(one, by, one.requested[0]) for one in every)
    if wrong and known:
        yield (
            f"{TERMS[by.scheme.name][0]} has the step's length of another run of the same system: "
            "of the first one, in all runs after it"
        )


def _of_fixed(by: SchemeOf, every: Sequence[_Seen], wrong: Sequence[_Seen]) -> Iterator[str]:
    """One length in all runs, by the steps of the first scenario that shows it."""
    found = next((g for one in wrong if (g := _fitted(one, by)) is not None), None)
    if found is not None and all(_made(one, by, found) for one in every):
        what = TERMS[by.scheme.name][0]
        yield f"{what} has the length of one and the same step in every run, {number(found)} s"


def _made(one: _Seen, by: SchemeOf, g: float | None) -> bool:
    """Whether this length, or else each step's own, leads from every sample to the next.

    And whether steps as they vanish follow the equation with it.
    """
    if one.steps is not None and not np.all(follow(one.steps, by, 0.0 if g is None else g)):
        return False
    return all(bool(np.all(reached(run, by, g))) for run in one.runs)


def _fitted(one: _Seen, by: SchemeOf) -> float | None:
    """s, by least squares of all that is linear in it: ``a' - a = g J a'`` of rates a'."""
    parts = [(r.system, r.state[:-1], *rates(r)) for r in one.runs if r.sweep.every == 1]
    if one.steps is not None:
        seen = one.steps.evidence
        parts.append((seen.system, seen.states, seen.found.angular, seen.angular_bound))
    above, below = 0.0, 0.0
    for system, states, found, bound in parts:
        a, jacobian = linear(system, states, by)
        line, off = (jacobian @ found[..., None])[..., 0], found - a
        weight = np.where(np.isfinite(bound) & (bound > 0.0), bound, np.inf)[:, None] ** -2.0
        above += float(np.sum(weight * line * off))
        below += float(np.sum(weight * line * line))
    found_at = above / below if below > 0.0 else np.nan
    return found_at if np.isfinite(found_at) and found_at > 0.0 else None
