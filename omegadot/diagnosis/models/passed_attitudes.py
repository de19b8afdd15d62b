"""What becomes of an attitude that goes through other numbers and is rebuilt from them wrongly.

A component of the quaternion as the root of what the others leave is without its sign; an angle
about the axis, or one of three angles about axes, is of one branch of its function alone. The sign
of a whole quaternion, which is one attitude, is none of these.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array

Map = Callable[[Array, float], Array]
NAMES = "wxyz"
ORDERS = sorted(
    ("".join(one) for one in product("ZYX", repeat=3) if one[0] != one[1] != one[2]),
    key=lambda one: (len(set(one)) < 3, one != "ZYX"),
)
FOLDS: dict[str, Map] = {
    "atan, without its quadrant": lambda angle, _: np.arctan(np.tan(angle)),
    "asin, which is a quarter turn at most": lambda angle, more: np.arcsin(
        np.clip((1.0 + more) * np.sin(angle), -1.0, 1.0)
    ),
}
ROUNDED = 4.0 * EPS
UNEVENLY = np.array([0.7, -1.0, 0.5, 1.0])
TINY = np.finfo(float).tiny
INVERSE = (
    "the quaternion's scalar is rebuilt from its vector part, without its sign: where it would be "
    "negative the attitude becomes the inverse"
)


@dataclass(frozen=True)
class Passed:
    """What is rebuilt wrongly, and a unit quaternion (..., 4) after it.

    change: of the quaternion and of how much more of it the numbers in between are.
    """

    text: str
    change: Map

    def made(self, q: Array) -> Array:
        """What comes of attitudes."""
        return self.change(q, 0.0)

    def rounded(self, q: Array, sign: float) -> Array:
        """The same where each number is another within rounding, all larger or smaller."""
        more = sign * ROUNDED
        return self.change((1.0 + more) * (q + more * UNEVENLY), more)


def passed_attitudes() -> Iterator[list[Passed]]:
    """The plain ones first."""
    yield [Passed(_of_root(k), _by_root(k)) for k in range(4)] + [*_of_angle()]
    signed = [
        Passed(_of_root(k, f", once {NAMES[j]} is made positive"), _by_root(k, j))
        for k, j in permutations(range(4), 2)
    ]
    largest = "the quaternion's largest component is rebuilt from the others, without its sign"
    yield [*signed, Passed(largest, _by_largest_root)]
    yield [*_of_angles()]


def _of_root(k: int, first: str = "") -> str:
    if k == 0 and not first:
        return INVERSE
    what, others = ("scalar", "its vector part") if k == 0 else (NAMES[k], "the other components")
    return f"the quaternion's {what} is rebuilt from {others}, without its sign{first}"


def _by_root(k: int, positive: int | None = None) -> Map:
    def made(q: Array, more: float) -> Array:
        signed = q if positive is None else np.where(q[..., positive : positive + 1] < 0, -q, q)
        found = _with_root(signed, np.eye(4, dtype=bool)[k])
        if k or not more:
            return found
        # the same by an angle is known to as little as the acos of the scalar
        half = np.arccos(np.clip((1.0 + more) * found[..., 0], -1.0, 1.0))
        return _turned(found, half)

    return made


def _by_largest_root(q: Array, _: float) -> Array:
    return _with_root(q, np.argmax(np.abs(q), axis=-1)[..., None] == np.arange(4))


def _with_root(q: Array, here: Array) -> Array:
    """With the one component here the root of what the others leave."""
    others = np.where(here, 0.0, q)
    left = 1.0 - np.sum(others * others, axis=-1, keepdims=True)
    return np.where(here, np.sqrt(np.maximum(left, 0.0)), q)


def _of_angle() -> Iterator[Passed]:
    """A turn about an axis, from none to twice a half turn as the quaternion's sign has it."""
    whole = "the attitude's axis and angle"
    for how, fold in FOLDS.items():
        yield Passed(f"{whole} are rebuilt with the angle by {how}", _about_axis(fold))
    over = "where the angle is above a half turn,"
    yield Passed(
        f"{over} a half turn is taken from it, not a whole one",
        _about_axis(lambda angle, _: np.where(angle > np.pi, angle - np.pi, angle)),
    )
    yield Passed(f"{over} it is cut off there", _about_axis(lambda a, _: np.minimum(a, np.pi)))


def _about_axis(change: Map) -> Map:
    def made(q: Array, more: float) -> Array:
        return _turned(q, 0.5 * change(2.0 * np.arctan2(norm(q[..., 1:]), q[..., 0]), more))

    return made


def _turned(q: Array, half: Array) -> Array:
    """By these halves of an angle (...) about the axes of q."""
    axis = q[..., 1:] / np.maximum(norm(q[..., 1:]), TINY)[..., None]
    return np.concatenate((np.cos(half)[..., None], np.sin(half)[..., None] * axis), axis=-1)


def _of_angles() -> Iterator[Passed]:
    """Three angles, the middle one of its whole range; of R_z R_y R_x it is the pitch."""
    for order, (how, fold) in product(ORDERS, FOLDS.items()):
        twice = order[0] == order[2]  # the middle angle is then up to a half turn
        for places in ((0,), (2,), (0, 2), *(((1,),) if twice else ())):
            names = " and ".join("abc"[k] for k in places)
            turns = " ".join(f"R_{x.lower()}({n})" for x, n in zip(order, "abc", strict=True))
            verb = "are" if len(places) > 1 else "is"
            text = f"the attitude is rebuilt as {turns}, where {names} {verb} taken by {how}"
            yield Passed(text, _through_angles(order, places, fold))


def _through_angles(order: str, places: tuple[int, ...], fold: Map) -> Map:
    def made(q: Array, more: float) -> Array:
        from scipy.spatial.transform import Rotation  # its import takes long

        known = np.all(np.isfinite(q), axis=-1, keepdims=True)
        unit = np.where(known, normalize(q), np.array([1.0, 0.0, 0.0, 0.0]))
        flat = np.roll(unit.reshape(-1, 4), -1, axis=-1)
        angles = Rotation.from_quat(flat).as_euler(order, suppress_warnings=True)
        for k in places:
            angles[:, k] = fold(angles[:, k], more)
        rebuilt = np.roll(Rotation.from_euler(order, angles).as_quat(), 1, axis=-1)
        return np.where(known, rebuilt.reshape(q.shape), np.nan)

    return made
