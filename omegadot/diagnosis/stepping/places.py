"""Steps that are wrong in one part of all states alone, over all runs, such as near the vertical.

Every interval is sound or wrong by the scheme that is known. What holds of all wrong ones and of no
sound one is looked for among the numbers of a state, at the places of each step's stages.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.wording.digits import limits, number
from omegadot.diagnosis.wording.state_features import Numbers, features_of_states
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, State

LEAST_WRONG, LEAST_SOUND = 4, 20  # intervals
ODDS = 1000  # as many times as numbers are tried must there be ways to sort the intervals
MISSED = 0.02  # of the wrong ones, whose stages may lie a little farther than is known
LEAST_CHANGES = 4  # from sound to wrong, or back, within runs
MOST_NAMED = 2  # between which no interval decides
MOST_EVERY = 2  # steps in an interval: of more the places in it are unknown
SIZE_OF = "the size of "
TILT = f"{SIZE_OF}the cosine of the tilt of the body's "


@dataclass(frozen=True)
class _Sorted:
    """Intervals of all runs: whether each is sound, and what is least and most in each."""

    sound: NDArray[np.bool_]
    run: NDArray[np.intp]
    least: dict[str, Array]
    most: dict[str, Array]
    units: dict[str, str]


def place_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """Where alone steps are wrong, and in which quantities; none where nothing sorts them."""
    used = [run for run in runs if run.sweep.every <= MOST_EVERY]
    if not used:
        return []
    found = _sorted(by, used)
    wrong = ~found.sound
    if np.count_nonzero(wrong) < LEAST_WRONG or np.count_nonzero(found.sound) < LEAST_SOUND:
        return []
    comes_and_goes = np.diff(found.sound.astype(int)) * (np.diff(found.run) == 0)
    if np.count_nonzero(comes_and_goes) < LEAST_CHANGES:
        return []  # a run that stays wrong is one example, however many intervals it has
    if comb(len(wrong), int(np.count_nonzero(wrong))) < ODDS * 2 * len(found.units):
        return []
    texts = dict[str, str]()
    for name, unit in found.units.items():
        for term, values in (("above", found.most[name]), ("below", -found.least[name])):
            low = float(np.max(values[found.sound]))
            beyond = values[wrong] > low
            if np.mean(beyond) >= 1.0 - MISSED:
                high = float(np.min(values[wrong][beyond]))
                sign = 1.0 if term == "above" else -1.0
                texts[name] = _where(name, term, sign * low, sign * high, unit)
    plain = [text for name, text in texts.items() if SIZE_OF + name not in texts]
    if not 0 < len(plain) <= MOST_NAMED:
        return []
    either = "either " * (len(plain) > 1) + ", or ".join(plain)
    return [f"samples are wrong only where {either}"]


def _where(name: str, term: str, sound: float, wrong: float, unit: str) -> str:
    if name.startswith(TILT) and term == "above":
        angles = [np.degrees(np.arccos(np.clip(c, -1.0, 1.0))) for c in (wrong, sound)]
        axis = name.removeprefix(TILT)
        first, last = (float(f"{angle:.3g}") for angle in angles)
        near = f"between {limits(first, last, 'degrees')}"
        if first == last:
            near = f"at {number(first)} degrees"
        return f"the body's {axis} is within a limit of the vertical, {near}"
    first, last = sorted((float(f"{sound:.4g}"), float(f"{wrong:.4g}")))
    ends = limits(first, last, unit)
    return f"{name} is {term} a limit between {ends}"


def _sorted(by: SchemeOf, runs: Sequence[KeptRun]) -> _Sorted:
    sound = [run.sound(by) for run in runs]
    each = [[step_features(run, states) for states in _places(run)] for run in runs]
    names = {name: unit for name, (_, unit) in each[0][0].items()}

    def over(pick: np.ufunc, name: str) -> Array:
        return np.concatenate([pick.reduce([at[name][0] for at in one]) for one in each])

    return _Sorted(
        np.concatenate(sound),
        np.concatenate([np.full(len(one), k) for k, one in enumerate(sound)]),
        {name: over(np.minimum, name) for name in names},
        {name: over(np.maximum, name) for name in names},
        names,
    )


def step_features(run: KeptRun, states: State) -> Numbers:
    """Numbers of states (n,) of a run, with units, and of what a step changes there."""
    h, w = run.sweep.timestep, norm(states.angular_velocity)
    rate = norm(forward_dynamics(run.system, states).angular)
    return features_of_states(run.system, states) | {
        "the turn of a step": (h * w, "rad"),
        "the change of omega in a step": (h * rate, "rad/s"),
        "the change of omega in a step over |omega|": (h * rate / np.where(w > 0.0, w, 1.0), ""),
    }


def _places(run: KeptRun) -> list[State]:
    """The start, the middle and the end of every step in the intervals, in even parts of these."""
    start, end = run.state[:-1], run.state[1:]
    q = end.orientation
    same = np.sign(np.sum(start.orientation * q, axis=-1, keepdims=True))
    ends = {**vars(end), "orientation": same * q}
    states = list[State]()
    for part in np.linspace(0.0, 1.0, 2 * run.sweep.every + 1):
        pairs = ((name, (1.0 - part) * getattr(start, name) + part * ends[name]) for name in ends)
        states.append(State(**dict(pairs)))
    return states
