"""Runs of a node of three angles, in two axes of the body whose singularities are apart.

``R = Rx(a) Ry(b) Rz(c)`` is singular at ``cos(b) = 0``: where the node's z-axis is along the
world's x-axis. In the exchanged axes this is the body's y-axis, in the body's own its z-axis, so
that in one of the two the singularity is always far. A step depends on the state alone: a run goes
on in the other axes as it would begin there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from omegadot.adapters.exudyn.joint import states
from omegadot.adapters.exudyn.model import ExudynModel
from omegadot.adapters.exudyn.stepping import is_finite, run_fixed
from omegadot.reference_impl.system import Array, State

# Of the body's y-axis along the world's x-axis, up to which axes are exchanged. The singularity is
# then 45 degrees away at least, else 44. It is no cosine of an angle that bodies start at.
MOST = 0.7
AT_ONCE = 64  # steps of a call: those after a change of axes are taken again


def run_in_two(
    exudyn: Any,
    models: Sequence[ExudynModel],
    settings: Any,
    start: State,
    h: float,
    steps: int,
) -> tuple[State, float]:
    """The states (n + 1, ...) of n steps of h s, and the s that they took.

    models: of the same body, in exchanged axes and in its own. A run that is no longer finite ends
    in NaN.
    """
    found, seconds, left = [_repeated(start, 1)], 0.0, steps
    while left:
        state = found[-1][-1]
        exchanged = bool(is_exchanged(state.orientation))
        now, model = list(range(min(left, AT_ONCE) + 1)), models[0 if exchanged else 1]
        rows, taken = run_fixed(exudyn, model, settings, state, h, now)
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            stepped = states(model, rows[1:])
            changes = np.flatnonzero(is_exchanged(stepped.orientation) != exchanged)
        count = int(changes[0]) + 1 if len(changes) else len(rows) - 1
        found.append(stepped[:count])
        seconds, left = seconds + taken, left - count
        if not is_finite(rows[count]):
            found.append(_repeated(start, left, np.nan))
            break
    fields = zip(*(vars(part).values() for part in found), strict=True)
    return State(*(np.concatenate(parts) for parts in fields)), seconds


def is_exchanged(q: Array) -> Any:
    """Whether the axes are exchanged at these attitudes (..., 4): a rule of these alone."""
    return np.abs(2.0 * (q[..., 1] * q[..., 2] - q[..., 0] * q[..., 3])) <= MOST


def _repeated(state: State, times: int, factor: float = 1.0) -> State:
    return State(*(np.tile(factor * np.array(v, float), (times, 1)) for v in vars(state).values()))
