"""A limit that holds omega, the velocity or the place in every step, by one number in all runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.step_ends import End, with_end
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product, turn_in_body
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

SCENARIOS = 2  # at least, that come to the limit
NEAR = 1e-6  # relative to the largest in a run: a number that is at the limit
LEAST = 2  # samples of a run at the limit
MISSED = 0.01  # of the intervals that are wrong without the limit, which may be rounded otherwise
QUANTITIES = (
    ("angular_velocity", "omega", "rad/s"),
    ("linear_velocity", "the linear velocity", "m/s"),
    ("position", "the position", "m"),
)
PITCH = "the pitch of R_z(yaw) R_y(pitch) R_x(roll) is held within {} rad either way"
BODIES = {
    "": (False, True),
    ", but only where the body is free": (False,),
    ", but only where the body is pivoted": (True,),
}
OF_TURNING = ("angular_velocity", "orientation")  # which a pivoted body has as well
MOVES_AFTER = ("semi-implicit-euler",)  # the place moves by the velocity of the end of the step


@dataclass(frozen=True)
class _Law:
    """size: what is held, of (n, 3) values; the greatest of it is the limit.

    hold: values (n, 3) brought within a limit.  text: with {} for it, and whether it has the other
    sign there.
    """

    field: str
    size: Callable[[Array], Array]
    hold: Callable[[Array, float], Array]
    text: str
    sign: float = 1.0


def limit_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """Each limit by which the scheme leads from every sample to the next, in the runs of all.

    What holds one run within a limit is often another quantity's limit as well, by another number.
    """
    free = by.coordinates == "com-world"  # in others, the velocity that is held is another
    plain: dict[int, NDArray[np.bool_]] = {}
    for (bodies, pivoted), laws in product(BODIES.items(), (_laws, _both_ways)):
        found = [
            f"{law.text.format(number)}{bodies}"
            for law in laws()
            if free or law.field in OF_TURNING
            for limit, number in _limits(law, runs, pivoted)
            if _holds(law, limit, by, runs, pivoted, plain)
        ]
        if found:
            return found
    return []


def _laws() -> Iterator[_Law]:
    for field, what, unit in QUANTITIES:
        if field != "position":
            yield _Law(field, norm, _shortened, f"{what} is held below {{}} {unit}")
            text = f"each component of {what} is held within {{}} {unit}"
            yield _Law(field, _largest, lambda x, most: np.clip(x, -most, most), text)
        for axis in range(3):
            for sign, side in ((1.0, "below"), (-1.0, "above")):
                text = f"{what} along {'xyz'[axis]} is held {side} {{}} {unit}"
                yield _Law(field, _along(axis, sign), _cut(axis, sign), text, sign)


def _both_ways() -> Iterator[_Law]:
    """Of one component, looked for where no limit on one side makes the runs; and of the pitch."""
    yield _Law("orientation", _pitch_size, _within_pitch, PITCH)
    for (field, what, unit), axis in product(QUANTITIES, range(3)):
        text = f"{what} along {'xyz'[axis]} is held within {{}} {unit} either way"
        yield _Law(field, _size_along(axis), _within(axis), text)


def _largest(values: Array) -> Array:
    return np.asarray(np.max(np.abs(values), axis=-1))


def _along(axis: int, sign: float) -> Callable[[Array], Array]:
    return lambda values: sign * values[..., axis]


def _cut(axis: int, sign: float) -> Callable[[Array, float], Array]:
    def hold(values: Array, most: float) -> Array:
        cut = values.copy()
        cut[..., axis] = sign * np.minimum(sign * values[..., axis], most)
        return cut

    return hold


def _size_along(axis: int) -> Callable[[Array], Array]:
    return lambda values: np.abs(values[..., axis])


def _within(axis: int) -> Callable[[Array, float], Array]:
    def hold(values: Array, most: float) -> Array:
        cut = values.copy()
        cut[..., axis] = np.clip(values[..., axis], -most, most)
        return cut

    return hold


def _pitch(q: Array) -> Array:
    w, x, y, z = np.moveaxis(q, -1, 0)
    return np.asarray(np.arcsin(np.clip(2.0 * (w * y - x * z), -1.0, 1.0)))


def _pitch_size(q: Array) -> Array:
    return np.abs(_pitch(q))


def _within_pitch(q: Array, most: float) -> Array:
    """The same yaw and roll, with a pitch within the limit; as it is where it is within."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    yaw = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    roll = np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = np.clip(_pitch(q), -most, most)
    axes = [np.zeros((*pitch.shape, 3)) for _ in range(3)]
    for k, angle in enumerate((roll, pitch, yaw)):
        axes[k][..., k] = angle
    about_x, about_y, about_z = map(exp_quaternion, axes)
    made = quaternion_product(about_z, quaternion_product(about_y, about_x))
    return np.where((_pitch_size(q) > most)[..., None], made, q)


def _shortened(values: Array, most: float) -> Array:
    with np.errstate(all="ignore"):
        return np.asarray(values * np.minimum(1.0, most / norm(values))[..., None])


def _shows(law: _Law, run: KeptRun, pivoted: Sequence[bool]) -> bool:
    """Whether a limit of this quantity would act: on a pivot, places follow from the turning."""
    on_pivot = run.system.load.pivot is not None
    return on_pivot in pivoted and not (on_pivot and law.field not in OF_TURNING)


def _limits(
    law: _Law, runs: Sequence[KeptRun], pivoted: Sequence[bool]
) -> Iterator[tuple[float, str]]:
    """The greatest number of all runs, where several scenarios come to it and stay; and as text."""
    shown = [run for run in runs if _shows(law, run, pivoted)]
    sizes = [law.size(getattr(run.state, law.field)) for run in shown]
    most = max((float(np.max(size[1:])) for size in sizes), default=np.inf)
    there = set[str]()
    for run, size in zip(shown, sizes, strict=True):
        at = np.abs(size - most) <= NEAR * float(np.max(np.abs(size)))
        if run.fails and not at[0] and np.count_nonzero(at) >= LEAST:
            there.add(run.name)
    if len(there) >= SCENARIOS and np.isfinite(most):
        yield most, written(law.sign * most)


def _holds(
    law: _Law,
    limit: float,
    by: SchemeOf,
    runs: Sequence[KeptRun],
    pivoted: Sequence[bool],
    plain: dict[int, NDArray[np.bool_]],
) -> bool:
    """Whether the limit makes all intervals. plain: which are sound without one, by run."""
    for end in _ends(law, limit, by):
        held = replace(by, scheme=with_end(by.scheme, end))
        missed = wrong = 0
        for number, run in sorted(enumerate(runs), key=lambda pair: not pair[1].fails):
            if number not in plain:
                plain[number] = run.sound(by)
            sound = run.sound(held) if _shows(law, run, pivoted) else plain[number]
            wrong += int(np.count_nonzero(~plain[number]))
            missed += int(np.count_nonzero(~sound & ~plain[number]))
            if np.any(plain[number] & ~sound) or missed > MISSED * wrong:
                break
        else:
            if wrong:
                return True
    return False


def _ends(law: _Law, limit: float, by: SchemeOf) -> Iterator[End]:
    """What is held at the end of each step; or before the place moves by it."""

    def held(before: State, after: State, h: float | Array) -> State:
        values = getattr(after, law.field)
        return replace(after, **{law.field: law.hold(values, limit)} if values.size else {})

    def moved(before: State, after: State, h: float | Array) -> State:
        end = held(before, after, h)
        if law.field == "angular_velocity":
            turned = turn_in_body(before.orientation, end.angular_velocity, h)
            return replace(end, orientation=turned)
        return replace(end, position=before.position + h * end.linear_velocity)

    yield held
    if by.scheme.name in MOVES_AFTER and law.field not in ("position", "orientation"):
        yield moved
