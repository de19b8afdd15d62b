"""Steps that are another scheme's where a number of the state is beyond a limit, over all runs.

A step is chosen by what it starts from. So an interval that only the known scheme makes starts on
its side of the limit, one that only the other scheme makes starts on the other side, and one that
neither makes has steps of both.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT, scheme_named
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, plain_names
from omegadot.diagnosis.stepping.places import step_features
from omegadot.diagnosis.wording.conditions import ODDS
from omegadot.diagnosis.wording.digits import limits
from omegadot.reference_impl.schemes import COMMON, Scheme
from omegadot.reference_impl.system import Array

MOST_STEPS = 8  # between two samples: of more nearly every interval may have steps of both
LEAST_OTHER, LEAST_OWN, SCENARIOS = 6, 20, 2  # intervals that show either; systems that show both
MOST_NAMED = 2  # numbers, or schemes, between which no interval decides
OPPOSITE = {"above": "below", "below": "above"}
FIRST = 4  # runs in which most schemes are ruled out


@dataclass(frozen=True)
class _Intervals:
    """Of all runs: which an own or another scheme makes, and numbers where each begins and ends."""

    own: NDArray[np.bool_]
    other: NDArray[np.bool_]
    system: NDArray[np.int_]
    begins: dict[str, Array]
    ends: dict[str, Array]
    units: dict[str, str]


def scheme_by_state(integrator: Integrator, by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """Where steps are by which other scheme; none where no number of the state sorts them.

    by: the scheme that most steps are of, which where none is declared may be the other one.
    """
    used = [run.short for run in runs if run.sweep.every <= MOST_STEPS]
    used = sorted(used, key=lambda run: (not run.fails, run.sweep.every))
    own = [run.sound(by) for run in used]
    wrong = [(run, sound) for run, sound in zip(used, own, strict=True) if not sound.all()]
    single = [run for run, _ in wrong if run.sweep.every == 1]
    if not single or len({run.name for run, _ in wrong}) < SCENARIOS:
        return []
    found = list[tuple[str, str, str]]()
    for name in _others(by, single[:FIRST]):
        other = SchemeOf(scheme_named(name), by.coordinates)
        due = integrator.scheme is None and _is_due(other.scheme, by.scheme, integrator)
        lower, higher = (by, other) if due else (other, by)
        for text in _sorting(_intervals(used, own, other), of_own=due):
            found.append((text, lower.scheme.name, higher.scheme.name))
    if not found:
        return []
    where, wrongs, rights = (list(dict.fromkeys(part)) for part in zip(*found, strict=True))
    wrongs = plain_names(wrongs)
    if max(map(len, (where, wrongs, rights))) > MOST_NAMED:
        return []
    either = "either " * (len(where) > 1) + ", or ".join(where)
    return [f"where {either}, a step is by {' or '.join(wrongs)}, not by {' or '.join(rights)}"]


def _is_due(other: Scheme, by: Scheme, integrator: Integrator) -> bool:
    """Whether of two schemes the other alone has the orders that are declared."""
    due = {name: order for name, order in integrator.orders.items() if order is not None}
    mine, its = (
        all((scheme.orders.get(name) or order) >= order for name, order in due.items())
        for scheme in (by, other)
    )
    return its and not mine


def _others(by: SchemeOf, single: Sequence[KeptRun]) -> Iterator[str]:
    """The schemes by which every single step is that is not by its own."""
    for name in (*COMMON, *EXPLICIT):
        scheme = scheme_named(name)
        if name == by.scheme.name or by.coordinates not in scheme.coordinates:
            continue
        other = SchemeOf(scheme, by.coordinates)
        if all(np.all(run.sound(by) | run.sound_but_for_rounding(other)) for run in single):
            yield name


def _intervals(
    runs: Sequence[KeptRun], own: Sequence[NDArray[np.bool_]], by: SchemeOf
) -> _Intervals:
    first = [step_features(run, run.state[:-1]) for run in runs]
    last = [step_features(run, run.state[1:]) for run in runs]
    names = list(dict.fromkeys(run.name for run in runs))
    numbers = {name: unit for name, (_, unit) in first[0].items()}

    def joined(every: Sequence[dict[str, tuple[Array, str]]]) -> dict[str, Array]:
        return {name: np.concatenate([one[name][0] for one in every]) for name in numbers}

    return _Intervals(
        np.concatenate(list(own)),
        np.concatenate([run.sound_but_for_rounding(by) for run in runs]),
        np.concatenate([np.full(len(run.times) - 1, names.index(run.name)) for run in runs]),
        joined(first),
        joined(last),
        numbers,
    )


def _sorting(whole: _Intervals, of_own: bool) -> list[str]:
    """The numbers of the state that decide, each with its limit.

    of_own: the side of it that is stated is that of the own scheme, not of the other.
    """
    own, other = whole.own & ~whole.other, whole.other & ~whole.own
    both = ~whole.own & ~whole.other
    counts = int(np.count_nonzero(own)), int(np.count_nonzero(other))
    shown = set(whole.system[own]) & set(whole.system[other])
    if counts[0] < LEAST_OWN or counts[1] < LEAST_OTHER or len(shown) < SCENARIOS:
        return []
    if comb(sum(counts), counts[1]) < ODDS * 2 * len(whole.units):
        return []  # so few are sorted by chance
    found = []
    for name, unit in whole.units.items():
        for term, sign in (("above", 1.0), ("below", -1.0)):
            start, end = sign * whole.begins[name], sign * whole.ends[name]
            low, high = float(np.max(start[own])), float(np.min(start[other]))
            crosses = (np.minimum(start, end) <= high) & (np.maximum(start, end) >= low)
            if low < high and np.all(crosses[both]):
                stated = OPPOSITE[term] if of_own else term
                lower, upper = sorted((sign * low, sign * high))
                between = limits(lower, upper, unit)
                found.append(f"{name} is {stated} a limit between {between}")
    return found
