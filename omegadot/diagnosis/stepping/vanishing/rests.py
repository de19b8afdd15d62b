"""A body that is put to sleep: of which quantity a limit holds on every scenario.

What is kept of a scenario is small: of every quantity the largest at which the body was put to
rest, and the least at which it was left moving. It is put to rest by single steps: a run that falls
asleep may have been below a limit for some steps or some time before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.wording.conditions import ODDS
from omegadot.diagnosis.wording.digits import limits
from omegadot.gates.bounds.scales import norm
from omegadot.gates.steps.probe import Probe
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State, System

LEAST = 3  # states at which the body is put to rest: chance sorts fewer by some quantity
MOST_NAMED = 3
DIGITS = 4  # of a limit; the shortest steps of a probe change a state by less
SLEEPS = "the body is put to sleep"
UNITS = {
    "|omega|": "rad/s",
    "the largest component of omega": "rad/s",
    "its speed": "m/s",
    "its kinetic energy": "J",
    "its kinetic energy over its mass": "J/kg",
    "its kinetic energy of rotation": "J",
    "its kinetic energy of rotation over its mass": "J/kg",
    "its kinetic energy with that of rotation about the pivot, over its mass": "J/kg",
    "its angular momentum about the centre of mass": "kg m^2/s",
    "its momentum": "kg m/s",
    "|omega|^2 + |v|^2": "in SI units",
}


def quantities(system: System, states: State) -> dict[str, Array]:
    """(n,) each, by the names of `UNITS`: what an engine may compare with a limit."""
    w, v, mass = states.angular_velocity, states.linear_velocity, float(system.body.mass)
    momentum = apply(np.asarray(system.body.inertia, dtype=float), w)
    turning, moving = 0.5 * np.sum(w * momentum, axis=-1), 0.5 * mass * np.sum(v * v, axis=-1)
    about = 0.5 * np.sum(w * apply(moving_inertia(system), w), axis=-1)
    values = (
        norm(w),
        np.max(np.abs(w), axis=-1),
        norm(v),
        turning + moving,
        (turning + moving) / mass,
        turning,
        turning / mass,
        (about + moving) / mass,
        norm(momentum),
        mass * norm(v),
        norm(w) ** 2 + norm(v) ** 2,
    )
    return dict(zip(UNITS, values, strict=True))


@dataclass(frozen=True)
class Rests:
    """Of one integrator on one scenario. seen: whether a body is put to rest that should move.

    known and left: how many states single steps put to rest, and how many they left moving.
    at_rest and moving: by quantity, the largest that was put to rest and the least that was not,
    in runs as well.  least: (k, 2) |omega| and speed of states that move; of all others one of
    these is no faster in either.
    """

    seen: bool
    known: int
    left: int
    at_rest: dict[str, float]
    moving: dict[str, float]
    least: Array
    pivoted: bool = False


@dataclass(frozen=True)
class RunWithRests:
    """A run's samples, and those of the exact motion."""

    state: State
    exact: State

    @property
    def rests(self) -> bool:
        """Whether omega is zero at a sample, and should not be."""
        return bool(np.any(stands(self.state)[1:] & ~stands(self.exact)[1:]))


def stands(states: State) -> NDArray[np.bool_]:
    """(n,): whether omega is zero."""
    return np.asarray(~np.any(states.angular_velocity, axis=-1))


def rests_of(
    system: System, probe: Probe | None, stepped: State | None, runs: Sequence[RunWithRests]
) -> Rests:
    """From single steps of a probe (m, k), the last of each the shortest, and from the runs."""
    resting, left = list[State](), list[State]()
    # the start is given
    moving = [run.state[1:][~stands(run.state)[1:]] for run in runs]
    if probe is not None and stepped is not None:
        # in the shortest steps nothing but sleep takes all of omega
        after = stands(State(*(values[:, -1] for values in vars(stepped).values())))
        resting.append(probe.states[after & ~stands(probe.states)])
        left.append(probe.states[~after])
    known, still = (sum(len(one.position) for one in part) for part in (resting, left))
    moving += left
    seen = known > 0 or any(run.rests for run in runs)
    ends = extremes_of(system, resting, np.max), extremes_of(system, moving, np.min)
    return Rests(seen, known, still, *ends, least_of(moving), system.load.pivot is not None)


def least_of(parts: Sequence[State]) -> Array:
    """The (|omega|, speed) of which no other is as small in both."""
    sizes = [(norm(one.angular_velocity), norm(one.linear_velocity)) for one in parts]
    points = np.concatenate([np.empty((0, 2)), *(np.stack(one, axis=-1) for one in sizes)])
    points = points[np.lexsort(points.T[::-1])]
    before = np.minimum.accumulate(np.append(np.inf, points[:, 1]))[:-1]
    return np.asarray(points[points[:, 1] < before])


def extremes_of(
    system: System, parts: Sequence[State], end: Callable[..., Array]
) -> dict[str, float]:
    """The end of each quantity over all states, of which there may be none."""
    every = [quantities(system, one) for one in parts if len(one.position)]
    return {name: float(end([end(one[name]) for one in every])) for name in UNITS if every}


def _known(every: Sequence[Rests]) -> int:
    """Of states that single steps have led on from, or not."""
    return sum(one.known + one.left for one in every)


def _ways(every: Sequence[Rests]) -> int:
    """In how many ways chance may put so many states to rest, and leave the others moving."""
    return comb(_known(every), sum(one.known for one in every))


def _of_two(every: Sequence[Rests]) -> str:
    """Limits of omega and of speed, of which both hold at once; "" without any."""
    if sum(one.known for one in every) < 2 * LEAST or _ways(every) < ODDS * _known(every):
        return ""  # of so many states no more pairs of limits have the slowest below them
    names, moves = ("|omega|", "its speed"), np.concatenate([one.least for one in every])
    low = [max(one.at_rest[name] for one in every if one.at_rest) for name in names]
    near = [moves[moves[:, 1 - k] <= low[1 - k], k] for k in range(2)]
    high = [float(np.min(values, initial=np.inf)) for values in near]
    if not all(0.0 < a < b < np.inf for a, b in zip(low, high, strict=True)):
        return ""
    omega, speed = (between(low[k], high[k], UNITS[names[k]]) for k in range(2))
    return f"|omega| is below a limit between {omega} and its speed is below one between {speed}"


def between(low: float, high: float, unit: str) -> str:
    """Two ends, in digits that a short step does not change."""
    return limits(_outward(low, np.floor), _outward(high, np.ceil), unit)


def _outward(value: float, way: Callable[[float], float]) -> float:
    """In digits that a short step does not change."""
    last = 10.0 ** (np.floor(np.log10(value)) + 1 - DIGITS)
    return float(way(value / last) * last)


def sleep_law(every: Sequence[Rests], what: str = SLEEPS) -> str:
    """The cause, with what a limit of holds on all scenarios; "" where none does, or many do.

    what: happens to the body.
    """
    if sum(one.known for one in every) < LEAST or _ways(every) < ODDS * len(UNITS):
        return ""
    found = list[str]()
    for name, unit in UNITS.items():
        low = max((one.at_rest[name] for one in every if one.at_rest), default=0.0)
        high = min((one.moving[name] for one in every if one.moving), default=np.inf)
        if 0.0 < low < high < np.inf:
            found.append(f"{name} is below a limit between {between(low, high, unit)}")
    found = found or [text for text in (_of_two(every),) if text]
    if not found or len(found) > MOST_NAMED:
        return ""
    return f"{what} where {'either ' * (len(found) > 1)}{', or '.join(found)}"
