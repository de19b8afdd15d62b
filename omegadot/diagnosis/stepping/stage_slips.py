"""A slip in single stages of a scheme: of all that are known, the one that makes every run.

A run is stepped from its start with one change a lane. The change that makes the samples within
rounding, in every run in which it acts, is named where no known scheme, or slip in one, makes them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT, scheme_named
from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.slips import OF_SCHEME, slipped
from omegadot.diagnosis.stepping.stage_changes import Change, changes_of
from omegadot.diagnosis.stepping.staged_steps import STAGED, staged_run
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import to_coordinates
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

MORE = 6  # samples, after the first that the scheme misses
MOST_STEPS = 48  # of a run, that are stepped again
EXPLAINS = 0.8  # of the runs that fail
LEAST_RUNS = 3  # of which one shows a mistake that is made in every run
Lanes = NDArray[np.bool_]


@dataclass(frozen=True)
class _Beginning:
    """The first samples of a run. first: how many the scheme makes.  count: that are looked at."""

    run: KeptRun
    name: str
    first: int
    count: int

    def made(self, changes: Sequence[Change], count: int) -> tuple[Lanes, Lanes]:
        """Of each change, whether it makes the first samples, and whether it acts in them."""
        apart = self.run.apart(_ends(self.run, self.name, changes, count), count)
        bounds = {c: SLACK * self.run.bounds[c][:count] for c in CHANNELS}
        good = [norm(apart[c]) <= bounds[c] for c in CHANNELS]
        acts = [~(norm(apart[c] - apart[c][:1]) <= bounds[c]) for c in CHANNELS]
        return np.all(good, axis=(0, 2))[1:], np.any(acts, axis=(0, 2))[1:]

    def made_by(self, scheme: Scheme) -> bool:
        """Whether another scheme makes the first samples."""
        run, every = self.run, self.run.sweep.every
        plan = (run.sweep.timestep, self.count * every, every)
        _, found = step_body(scheme, run.system, run.state[0], *plan)
        apart = run.apart(found[1:], self.count)
        return all(
            bool(np.all(norm(apart[c]) <= SLACK * run.bounds[c][: self.count])) for c in CHANNELS
        )


def stage_slips(
    integrator: Integrator, by: SchemeOf | None, runs: Sequence[KeptRun], least: int = LEAST_RUNS
) -> list[str]:
    """The change in some stages that makes all runs; none where none does, or too many do.

    by: the scheme that is declared or found. Where none is declared, and this one has no such
    change, the others of the order that is declared are tried.
    """
    own = [by.scheme.name] if by is not None and by.scheme.name in STAGED else []
    found = [text for name in own for text in _of_scheme(name, runs, least)]
    if not found and integrator.scheme is None:
        order = integrator.orders.get("omega")
        others = [n for n in STAGED if order in (None, scheme_named(n).orders["omega"])]
        every = (_of_scheme(name, runs, least) for name in others if name not in own)
        found = [text for texts in every for text in texts]
    return either(found) if len(found) <= MOST_NAMED else []


def _of_scheme(name: str, runs: Sequence[KeptRun], least: int) -> list[str]:
    short = sorted(
        (run for run in runs if run.sweep.every <= MOST_STEPS), key=lambda run: run.sweep.every
    )
    failing = (_beginning(run, name) for run in short if run.fails)
    missed = (one for one in failing if one.first < one.count)
    first = next(missed, None)
    if first is None:
        return []
    changes = changes_of(len(STAGED[name][0]))
    good, _ = first.made(changes, first.first + 1)  # which rules out nearly all
    left = [change for change, fits in zip(changes, good, strict=True) if fits]
    shown = [first, *missed] if left else []
    if len(shown) < least:
        return []
    sound = [_beginning(run, name) for run in short if not run.fails]
    best = _making(left, shown, sound)
    if not best or any(_known(name, shown)):
        return []
    return [f"in the steps of {name}, {one.text}" for one in best]


def _making(
    changes: Sequence[Change], shown: Sequence[_Beginning], sound: Sequence[_Beginning]
) -> list[Change]:
    """Those that make every run in which they act, and the most of those that fail."""
    counts = dict.fromkeys(changes, 0)
    for one in (*shown, *sound):
        if not counts:
            return []
        good, acts = one.made([*counts], one.count)
        pairs = zip(counts.items(), good, acts, strict=True)
        counts = {c: n + bool(g and one.run.fails) for (c, n), g, a in pairs if g or not a}
    most = max(counts.values(), default=0)
    if most < EXPLAINS * len(shown):
        return []
    best = [change for change, count in counts.items() if count == most]
    return [one for one in best if not any(_states_less(other, one) for other in best)]


def _states_less(one: Change, other: Change) -> bool:
    """Whether it changes a part of the other's slots in the same way."""
    if one.sources != other.sources:
        return False
    later = one.slots == other.slots and other.cold and not one.cold
    return later or {*one.slots} < {*other.slots}


def _known(name: str, shown: Sequence[_Beginning]) -> Iterator[Scheme]:
    """Schemes, and known slips in the one of this name, that make all runs."""
    names = [name] if name in OF_SCHEME else []
    known = [*SCHEMES.values(), *EXPLICIT.values()]
    known += [scheme for one in names for scheme in slipped(one).values()]
    for one in shown:
        known = [scheme for scheme in known if one.made_by(scheme)]
        if not known:
            break
    yield from known


def _beginning(run: KeptRun, name: str) -> _Beginning:
    count = min(max(1, MOST_STEPS // run.sweep.every), len(run.times) - 1)
    whole = _Beginning(run, name, count, count)
    apart = run.apart(_ends(run, name, [], count), count)
    good = np.all([norm(apart[c]) <= SLACK * run.bounds[c][:count] for c in CHANNELS], axis=0)[0]
    if good.all():
        return whole
    first = int(np.argmin(good))
    return _Beginning(run, name, first, min(first + MORE, count))


def _ends(run: KeptRun, name: str, changes: Sequence[Change], count: int) -> State:
    """(1 + changes, count, ...): by the scheme, then by it with each of the changes."""
    own = Change((), (1.0,) * len(STAGED[name][0]), "")
    q, v = to_coordinates(run.system, run.state[0], "com-world")
    plan = (run.sweep.timestep, run.sweep.every, count)
    return staged_run(run.system, name, [own, *changes], (q, v), plan)
