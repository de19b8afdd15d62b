"""Runs whose last sample is the state of another step, or by another scheme; others are right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.ends.last_fields import other_fields
from omegadot.diagnosis.stepping.ends.last_samples import RunEnd, scenarios_that_show
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, plain_names, scheme_of
from omegadot.reference_impl.schemes import COMMON
from omegadot.reference_impl.schemes.scheme import Scheme

MISSING = "the last step is missing: the end is the state one step before"
EVERY = "the last sample of every run is the state {} its time"
OTHER = "the last step of every run is by {}, not by {}"
SHORT = "the last sample, after an interval shorter than the others, is the state {} its time"
MOST_SHIFT = 3  # steps
COUNTS = ("", "one step", "two steps", "three steps")


@dataclass(frozen=True)
class Ends:
    """statement: what the last sample of runs is.  names: of the scenarios that this explains."""

    statement: str
    names: frozenset[str]


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
        for find in (_other_step, other_fields, _other_scheme):
            text, shown = find(ends, by)
            if text:
                return Ends(text, frozenset(shown - _wrong_before(kept, by)))
    return None


def _other_step(ends: Sequence[RunEnd], by: SchemeOf) -> tuple[str, set[str]]:
    """Which step every last sample is of, or every one after a shorter interval."""
    shifts = [sign * k for k in range(1, MOST_SHIFT + 1) for sign in (1, -1)]
    for short in (False, True):
        for shift in shifts:
            shown = scenarios_that_show(ends, by, partial(_is_moved, by, shift, short))
            if shown:
                return statement_of(shift, short), shown
    return "", set()


def _is_moved(by: SchemeOf, shift: int, short: bool, end: RunEnd) -> bool:
    return end.is_after(by, end.steps + shift * (end.is_short or not short))


def _other_scheme(ends: Sequence[RunEnd], by: SchemeOf) -> tuple[str, set[str]]:
    """By which scheme the last step of every run is."""
    shows = dict[str, set[str]]()
    for one in COMMON.values():
        if by.coordinates in one.coordinates and one != by.scheme:
            shown = scenarios_that_show(ends, by, partial(_ends_by, by, one))
            shows |= {one.name: shown} if shown else {}
    plain = plain_names([*shows])
    if not plain:
        return "", set()
    return OTHER.format(" or ".join(plain), by.scheme.name), shows[plain[0]]


def _ends_by(by: SchemeOf, last: Scheme, end: RunEnd) -> bool:
    return end.ends_by(by, last)


def statement_of(shift: int, short: bool) -> str:
    """Which step the last sample is of. short: of runs alone whose last interval is shorter."""
    if shift == -1 and not short:
        return MISSING
    off = f"{COUNTS[abs(shift)]} {'further than' if shift > 0 else 'before'}"
    return (SHORT if short else EVERY).format(off)


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
