"""A body whose state steps leave as it is, where that should change: below which limit they do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.vanishing.rests import Rests, extremes_of, least_of
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.steps.probe import Probe
from omegadot.reference_impl.system import State, System

FREEZES = "a step leaves the state as it is"
ROUNDINGS = 8  # of a state that is given in other coordinates than it is stepped in


def freezes_of(
    system: System, probe: Probe | None, stepped: State | None, runs: Sequence[State]
) -> Rests:
    """From single steps of a probe (m, k), and from the samples of runs.

    A state from which not one of the steps leads anywhere, or not the first interval of a run, is
    frozen, where the body turns or moves; what becomes so later may depend on the steps before.
    """
    frozen, left = list[State](), list[State]()
    if probe is not None and stepped is not None:
        stays = np.all(_same(system, probe.states[:, None], stepped), axis=-1)
        frozen.append(probe.states[stays & _goes(probe.states)])
        left.append(probe.states[~stays])
    moving, seen = [*left], bool(frozen and len(frozen[0].position))
    for run in runs:
        begins, stays = run[:-1], _same(system, run[:-1], run[1:])
        moving.append(begins[~stays])
        stays &= _goes(begins)
        frozen.append(begins[:1][stays[:1]])
        seen |= bool(np.any(stays))
    known, goes_on = (sum(len(one.position) for one in part) for part in (frozen, left))
    ends = extremes_of(system, frozen, np.max), extremes_of(system, moving, np.min)
    pivoted = system.load.pivot is not None
    return Rests(seen, known, goes_on, *ends, least_of(moving), pivoted)


def _same(system: System, before: State, after: State) -> NDArray[np.bool_]:
    """(...,): whether a state is the same to rounding; of a pivoted body its place follows."""
    turned = after.orientation - before.orientation
    same = np.max(np.abs(turned), axis=-1) <= ROUNDINGS * EPS
    names = ["angular_velocity", "linear_velocity", "position"]
    for name in names if system.load.pivot is None else names[:1]:
        old, new = getattr(before, name), getattr(after, name)
        same &= norm(new - old) <= ROUNDINGS * EPS * norm(old)
    return np.asarray(same)


def _goes(states: State) -> NDArray[np.bool_]:
    """(n,): whether the attitude or the place should change."""
    turns = np.any(states.angular_velocity, axis=-1)
    return np.asarray(turns | np.any(states.linear_velocity, axis=-1))
