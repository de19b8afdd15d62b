"""Whether a run follows a wrong equation: its beginning next to the exact solutions of both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.stepping.restep import on_rows
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, common_factor
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import attitude_angle, rotation_between
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Acceleration, Array, State, System

SAMPLES = 12
RADIANS, MOST_STEPS = 0.1, 80  # of a step here; over the whole beginning
Followed = Literal["wrong", "right", "between"]
BETWEEN = 0.2  # by how much the distances to both may add up to another than their own
NEAR, FAR = 0.3, 0.7  # of the distance of the two solutions
GROWS, CLEAR = 3.0, 0.05  # of the part of that distance which a run that leaves a solution has left
CONVERGED = 0.1  # of the distance of the two solutions
STAYS = 4.0  # times the angle that a run begins at
SEEN = 1e-4  # relative: what the steps here leave


@dataclass(frozen=True)
class Beginning:
    """The first samples of a run of a system, and the exact solution there. times: (n,) s.

    steps: to the last of them.
    """

    system: System
    times: Array
    reported: State
    exact: State
    steps: int = 0


def follows(beginning: Beginning, candidate: Candidate, eps: float) -> Followed | None:
    """Which equation a run follows, or whether it lies between the two; None where it is open.

    A scheme's own error is small against the distance of the two where the answer is given.
    """
    system, times = beginning.system, beginning.times
    if len(times) < 3:
        return None
    rate = float(np.max(norm(beginning.exact.angular_velocity)))
    counts = np.maximum(np.ceil(np.diff(times) * rate / RADIANS), 1).astype(int)
    kept = int(np.searchsorted(np.cumsum(counts), MOST_STEPS, side="right"))
    if kept < 2:
        return None
    wrong = _solved(system, beginning, candidate, counts[:kept], eps)
    if wrong is None:
        return None
    reported, exact = (x[1 : kept + 1] for x in (beginning.reported, beginning.exact))
    found = dict[float, Followed | None]()
    names = ("angular_velocity", "linear_velocity")
    for name in names[: 1 if system.load.pivot is not None else 2]:
        near, far, came = (getattr(x, name) for x in (exact, wrong, reported))
        apart, size = norm(far - near), float(np.max(norm(near)) + np.max(norm(far)))
        used = apart > max(SEEN * size, 0.1 * float(np.max(apart)))
        if not used.any() or not np.isfinite(came[used]).all():
            continue
        to_wrong, to_right = (
            float(np.median(norm(came - x)[used] / apart[used])) for x in (far, near)
        )
        answer: Followed | None = None
        # a scheme's own error is as large a part of the distance at every sample
        parts = (norm(came - far) / apart)[used]
        if to_wrong < NEAR:
            leaves = len(parts) > 2 and parts[-1] > GROWS * max(parts[0], parts[1])
            answer = "between" if leaves and parts[-1] > CLEAR else "wrong"
        elif to_right < NEAR and to_wrong > FAR:
            answer = "right"
        elif abs(to_wrong + to_right - 1.0) < BETWEEN:
            answer = "between" if parts[0] < NEAR and parts[-1] > FAR else None
        if answer in ("right", "between"):
            # of a wrong equation that is stiff the steps here may be far from its solution
            finer = _solved(system, beginning, candidate, 2 * counts[:kept], eps)
            left = None if finer is None else norm(getattr(finer, name) - far)[used] / apart[used]
            answer = answer if left is not None and np.max(left) < CONVERGED else None
        found[float(np.max(apart)) / size] = answer
    return found[max(found)] if found else None


def keeps_pace(beginning: Beginning, steps: VanishingSteps) -> bool:
    """Whether the samples after the first go on as much too fast, or too slowly, as first steps do.

    By how far the attitude turns from sample to sample, next to the exact motion.
    """
    k = common_factor(steps.rates)
    with np.errstate(all="ignore"):
        came, due = (
            norm(rotation_between(x.orientation[1:-1], x.orientation[2:]))
            for x in (beginning.reported, beginning.exact)
        )
        pace = float(np.median(came / due)) if len(came) else np.nan
    return k is None or not np.isfinite(pace) or abs(pace - 1.0) > NEAR * abs(k - 1.0)


def begins_turned(beginning: Beginning, angle: float) -> bool:
    """Whether a run stays as far off as it begins, in rad: if every step turned it, it would not.

    What every step adds grows as the root of their number at least.
    """
    with np.errstate(all="ignore"):
        off = attitude_angle(beginning.exact.orientation, beginning.reported.orientation)[1:]
    return beginning.steps > (2.0 * STAYS) ** 2 and bool(np.all(off < STAYS * angle))


def _solved(
    system: System, beginning: Beginning, candidate: Candidate, counts: Array, eps: float
) -> State | None:
    """(n, ...): the wrong equation's solution at the samples after the first."""

    def acceleration(states: State) -> Acceleration:
        none = np.zeros_like(states.angular_velocity)
        ones = np.ones(len(none))
        at = Evidence("", system, states, Acceleration(none, none), ones, ones, eps)
        found = candidate.predicted(at)
        if found is None:
            raise ValueError("no equation")
        return found

    motion = motion_over(system, "com-world", on_rows(acceleration))
    q, v = to_coordinates(system, beginning.reported[0], "com-world")
    scheme, samples = SCHEMES["munthe-kaas-rk4"], []
    try:
        for count, length in zip(counts, np.diff(beginning.times), strict=False):
            stepped = step_through(scheme, motion, q, v, length / count, int(count), int(count))
            q, v = stepped.q[-1], stepped.v[-1]
            samples.append(from_coordinates(system, q, v, "com-world"))
    except (ValueError, np.linalg.LinAlgError):
        return None
    columns = zip(*(vars(one).values() for one in samples), strict=True)
    return State(*map(np.stack, columns))
