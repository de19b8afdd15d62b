"""Which products of inertia have to be there for something to be wrong."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from omegadot.diagnosis.wording.digits import listed
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import System

NOTHING = 1e-12  # of the largest moment
LITTLE = 1e-5  # of it: what goes as two of these is lost in rounding
NAMES = ("xy", "xz", "yz")
ANY = "the inertia has products"


def where_products(wrong: Sequence[System], right: Sequence[System]) -> str:
    """``, but only where the products xy and xz are not zero``; "" where nothing sorts them."""
    failing, sound = (
        [known for one in systems if (known := _products(one)) is not None]
        for systems in (wrong, right)
    )
    if not failing or not sound:
        return ""
    found = list[str]()
    for count in (1, 2, 3):
        for chosen in combinations(range(3), count):
            for together in (all, any)[: 1 + (count > 1)]:
                shows = [together(one[k] for k in chosen) for one in (*failing, *sound)]
                if all(shows[: len(failing)]) and not any(shows[len(failing) :]):
                    found.append(_text([NAMES[k] for k in chosen], together is all))
    if len(found) > 1:
        found = [ANY] if found[-1] == ANY else []
    return f", but only where {found[0]}" if found else ""


def _products(system: System) -> list[bool] | None:
    """Whether each is there; None where one is too small to show."""
    tensor = np.asarray(moving_inertia(system), dtype=float)
    sizes = np.abs(tensor[[0, 0, 1], [1, 2, 2]]) / float(np.max(tensor))
    if np.any((sizes > NOTHING) & (sizes < LITTLE)):
        return None
    return [bool(size > NOTHING) for size in sizes]


def _text(names: Sequence[str], every: bool) -> str:
    if len(names) == 3 and not every:
        return ANY
    if len(names) == 1:
        return f"the product of inertia {names[0]} is not zero"
    if every:
        return f"the products of inertia {listed(names)} are not zero"
    return f"the product of inertia {' or '.join(names)} is not zero"
