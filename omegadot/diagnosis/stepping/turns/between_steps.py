"""What the attitude goes through between two steps, where it is rebuilt wrongly, in all runs.

Each hypothesis is a lane, in which every step is the scheme's and the attitude is changed before
it, after it, or both. Beside it are two of attitudes that rounding makes: what is rebuilt as a
root or an angle may be known to few digits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.models.passed_attitudes import Passed, passed_attitudes
from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array, State

BETWEEN = "between steps "
MOST_STEPS = 16  # between two samples
MORE = 8  # intervals after the first that is wrong, in which all are tried
CLEAR = 1e-6  # rad, of what rounding makes of an attitude that shows what it is


@dataclass(frozen=True)
class _Lane:
    """An attitude that is passed before every step, after it, or both.

    It is after where the samples have it, before where they do not, and both where the state that
    a run is given is passed as well.
    """

    passed: Passed
    before: bool
    after: bool


def between_steps(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The attitude that makes every interval of all runs; none where none does.

    It stands alone where several do of which one is plain.
    """
    near = sorted((r for r in runs if r.sweep.every <= MOST_STEPS), key=lambda r: r.sweep.every)
    first = next(((run, ~run.sound(by)) for run in near if run.fails and not _whole(run, by)), None)
    if first is None:
        return []
    begun = _begun(first[0], int(np.argmax(first[1])) + MORE)
    for group in passed_attitudes():
        lanes = [_Lane(p, *w) for w in ((False, True), (True, False), (True, True)) for p in group]
        lanes = _making(lanes, begun, by)
        for run in near if lanes else ():
            lanes = _making(lanes, run, by)
            if not lanes:
                break
        texts = dict.fromkeys(one.passed.text for one in lanes if _shows(one, near, by))
        if texts:
            found = [f"{BETWEEN}{text}" for text in texts]
            return either(found) if len(found) <= MOST_NAMED else []
    return []


def passes_between(text: str, by: SchemeOf, run: KeptRun) -> bool:
    """Whether what a text of `between_steps` names makes every interval of this run as well."""
    known = [one for group in passed_attitudes() for one in group if text == BETWEEN + one.text]
    ways = ((False, True), (True, False), (True, True))
    return bool(_making([_Lane(one, *way) for one in known for way in ways], run, by))


def _whole(run: KeptRun, by: SchemeOf) -> bool:
    return bool(run.sound(by).all())


def _shows(lane: _Lane, runs: Sequence[KeptRun], by: SchemeOf) -> bool:
    """Whether an interval that is not the scheme's is made by it, where rounding decides nothing.

    Three numbers of an attitude are then what it makes of them.
    """
    for run in runs:
        off = ~run.sound(by) if run.fails else np.zeros(1, dtype=bool)
        if off.any():
            made, rounding = _made([lane], run, by)
            if np.any(off & made[0] & (rounding["attitude"][0] <= CLEAR)):
                return True
    return False


def _begun(run: KeptRun, count: int) -> KeptRun:
    """Its first intervals."""
    bounds = {channel: values[:count] for channel, values in run.bounds.items()}
    upto = slice(0, count + 1)
    return replace(run, times=run.times[upto], state=run.state[upto], bounds=bounds)


def _making(lanes: list[_Lane], run: KeptRun, by: SchemeOf) -> list[_Lane]:
    """Those that lead from every sample of a run to the next."""
    if not lanes:
        return []
    made, _ = _made(lanes, run, by)
    return [
        lane for lane, good in zip(lanes, np.atleast_1d(made.all(axis=-1)), strict=True) if good
    ]


def _made(
    lanes: Sequence[_Lane], run: KeptRun, by: SchemeOf
) -> tuple[NDArray[np.bool_], dict[str, Array]]:
    """(lanes, n - 1): whether each leads to the next sample; and what rounding makes of it."""
    own = SchemeOf(by.scheme, canonical(run.system, by.coordinates))
    count = len(lanes)

    def passed(q: Array, when: str) -> Array:
        q = q.copy()
        for k, lane in enumerate(lanes):
            if getattr(lane, when):
                q[k, ..., -4:] = lane.passed.made(q[k, ..., -4:])
                for place, sign in ((count + k, 1.0), (2 * count + k, -1.0)):
                    q[place, ..., -4:] = lane.passed.rounded(q[place, ..., -4:], sign)
        return q

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        q, v = own.scheme.step(motion, passed(q, "before"), v, h)
        return passed(q, "after"), v

    with np.errstate(all="ignore"):
        stepped = SchemeOf(replace(own.scheme, step=step), own.coordinates)
        ends = run.ends(stepped, lanes=3 * count)
        here, *beside = (ends[k * count : (k + 1) * count] for k in range(3))
        off, one, other = run.apart(here), *(_between(here, end) for end in beside)
        # what rounding makes in one step may be undone in the next, and add up in another run
        rounding = {c: run.sweep.every * np.maximum(one[c], other[c]) for c in CHANNELS}
        good = [norm(off[c]) <= SLACK * (run.bounds[c] + rounding[c]) for c in CHANNELS]
        return np.asarray(np.all(good, axis=0)), rounding


def _between(one: State, other: State) -> dict[str, Array]:
    """(..., n - 1) per channel: how far such ends are apart."""
    return {
        "omega": norm(one.angular_velocity - other.angular_velocity),
        "attitude": norm(rotation_between(one.orientation, other.orientation)),
        "velocity": norm(one.linear_velocity - other.linear_velocity),
        "position": norm(one.position - other.position),
    }
