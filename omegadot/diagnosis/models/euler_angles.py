"""An attitude that goes through Euler angles, taken by one convention and put together by another.

Three angles a, b, c are those of ``R_i(a) R_j(b) R_k(c)``, of twelve orders of axes. They are put
together in any such order, first to last or last to first, with two exchanged or one negative.
Angles about fixed axes are the same in the opposite order.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION
from omegadot.reference_impl.rotations import attitude_angle, normalize
from omegadot.reference_impl.system import Array

# Those of yaw, pitch and roll first.
ORDERS = sorted(
    ("".join(one) for one in product("XYZ", repeat=3) if one[0] != one[1] != one[2]),
    key=lambda one: (one != "ZYX", one != "XYZ", len(set(one)) < 3, one[0] != "Z", one),
)
# Which angle stands where, and its sign: first to last, last to first, exchanged, one negative.
PLACES = [(0, 1, 2), (2, 1, 0), *(p for p in permutations(range(3)) if p[1] != 1)]
SIGNS = [(1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1)]
CHANGES = [(p, np.array(s)) for s in SIGNS for p in (PLACES if s == SIGNS[0] else PLACES[:2])]
NAMES = "abc"
GENERIC = 8  # attitudes that tell two ways apart
TINY = 1e-9  # of what the middle angle leaves of the others: there these are not known


@dataclass(frozen=True)
class Misread:
    """taken, made: orders of axes.  places, signs: of the angles, as they are put together."""

    taken: str
    made: str
    places: tuple[int, ...]
    signs: Array

    def attitudes(self, q: Array) -> Array:
        """What comes of attitudes (n, 4)."""
        return _attitudes(self.made, self.signs * _angles(self.taken, q)[:, self.places])

    def rounding(self, q: Array, eps: float) -> Array:
        """(n,) rad: how far these are off, most where the first and last axis nearly are one."""
        middle = _angles(self.taken, q)[:, 1]
        known = np.abs(np.sin(middle) if self.taken[0] == self.taken[2] else np.cos(middle))
        return np.asarray(ROUNDINGS_PER_EVALUATION * eps / np.maximum(known, TINY))

    @property
    def text(self) -> str:
        """Both products."""
        taken = _product(self.taken, NAMES)
        names = [
            ("-" if s < 0 else "") + NAMES[k] for k, s in zip(self.places, self.signs, strict=True)
        ]
        return f"the angles a, b, c of {taken} are put together as {_product(self.made, names)}"


def angles_misread(requested: Array, back: Array, eps: float) -> str:
    """The one way that makes all attitudes back (n, 4) of those requested; "" without one.

    Two ways that make the same of every attitude are one.
    """
    worst = int(np.argmax(attitude_angle(requested, back)))
    here, came = requested[worst : worst + 1], back[worst]
    fits = [one for one in _near(here, came, eps) if _fits(one, requested, back, eps)]
    return fits[0].text if fits and _same(fits) else ""


def _near(q: Array, came: Array, eps: float) -> Iterator[Misread]:
    """Those that make one attitude of another (1, 4); the plain ones first."""
    found = list[tuple[int, Misread]]()
    for taken in ORDERS:
        angles = _angles(taken, q)[0]
        changed = np.stack([signs * angles[list(places)] for places, signs in CHANGES])
        bound = float(Misread(taken, taken, (0, 1, 2), np.ones(3)).rounding(q, eps)[0])
        for made in ORDERS:
            apart = attitude_angle(_attitudes(made, changed), came)
            for k in np.flatnonzero(apart <= bound):
                found.append((int(k), Misread(taken, made, *CHANGES[k])))
    yield from (one for _, one in sorted(found, key=lambda pair: pair[0]))


def _fits(one: Misread, requested: Array, back: Array, eps: float) -> bool:
    apart = attitude_angle(one.attitudes(requested), back)
    return bool(np.all(apart <= one.rounding(requested, eps)))


def _same(ways: Sequence[Misread]) -> bool:
    """Whether all make the same of attitudes that are no special ones."""
    q = normalize(np.random.default_rng(0).normal(size=(GENERIC, 4)))
    made = [one.attitudes(q) for one in ways]
    return all(float(np.max(attitude_angle(one, made[0]))) <= TINY for one in made)


def _angles(order: str, q: Array) -> Array:
    from scipy.spatial.transform import Rotation  # its import takes as long as half of a command's

    return np.asarray(Rotation.from_quat(np.roll(q, -1, axis=-1)).as_euler(order))


def _attitudes(order: str, angles: Array) -> Array:
    from scipy.spatial.transform import Rotation

    made = Rotation.from_euler(order, angles).as_quat()
    return np.asarray(np.roll(made, 1, axis=-1))


def _product(order: str, names: Sequence[str]) -> str:
    return " ".join(f"R_{x}({name})" for x, name in zip(order.lower(), names, strict=True))
