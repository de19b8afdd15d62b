"""A body whose state steps leave as it is, where that should change: below which limit they do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.vanishing.rests import Rests, extremes_of, least_of
from omegadot.gates.steps.probe import Probe
from omegadot.reference_impl.system import State, System

FREEZES = "a step leaves the state as it is"


def freezes_of(
    system: System, probe: Probe | None, stepped: State | None, runs: Sequence[State]
) -> Rests:
    """From single steps of a probe (m, k), and from the samples of runs.

    A state from which not one of the steps, and no interval, leads anywhere is frozen, where the
    body turns or moves.
    """
    frozen, moving = list[State](), list[State]()
    if probe is not None and stepped is not None:
        pairs = zip(vars(probe.states).values(), vars(stepped).values(), strict=True)
        stays = np.logical_and.reduce([np.all(a[:, None] == b, axis=(1, 2)) for a, b in pairs])
        frozen.append(probe.states[stays & _goes(probe.states)])
        moving.append(probe.states[~stays])
    for run in runs:
        same = [np.all(values[1:] == values[:-1], axis=-1) for values in vars(run).values()]
        stays, begins = np.logical_and.reduce(same), run[:-1]
        frozen.append(begins[stays & _goes(begins)])
        moving.append(begins[~stays])
    known = sum(len(one.position) for one in frozen)
    ends = extremes_of(system, frozen, np.max), extremes_of(system, moving, np.min)
    pivoted = system.load.pivot is not None
    return Rests(known > 0, known, *ends, least_of(moving), pivoted)


def _goes(states: State) -> NDArray[np.bool_]:
    """(n,): whether the attitude or the place should change."""
    turns = np.any(states.angular_velocity, axis=-1)
    return np.asarray(turns | np.any(states.linear_velocity, axis=-1))
