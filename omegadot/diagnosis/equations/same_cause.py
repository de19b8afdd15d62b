"""Whether two candidates are one cause, worded in two ways: they agree on any system."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, Body, Load, State, System

STATES = 8
TENSOR = ((1.0, 0.1, 0.2), (0.1, 1.6, -0.15), (0.2, -0.15, 2.1))
CENTER, PIVOT = np.array([0.11, -0.23, 0.17]), np.array([0.31, 0.13, -0.29])
GRAVITY = np.array([1.1, -2.3, -8.7])
BODY_TORQUE, WORLD_TORQUE = np.array([0.43, -0.97, 0.61]), np.array([-0.71, 0.29, 0.53])
MASS, DAMPING = 2.3, 0.37
SAME = 1e-9  # relative: a fitted number is no better known


@lru_cache(maxsize=2)
def _general(pivoted: bool) -> Evidence:
    """The right accelerations of a system with everything in it, at general states."""
    body = Body(np.asarray(MASS), CENTER, np.array(TENSOR))
    pivot = PIVOT if pivoted else None
    load = Load(GRAVITY, pivot, np.asarray(DAMPING), BODY_TORQUE, WORLD_TORQUE)
    system, draw = System((body,), load), np.random.default_rng(0)
    q = draw.normal(size=(STATES, 4))
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    states = place_on_pivot(system, State(q, *draw.normal(size=(3, STATES, 3))))
    ones = np.ones(STATES)
    return Evidence("", system, states, forward_dynamics(system, states), ones, ones)


def same_cause(one: Candidate, other: Candidate, pivoted: bool, apart: bool = False) -> bool:
    """Whether both give the same on a free body and, where the run has any, on a pivoted one.

    apart: of a pivoted body omega-dot alone is held against the engine's, see `linear_is_apart`.
    """
    if not _agree(one, other, _general(False)):
        return False
    return not pivoted or _agree(one, other, _general(True), apart)


def _agree(one: Candidate, other: Candidate, evidence: Evidence, apart: bool = False) -> bool:
    with np.errstate(all="ignore"):
        a, b = (x.predicted(evidence) for x in (one, other))
    if a is None or b is None:
        return False
    true = evidence.true
    linear = apart or _close(a.linear, b.linear, true.linear)
    return linear and _close(a.angular, b.angular, true.angular)


def _close(one: Array, other: Array, due: Array) -> bool:
    size = float(np.max(np.abs(np.stack((one, due)))))  # what is nothing is so to rounding
    return bool(np.all(np.abs(one - other) <= SAME * size))
