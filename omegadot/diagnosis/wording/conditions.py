"""At which states an engine is wrong: what holds for all of these and for no sound one."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.wording.digits import limits
from omegadot.diagnosis.wording.state_features import (
    features_of_states,
    further_features,
    kinds_of_states,
)
from omegadot.reference_impl.system import Array, State, System

# So many states on either side at least: the odds that chance sorts them are then below 1 in 20.
LEAST = 3
ODDS = 20  # as many times as conditions are tried must there be ways to sort the states
LARGEST = float(np.finfo(float).max)
CLEAR = 1e-3  # relative: a narrower gap between two sides is chance, where many numbers are tried


Part = tuple[System, State, NDArray[np.bool_]]
PLACE = "the number of the state among those that are requested together"


def only_where(parts: Sequence[Part], places: Sequence[NDArray[np.intp]] = ()) -> str:
    """The condition, over the states of one scenario or of several; "" where none sorts them.

    parts: system, states (n,) and whether the engine is right at each.  places: the number of each
    state in its request, from 0, where several were requested together.
    """
    sound = np.concatenate([right for _, _, right in parts])
    if np.count_nonzero(sound) < LEAST or np.count_nonzero(~sound) < LEAST:
        return ""
    exact = [kinds_of_states(states) for _, states, _ in parts]
    for text in exact[0]:
        holds = np.concatenate([one[text] for one in exact])
        if np.array_equal(holds, ~sound):
            return text
    every = [features_of_states(*part[:2]) | further_features(*part[:2]) for part in parts]
    for features, numbers in zip(every, places, strict=False):
        features[PLACE] = (numbers + 1.0, "")
    tried = len(exact[0]) + 2 * len(every[0])
    for text, (_, unit) in every[0].items():
        values = np.concatenate([one[text][0] for one in every])
        said = ~np.isnan(values)  # where it is undefined, a state is on either side
        low, high = values[said & sound], values[said & ~sound]
        sides = sorted((len(low), len(high)))
        if sides[0] < LEAST or comb(sum(sides), sides[0]) < ODDS * tried:
            continue
        values = values[said]
        if not np.all(np.isfinite(values)):
            continue
        for term, a, b in (("above", low, high), ("below", high, low)):
            below, above = float(np.max(a)), float(np.min(b))
            if term == "above" and not np.any(low):
                continue  # what vanishes with it is no limit
            known = above < LARGEST and below > -LARGEST  # else a quotient by zero stands beyond it
            if below < above and known and above - below > CLEAR * _spacing(values):
                return f"{text} is {term} a limit between {limits(below, above, unit)}"
    return ""


def _spacing(values: Array) -> float:
    """The usual distance of neighbours, which a gap must not be much narrower than."""
    return float(np.median(np.diff(np.sort(values))))
