"""What is known of a state that does not read back where no cause fits, over all scenarios."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from omegadot.diagnosis.wording.digits import listed
from omegadot.gates.rows import Row
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.system import Array
from omegadot.written import written

NAMES = {
    "attitude": "the attitude",
    "omega": "omega",
    "position": "the position",
    "linear_momentum": "the linear velocity",
}
SAME = 1e-9  # rad or relative
AXES = "xyz"


def known_of_states(rows: Sequence[Sequence[Row]], requested: Array, back: Array) -> str:
    """One sentence: which quantities do not read back, where, and what stays right.

    rows: of each scenario, of the state alone.  requested, back: the attitudes, (n, 4).
    """
    failed = [{row.channel: row for row in one if row.verdict == "fail"} for one in rows]
    off = [name for name in NAMES if any(name in one for one in failed)]
    if not off:
        return ""
    texts = [_off(name, failed) for name in off]
    right = [NAMES[name] for name in NAMES if name not in off]
    texts += [f"{listed(right)} read{'s' * (len(right) == 1)} back right"] if right else []
    if "attitude" in off:
        places = [k for k, one in enumerate(failed) if "attitude" in one]
        kept = _kept(requested[places], back[places])
        texts += [f"of the attitude {listed(kept)} stays right"] if kept else []
    return f"none is known; {'; '.join(texts)}"


def _off(name: str, failed: Sequence[Mapping[str, Row]]) -> str:
    """One quantity, and on how many scenarios by how much."""
    sizes = [one[name].value for one in failed if name in one]
    count, every = len(sizes), len(failed)
    where = f"on all {every} scenarios" if count == every else f"on {count} of {every} scenarios"
    if every == 1:
        where = "here"
    unit = next(one[name].unit for one in failed if name in one)
    if name == "attitude" and count == every > 1:
        where = f"at every attitude that is set, {where}"
    low, high = written(min(sizes), 2), written(max(sizes), 2)
    by = f"by {low} {unit}" if low == high else f"by {low} to {high} {unit}"
    return f"{NAMES[name]} that reads back is not the one set, {where}, {by}"


def _kept(requested: Array, back: Array) -> list[str]:
    """What of the attitudes is the same: the angle from the identity, or an axis."""
    one, other = normalize(requested), normalize(back)
    found = []
    if np.all(np.abs(np.abs(one[:, 0]) - np.abs(other[:, 0])) <= SAME):
        found.append("the angle from the identity")
    a, b = rotation_matrix(one), rotation_matrix(other)
    for k, axis in enumerate(AXES):
        if np.all(np.abs(a[:, :, k] - b[:, :, k]) <= SAME):
            found.append(f"where the body's {axis} axis points")
        if np.all(np.abs(a[:, k, :] - b[:, k, :]) <= SAME):
            found.append(f"where the world's {axis} axis points in the body")
    return found
