"""A slip in single stages of a scheme: of all that are known, the one that makes every run.

A run is stepped from its start with one change a lane. The change that makes the samples within
rounding, in every run in which it acts, is named where no known scheme, or slip in one, makes them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT, scheme_named
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.slips.beginnings import MOST_STEPS, Beginning, beginning
from omegadot.diagnosis.stepping.slips.slips import OF_SCHEME, slipped
from omegadot.diagnosis.stepping.slips.stage_changes import Change, changes_of
from omegadot.diagnosis.stepping.slips.staged_steps import STAGED
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.reference_impl.schemes import COMMON, Scheme

EXPLAINS = 0.8  # of the runs that fail
LEAST_RUNS = 3  # of which one shows a mistake that is made in every run


def stage_slips(integrator: Integrator, by: SchemeOf | None, runs: Sequence[KeptRun]) -> list[str]:
    """The change in some stages that makes all runs; none where none does, or too many do.

    by: the scheme that is declared or found. Where none is declared, and this one has no such
    change, the others of the order that is declared are tried.
    """
    own = [by.scheme.name] if by is not None else []
    found = [text for name in own for text in slips_in_stages(name, runs)]
    if not found and integrator.scheme is None:
        order = integrator.orders.get("omega")
        others = [n for n in STAGED if order in (None, scheme_named(n).orders["omega"])]
        every = (slips_in_stages(name, runs) for name in others if name not in own)
        found = [text for texts in every for text in texts]
    return either(found) if len(found) <= MOST_NAMED else []


def slips_in_stages(name: str, runs: Sequence[KeptRun], least: int = LEAST_RUNS) -> list[str]:
    """The changes in some stages of this scheme of which each makes all runs; often none."""
    if name not in STAGED:
        return []
    short = sorted(
        (run for run in runs if run.sweep.every <= MOST_STEPS), key=lambda run: run.sweep.every
    )
    failing = (beginning(run, name) for run in short if run.fails)
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
    sound = [beginning(run, name) for run in short if not run.fails]
    best = _making(left, shown, sound)
    if not best or any(_known(name, shown)):
        return []
    return [f"in the steps of {name}, {one.text}" for one in best]


def _making(
    changes: Sequence[Change], shown: Sequence[Beginning], sound: Sequence[Beginning]
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


def _known(name: str, shown: Sequence[Beginning]) -> Iterator[Scheme]:
    """Schemes, and known slips in the one of this name, that make all runs."""
    names = [name] if name in OF_SCHEME else []
    known = [*COMMON.values(), *EXPLICIT.values()]
    known += [scheme for one in names for scheme in slipped(one).values()]
    for one in shown:
        known = [scheme for scheme in known if one.made_by(scheme)]
        if not known:
            break
    yield from known
