"""Why a trace diverges, of equations and systems that are often mistaken: the one that it follows.

Each is solved for itself and compared with the trace. One is named only if it leaves next to
nothing of every channel's error, and no two that differ do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from omegadot.commands.score.measured import Measured, distance, filled
from omegadot.commands.score.wrong_steps import causes_in_steps
from omegadot.diagnosis.equations.candidate import BY_MASS
from omegadot.diagnosis.equations.equation_form import (
    Form,
    accelerations,
    form_of,
    same_form,
    stacked,
)
from omegadot.diagnosis.equations.hypotheses import hypotheses, wrong_form
from omegadot.diagnosis.stepping import trace as diagnosis
from omegadot.diagnosis.wording.kinds import either
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.motion import AccelerationOf, acceleration_of
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import conjugate, rotate, rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.motion import slope_of
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Array, State, System

LEAVES = 1e-3  # of an error, at most; schemes and digits leave something too
SHOWS = 0.05  # of its largest, an error is compared first once it has grown to
MOST_COMPARED = 60  # samples
TURN, MOST_STEPS, FEW = 0.1, 1000, 10  # rad, of a coarse step; of these in all
MOST_NAMED = 3  # of mistakes that make the same motion
COARSE = 1e-2  # of an error, what coarse steps may leave of it
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
    form: Form | None = None


def causes_of_trace(found: Measured) -> list[str]:
    """The mistakes that the trace follows, as sentences; none where several unlike ones fit.

    It follows one from its start, or from each sample to the next, or is stepped by one.
    """
    return _from_the_start(found) or _between_samples(found) or causes_in_steps(found)


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
    for mistake in _likely(found, early, channels):
        if _follows(found, mistake, early, channels) is None:
            continue
        state = _follows(found, mistake, whole, channels)
        if state is not None:
            fitting.append((mistake.statement, state))
    if any(_apart(found, a[1], b[1], whole, wrong) for a, b in pairwise(fitting)):
        return []
    return _named(list(dict.fromkeys(statement for statement, _ in fitting)))


def _named(statements: list[str]) -> list[str]:
    """One sentence of mistakes that make the same motion, which no trace of it tells apart."""
    if len(statements) <= MOST_NAMED:
        return either(statements)
    return [f"{statements[0]}, or one of {len(statements) - 1} others that make the same motion"]


def _likely(found: Measured, rows: Rows, channels: list[str]) -> list[Mistake]:
    """The mistakes that are near the trace at its first samples, all equations side by side."""
    system, initial = found.case.system, found.case.initial
    known = list(mistakes(system, initial))
    equations = [(k, one.form) for k, one in enumerate(known) if one.form is not None]
    rows = rows[np.unique(np.linspace(0, len(rows) - 1, FEW).round().astype(int))]
    times = found.trace.times[rows]
    counts = np.maximum(np.ceil(np.diff(times, prepend=0.0) * found.rate / TURN), 1).astype(int)
    if not equations or int(np.sum(counts)) > MOST_STEPS:
        return known
    lanes = stacked([form for _, form in equations])
    motion = motion_over(system, "com-world", lambda state: accelerations(lanes, state))
    q, v = to_coordinates(system, initial, "com-world")
    q, v = (np.broadcast_to(x, (len(equations), 1, *x.shape)).copy() for x in (q, v))
    states = list[State]()
    for count, length in zip(counts.tolist(), np.diff(times, prepend=0.0).tolist(), strict=True):
        moved = step_through(SCHEMES["munthe-kaas-rk4"], motion, q, v, length / count, count, count)
        q, v = moved.q[-1], moved.v[-1]
        states.append(from_coordinates(system, q, v, "com-world"))
    fields = zip(*(vars(state).values() for state in states), strict=True)
    along = State(*(np.concatenate(values, axis=1) for values in fields))
    far = {
        k
        for lane, (k, _) in enumerate(equations)
        if not _near(found, State(*(f[lane] for f in vars(along).values())), rows, channels)
    }
    return [one for k, one in enumerate(known) if k not in far]


def _near(found: Measured, state: State, rows: Rows, channels: list[str]) -> bool:
    """Whether a motion by coarse steps is as near to the trace as may be worth a finer look."""
    trace = found.trace.at(rows)
    for channel in channels:
        left = distance(found.truth, trace, channel, filled(trace, state), state)
        allowed = COARSE * float(np.max(found.error[channel][rows])) + COARSE**2
        if not np.all(left <= found.bound[channel][rows] + allowed):
            return False
    return True


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
    from scipy.integrate import solve_ivp

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
    """Everything that is tried: the equations that `check` knows, then other starts.

    Nothing that changes nothing, and nothing that is a factor of one mass, which many a number is.
    """
    kept = [form_of(system)]
    for one in hypotheses(system):
        if one.part in diagnosis.LEFT_OUT or one.unlikely or BY_MASS.search(one.text):
            continue
        form = wrong_form([one], system)
        if form is not None and not any(same_form(form, other) for other in kept):
            kept.append(form)
            acceleration = partial(accelerations, form)
            yield Mistake(one.text.strip(), system, initial, acceleration, form)
    for statement, state in _starts(initial):
        yield Mistake(statement, system, state, acceleration_of(system))


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
