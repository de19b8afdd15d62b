"""A world or a body whose axes are not the scenario's: turned, turning, or shifted.

Where an attitude is right but for its world, the rotation from the exact attitude to the trace's is
the same at every sample, or turns at a constant rate; where it is right but for its body's axes, it
is the same at every sample on the body's side. The simplest that explains the error is named.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from omegadot.commands.score.measured import Measured, partial
from omegadot.commands.score.shift import Shift
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

# What leaves this part of the error or less is what was wrong. Errors of a scheme grow much like a
# turning world, which therefore must leave less. A simpler cause is preferred up to a factor more.
EXPLAINS = {"world": 0.1, "body": 0.1, "rate": 1e-3, "drift": 1e-3}
SIMPLER = 3.0
HALF = 0.5
FIXED = ("world", "body")
NEARLY = 1e-3  # rad, between a rate and an axis
MOST_ITERATIONS = 20


@dataclass(frozen=True)
class Turned:
    """The trace's axes against the scenario's, ``R_exact = exp(rate t) world R_trace body^-1``.

    kind: "rate", "world" or "body", what of the three is not nothing; "drift" of a rate that
    changes as ``rate + b t + c t^2``.  vector: (3,) rad, or rad/s, at the start.
    before, after: rad, the largest attitude error without and with it.  unchanged: rad, that with
    the rate at the start alone, which is all that can be declared.
    """

    kind: str
    vector: Array
    before: float
    after: float
    unchanged: float | None = None


@dataclass(frozen=True)
class Shifted:
    """The trace's positions less the scenario's. offset: (3,) m.  before, after: m, the largest."""

    offset: Array
    before: float
    after: float


def turned_world(found: Measured, shift: Shift | None) -> Turned | None:
    """How the trace's axes are turned, where that is the error of its attitude.

    shift: in time, which is undone first where it explains the error of omega; what then is turned
    for good may be the time's doing, and only a rate is sought.
    """
    trace = found.trace
    if "attitude" not in found.error or trace.orientation is None or len(trace.times) < 4:
        return None
    error, bound = found.error["attitude"], found.bound["attitude"]
    if np.all(error <= bound):
        return None
    from scipy.spatial.transform import Rotation

    late = shift is not None and shift.of == "omega" and shift.explains
    rows = slice(shift.first, None) if shift and late else slice(None)
    moved = trace.times[rows] + (shift.seconds if shift and late else 0.0)
    rows_inside = moved >= 0.0
    moved = moved[rows_inside]
    exact, own = (
        Rotation.from_quat(np.roll(normalize(q), -1, axis=-1))
        for q in (found.trajectory(moved).orientation, trace.orientation[rows][rows_inside])
    )
    times, before = trace.times[rows][rows_inside], float(np.max(error))
    tried = [one for one in _tried(exact, own, times, before) if not (late and one.kind in FIXED)]
    limit, least = float(np.max(bound)), min(one.after for one in tried)
    for one in tried:
        enough = one.after <= max(EXPLAINS[one.kind] * before, limit)
        # A rate that is declared already leaves its changes, and no option undoes these.
        turns = one.kind in FIXED or norm(one.vector) * times[-1] >= HALF * before
        enough = enough and bool(turns)
        if enough and one.after <= max(SIMPLER * least, limit):
            return one
    return None


def _tried(exact: Rotation, own: Rotation, times: Array, before: float) -> Iterator[Turned]:
    """The simplest first."""
    from scipy.spatial.transform import Rotation

    world = exact * own.inv()
    for kind, apart in (("world", world), ("body", own.inv() * exact)):
        mean = apart.mean()
        left = (apart * mean.inv()).magnitude()
        yield Turned(kind, mean.as_rotvec(), before, float(np.max(left)))
    for rate in _with_own_axis(_rate(world, times)):
        turned = Rotation.from_rotvec(times[:, None] * rate).inv() * world
        yield Turned("rate", rate, before, float(np.max(turned.magnitude())))
        powers = (times / times[-1])[:, None] ** np.arange(1, 4)
        fit = np.linalg.lstsq(powers, turned.as_rotvec(), rcond=None)[0]
        fit[:, rate == 0.0] = 0.0
        left = (Rotation.from_rotvec(powers @ fit).inv() * turned).magnitude()
        first = rate + fit[0] / times[-1]
        alone = (Rotation.from_rotvec(times[:, None] * first).inv() * world).magnitude()
        yield Turned("drift", first, before, float(np.max(left)), float(np.max(alone)))


def _with_own_axis(rate: Array) -> list[Array]:
    """A rate about one axis of the trace's world, if it is nearly that, and the rate itself."""
    axis = int(np.argmax(np.abs(rate)))
    alone = np.zeros(3)
    alone[axis] = rate[axis]
    return [alone, rate] if norm(rate - alone) <= NEARLY * norm(rate) else [rate]


def _rate(world: Rotation, times: Array) -> Array:
    """(3,) rad/s: the rate for which ``exp(rate t)`` is nearest, by Gauss-Newton from its steps."""
    from scipy.spatial.transform import Rotation

    steps = (world[1:] * world[:-1].inv()).as_rotvec() / np.diff(times)[:, None]
    rate = np.median(steps, axis=0)
    for _ in range(MOST_ITERATIONS):
        left = (Rotation.from_rotvec(times[:, None] * rate).inv() * world).as_rotvec()
        more = np.sum(times[:, None] * left, axis=0) / float(np.sum(times**2))
        rate = rate + more
        if norm(more) <= EPS * norm(rate):
            break
    return np.asarray(rate)


def shifted_world(found: Measured) -> Shifted | None:
    """A constant shift of the position, where that is most of its error."""
    position = found.trace.position
    if position is None or partial(position) or "position" not in found.error:
        return None
    error, bound = found.error["position"], found.bound["position"]
    if np.all(error <= bound) or len(error) < 4:
        return None
    apart = position - found.truth.state.position
    offset = np.mean(apart, axis=0)
    before, after = float(np.max(error)), float(np.max(norm(apart - offset)))
    if after > max(EXPLAINS["world"] * before, float(np.max(bound))):
        return None
    return Shifted(offset, before, after)


def origin_given(found: Measured) -> bool:
    """Whether the positions are those of the body's origin, and not of its centre of mass."""
    position, c = found.trace.position, found.case.system.body.center_of_mass
    if position is None or partial(position) or not np.any(c):
        return False
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_quat(np.roll(normalize(found.truth.state.orientation), -1, axis=-1))
    left = norm(position + turn.apply(c) - found.truth.state.position)
    error, bound = found.error["position"], found.bound["position"]
    right = max(EXPLAINS["body"] * float(np.max(error)), float(np.max(bound)))
    return bool(np.any(error > bound) and np.max(left) <= right)
