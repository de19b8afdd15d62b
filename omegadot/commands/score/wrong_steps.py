"""Why a trace diverges, where its steps are wrong: what acts in them, old numbers, an early end.

The trace is stepped on from each of its samples, as the runs of an engine are; see
`omegadot.diagnosis.stepping.over_runs`.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from omegadot.commands.score.measured import Measured
from omegadot.diagnosis.stepping.kept_run import CHANNELS, LEAST, KeptRun, SchemeOf, likeliest
from omegadot.diagnosis.stepping.over_runs import causes_of_one_run
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION, norm
from omegadot.gates.case import Sweep
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State

EVEN = 1e-6  # relative, of the spacing of samples
STEPS = (1, 2, 4, 5, 10)  # between two samples, in which a scheme is looked for
USUAL = ("semi-implicit-euler", "rk4-quaternion", "implicit-midpoint")
RADIANS, MOST_STEPS = 0.01, 64  # of a step of the motion itself
FIELDS = ("angular_velocity", "orientation", "linear_velocity", "position")


def causes_in_steps(found: Measured) -> list[str]:
    """What makes every step of the trace; none where nothing does, or several do."""
    trace, times = found.trace, found.trace.times
    omega, attitude = trace.angular_velocity, trace.orientation
    wrong = any(np.any(found.error[c] > found.bound[c]) for c in found.error)
    if omega is None or attitude is None or not wrong or len(times) <= LEAST:
        return []
    spacing = float(np.median(np.diff(times)))
    even = np.abs(np.diff(times) - spacing) <= EVEN * spacing
    count = len(times) if even.all() else int(np.argmin(even)) + 1
    if count <= LEAST or np.isnan(omega[:count]).any() or np.isnan(attitude[:count]).any():
        return []
    with np.errstate(all="ignore"):
        for by, run in _candidates(found, spacing, count):
            texts = causes_of_one_run(by, run)
            if texts:
                return texts
    return []


def _candidates(found: Measured, spacing: float, count: int) -> Iterator[tuple[SchemeOf, KeptRun]]:
    """Schemes with steps between samples: by which these are sound, or the first is, or usual ones.

    Last the motion itself, to what short steps of order 4 leave of it.
    """
    ranked = list[tuple[int, int, SchemeOf, KeptRun]]()
    for every in STEPS:
        run = _run(found, spacing, every, count, 0.0)
        one = likeliest([run], least=1)
        if one is not None:
            ranked.append((int(np.count_nonzero(run.sound(one))), -every, one, run))
    ranked.sort(key=lambda each: each[:2], reverse=True)
    tried = {(id(one.scheme), one.coordinates, every) for _, every, one, _ in ranked}
    yield from ((one, run) for _, _, one, run in ranked)
    single = _run(found, spacing, 1, count, 0.0)
    for name in USUAL:
        if (id(SCHEMES[name]), "com-world", -1) not in tried:
            yield SchemeOf(SCHEMES[name], "com-world"), single
    every = max(1, int(np.ceil(spacing * found.rate / RADIANS)))
    if every <= MOST_STEPS and not any(sound >= LEAST for sound, _, _, _ in ranked):
        exact = SchemeOf(SCHEMES["munthe-kaas-rk4"], "com-world")
        yield exact, _run(found, spacing, every, count, RADIANS**4)


def _run(found: Measured, spacing: float, every: int, count: int, left: float) -> KeptRun:
    """The trace as a run of so many steps between samples. left: of the scheme, relative."""
    trace, system = found.trace, found.case.system
    state = State(**{name: values[:count] for name, values in vars(found.state).items()})
    state = State(**{**vars(state), "orientation": normalize(state.orientation)})
    rate = float(np.max(norm(state.angular_velocity)))
    none = np.zeros(len(trace.times))

    def opened(field: str) -> Array:
        given = getattr(trace, field) is not None and not np.isnan(getattr(trace, field)).any()
        both = trace.open.get(field, none)[:count] if given else np.full(count, np.inf)
        return np.asarray(both[1:] + both[:-1] * (1.0 + rate * spacing))

    rounding = ROUNDINGS_PER_EVALUATION * EPS * (every + 1.0) + left
    omega = opened("angular_velocity") + rate * rounding
    speed = float(np.max(norm(state.linear_velocity))) + 1.0
    reach = float(np.max(norm(state.position))) + speed * spacing
    velocity = opened("linear_velocity") + speed * rounding
    bounds = dict(
        zip(
            CHANNELS,
            (
                omega,
                opened("orientation") + spacing * omega + rounding,
                velocity,
                opened("position") + spacing * velocity + reach * rounding,
            ),
            strict=True,
        )
    )
    sweep = Sweep(spacing / every, every * (count - 1), every)
    return KeptRun("trace", system, sweep, trace.times[:count], state, bounds, True)
