"""Why a trace diverges, of equations and systems that are often mistaken: the one that it follows.

Each is solved for itself and compared with the trace. One is named only if it leaves next to
nothing of every channel's error, and no two that differ do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from omegadot.commands.score.measured import Measured, distance, filled
from omegadot.diagnosis.models.tensors import mistaken_inertias
from omegadot.diagnosis.stepping import trace as diagnosis
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.body_motion import motion_over
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import AccelerationOf, acceleration_of
from omegadot.reference_impl.rotations import conjugate, rotate, rotate_inverse
from omegadot.reference_impl.schemes.motion import slope_of
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, Load, State, System

LEAVES = 1e-3  # of an error, at most; schemes and digits leave something too
SHOWS = 0.05  # of its largest, an error is compared first once it has grown to
MOST_COMPARED = 60  # samples
MOST_TURNED = 1000.0  # rad, by the motion: beyond, each solution would take long
MOST_EVALUATIONS = 20_000  # of a solution: an inertia that is far off may turn far faster
PRECISION = 1e-11  # relative, of a solution
Rows = NDArray[np.intp]
CHANNELS = ("omega", "attitude", "position")


@dataclass(frozen=True)
class Mistake:
    """A motion that a simulator may have taken for the scenario's. statement: the cause."""

    statement: str
    system: System
    initial: State
    acceleration: AccelerationOf


def causes_of_trace(found: Measured) -> list[str]:
    """The mistakes that the trace follows, as sentences; none where several unlike ones fit.

    It follows one from its start, or from each sample to the next.
    """
    return _from_the_start(found) or _between_samples(found)


def _between_samples(found: Measured) -> list[str]:
    trace, count = found.trace, len(found.trace.times)
    omega = trace.angular_velocity
    wrong = any(np.any(found.error[c] > found.bound[c]) for c in ("omega",) if c in found.error)
    if not wrong or omega is None or np.any(np.isnan(omega)):
        return []
    turns = trace.orientation is not None and not np.any(np.isnan(trace.orientation))
    none, unknown = np.zeros(count), np.full(count, np.inf)
    opened = trace.open.get("angular_velocity", none)
    turned = trace.open.get("orientation", none) if turns else unknown
    own = diagnosis.Trace(trace.times, found.state, opened, turned)
    return diagnosis.trace_causes(found.case.system, own)


def _from_the_start(found: Measured) -> list[str]:
    channels = [c for c in CHANNELS if c in found.error]
    wrong = [c for c in channels if np.any(found.error[c] > found.bound[c])]
    if not wrong or found.rate * float(found.trace.times[-1]) > MOST_TURNED:
        return []
    shown = [np.argmax(found.error[c] >= SHOWS * np.max(found.error[c])) for c in wrong]
    first, count = max(2, int(max(shown)) + 1), len(found.trace.times)
    early = np.unique(np.linspace(0, first - 1, MOST_COMPARED).round().astype(int))
    whole = np.unique(np.linspace(0, count - 1, MOST_COMPARED).round().astype(int))
    fitting: list[tuple[str, State]] = []
    for mistake in mistakes(found.case.system, found.case.initial):
        if _follows(found, mistake, early, channels) is None:
            continue
        state = _follows(found, mistake, whole, channels)
        if state is not None:
            fitting.append((mistake.statement, state))
    if any(_apart(found, a[1], b[1], whole, wrong) for a, b in pairwise(fitting)):
        return []
    return list(dict.fromkeys(statement for statement, _ in fitting))[:1]


def _follows(found: Measured, mistake: Mistake, rows: Rows, channels: list[str]) -> State | None:
    """The mistaken motion at some samples, if the trace follows it in every channel."""
    state = _solved(mistake, found.trace.times[rows])
    if state is None:
        return None
    trace = found.trace.at(rows)
    for channel in channels:
        left = distance(found.truth, trace, channel, filled(trace, state), state)
        allowed = LEAVES * float(np.max(found.error[channel][rows]))
        if not np.all(left <= np.maximum(found.bound[channel][rows], allowed)):
            return None
    return state


def _apart(found: Measured, one: State, other: State, rows: Rows, channels: list[str]) -> bool:
    """Whether two mistaken motions differ by more than what they leave."""
    gaps = {c: distance(found.truth, found.trace.at(rows), c, one, other) for c in channels}
    return any(np.max(gaps[c]) > 2.0 * LEAVES * np.max(found.error[c][rows]) for c in channels)


def _solved(mistake: Mistake, times: Array) -> State | None:
    """By Dormand and Prince's method of order 8; None where it does not get there."""
    q, v = to_coordinates(mistake.system, mistake.initial, "com-world")
    motion = motion_over(mistake.system, "com-world", mistake.acceleration)
    count, evaluations = len(q), iter(range(MOST_EVALUATIONS))
    slope = slope_of(motion, count)

    def rate(_: float, y: Array) -> Array:
        next(evaluations)
        return slope(y)

    start, span = np.concatenate((q, v)), (0.0, float(times[-1]))
    small = PRECISION * max(1e-6, float(norm(v[-3:])))
    how = {"method": "DOP853", "rtol": PRECISION, "atol": small, "t_eval": times}
    try:
        with np.errstate(all="ignore"):
            solved = solve_ivp(rate, span, start, **how)
    except StopIteration:
        return None
    if not solved.success or solved.y.shape[1] != len(times):
        return None
    y = solved.y.T
    return from_coordinates(
        mistake.system, motion.normalize(y[:, :count]), y[:, count:], "com-world"
    )


def mistakes(system: System, initial: State) -> Iterator[Mistake]:
    """Everything that is tried, the plainest first; nothing that changes nothing."""
    for statement, load in _loads(system):
        other = replace(system, load=load)
        yield Mistake(statement, other, initial, acceleration_of(other))
    for statement, acceleration in _equations(system):
        yield Mistake(statement, system, initial, acceleration)
    for statement, state in _starts(initial):
        yield Mistake(statement, system, state, acceleration_of(system))
    seen = [np.asarray(system.body.inertia, dtype=float)]
    for statement, tensor in mistaken_inertias(system.body, system):
        size = float(np.max(np.abs(tensor)))
        if not any(np.allclose(tensor, known, rtol=0.0, atol=1e-9 * size) for known in seen):
            seen.append(tensor)
            other = replace(system, bodies=(replace(system.body, inertia=tensor),))
            yield Mistake(statement, other, initial, acceleration_of(other))


def _loads(system: System) -> Iterator[tuple[str, Load]]:
    load = system.load
    for name, value in (
        ("gravity", load.gravity),
        ("the torque in body axes", load.torque_body),
        ("the torque in world axes", load.torque_world),
        ("the damping", load.damping),
    ):
        if not np.any(value):
            continue
        field = {"gravity": "gravity", "the damping": "damping"}.get(
            name, "torque_body" if "body" in name else "torque_world"
        )
        for text, factor in (("left out", 0.0), ("of the wrong sign", -1.0), ("doubled", 2.0)):
            yield f"{name} is {text}", replace(load, **{field: factor * value})
    torques = {"torque_body": load.torque_world, "torque_world": load.torque_body}
    if np.any(load.torque_body) or np.any(load.torque_world):
        yield "the torque is held in the other axes, body for world", replace(load, **torques)
    for axis in range(3):
        for field in ("torque_body", "torque_world"):
            value = np.array(getattr(load, field), dtype=float)
            if value[axis] and np.sum(value != 0.0) > 1:
                value[axis] *= -1.0
                text = f"the torque about {'xyz'[axis]} is of the wrong sign"
                yield text, replace(load, **{field: value})
    if load.pivot is not None:
        c = system.body.center_of_mass
        if np.any(load.pivot != c):
            yield (
                "the centre of mass is mirrored in the pivot",
                replace(load, pivot=2 * c - load.pivot),
            )
        if np.any(load.pivot):
            yield "the pivot is at the body's origin", replace(load, pivot=np.zeros(3))


def _equations(system: System) -> Iterator[tuple[str, AccelerationOf]]:
    inertia, load = moving_inertia(system), system.load
    back, own = inverse(inertia), acceleration_of(system)

    def with_more(more: Callable[[Array], Array]) -> AccelerationOf:
        """With more of omega-dot; the linear acceleration of a free body does not depend on it."""

        def acceleration(state: State) -> Acceleration:
            found = own(state)
            return Acceleration(found.angular + more(state.angular_velocity), found.linear)

        return acceleration

    def gyroscopic(w: Array) -> Array:
        return np.asarray(apply(back, cross(w, apply(inertia, w))))

    moments = np.linalg.eigvalsh(np.asarray(inertia, dtype=float))
    if np.ptp(moments) > 0.0:
        yield "the gyroscopic term is missing", with_more(gyroscopic)
        yield "the gyroscopic term has the wrong sign", with_more(lambda w: 2.0 * gyroscopic(w))
    if np.any(load.damping):
        as_rate = "the damping is taken as a rate: omega-dot has -d omega"
        yield as_rate, with_more(lambda w: load.damping * (apply(back, w) - w))


def _starts(initial: State) -> Iterator[tuple[str, State]]:
    q, w = initial.orientation, initial.angular_velocity
    if norm(q[1:]) > 0.0:
        in_body, in_world = rotate_inverse(q, w), rotate(q, w)
        if np.any(in_body != w):
            text = "the initial omega is taken to be in world axes"
            yield text, replace(initial, angular_velocity=in_body)
            yield "the initial omega is turned by R", replace(initial, angular_velocity=in_world)
        text = "the initial attitude is transposed"
        yield text, replace(initial, orientation=conjugate(q))
        text = "the initial quaternion is read as (x, y, z, w)"
        yield text, replace(initial, orientation=np.roll(q, 1))
        text = "the initial attitude is left out"
        yield text, replace(initial, orientation=np.array([1.0, 0.0, 0.0, 0.0]))
    text = "the initial omega has the wrong sign"
    yield text, replace(initial, angular_velocity=-w)
