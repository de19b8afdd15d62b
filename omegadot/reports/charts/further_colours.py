"""Colours for as many engines as a report has, each as far from the others as it can be.

The next colour is that candidate whose least distance to those in use is the largest, over both
themes and three kinds of sight. So a colour depends on those before it alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np

from omegadot.reference_impl.system import Array

Pair = tuple[str, str]  # light, dark
# Ottosson's OKLab (2020) to the linear parts of sRGB.
TO_CONES = np.array(
    [
        [1, 0.3963377774, 0.2158037573],
        [1, -0.1055613458, -0.0638541728],
        [1, -0.0894841775, -1.291485548],
    ]
)
TO_RGB = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.707614701],
    ]
)
# Linear sRGB to XYZ in parts of D65's white; as protanopes and deuteranopes see linear sRGB
# (Viénot, Brettel and Mollon 1999).
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = np.array([0.9505, 1.0, 1.089])
SIGHTS = np.array(
    [
        np.eye(3),
        [[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]],
        [[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]],
    ]
)
HUES = np.radians(np.arange(0, 360, 10))
CHROMAS = (0.04, 0.09, 0.14, 0.2)
# OKLab's lightness in the light theme and in the dark one: 3:1 or more against the page.
LIGHTNESSES = ((0.35, 0.62), (0.45, 0.70), (0.55, 0.78), (0.62, 0.88))


def further_colours(used: Sequence[Pair], count: int) -> list[Pair]:
    """`count` more pairs of colours, none of which is among those used."""
    known, places = _candidates()
    nearest = np.full(len(known), np.inf)
    for own in _seen(list(used)):
        nearest = np.minimum(nearest, _apart(places, own))
    found: list[Pair] = []
    for _ in range(count):
        best = int(np.argmax(nearest))
        found.append(known[best])
        nearest = np.minimum(nearest, _apart(places, places[best]))
    return found


@cache  # every page asks for them
def _candidates() -> tuple[tuple[Pair, ...], Array]:
    """Pairs of one hue and chroma that a screen can show in both themes, and what is seen of them.

    Shape (n, 6, 3), as of `_seen`.
    """
    found = []
    for light, dark in LIGHTNESSES:
        for chroma in CHROMAS:
            for hue in HUES:
                a, b = chroma * np.cos(hue), chroma * np.sin(hue)
                both = [
                    (np.array([one, a, b]) @ TO_CONES.T) ** 3 @ TO_RGB.T for one in (light, dark)
                ]
                if all(np.all((part >= 0.0) & (part <= 1.0)) for part in both):
                    found.append((_hex(both[0]), _hex(both[1])))
    return tuple(found), _seen(found)


def _hex(linear: Array) -> str:
    curved = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return "#" + "".join(f"{round(255 * float(part)):02x}" for part in curved)


def _seen(pairs: Sequence[Pair]) -> Array:
    """(n, 6, 3): CIELAB of each pair, by theme and sight."""
    digits = np.array(
        [[[int(c[k : k + 2], 16) for k in (1, 3, 5)] for c in pair] for pair in pairs]
    )
    parts = digits.reshape(len(pairs), 2, 3) / 255.0
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    seen = np.einsum("sij,ntj->ntsi", SIGHTS, linear).clip(0.0)
    share = seen @ TO_XYZ.T / WHITE
    x, y, z = np.moveaxis(
        np.where(share > 0.008856, np.cbrt(share), 7.787 * share + 16 / 116), -1, 0
    )
    lab = np.stack((116 * y - 16, 500 * (x - y), 200 * (y - z)), axis=-1)
    return lab.reshape(len(pairs), 6, 3)


def _apart(places: Array, own: Array) -> Array:
    """(n,): CIE76, the least over themes and sights."""
    least: Array = np.min(np.linalg.norm(places - own, axis=-1), axis=-1)
    return least
