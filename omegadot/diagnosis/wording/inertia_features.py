"""What holds of a system's inertia exactly: equal moments, their order, the hand of its axes.

Each is said of the inertia about what stays and of that about the centre of mass, which are one for
a free body. They are many, and most are even odds: what they sort must be far from chance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import comb

import numpy as np

from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System

EQUAL = 1e-12  # of the largest moment, by how much others differ from it by rounding
ODDS = 20  # as many times as conditions are tried must there be ways to sort the scenarios
ABOUT = (" about what stays", " about the centre of mass")
# Of a sentence, whether it holds about what stays and about the centre of mass; None if undefined.
OfInertia = Mapping[str, tuple[bool | None, bool | None]]
OPPOSITE = {"are left-handed": "are right-handed", "is diagonal": "is not diagonal"}


def inertia_features(system: System) -> OfInertia:
    """By sentence, with a place in it for what the inertia is about."""
    stays = dict(_holds(np.asarray(moving_inertia(system), dtype=float)))
    if system.load.pivot is None:
        return {text: (one, one) for text, one in stays.items()}
    center = dict(_holds(np.asarray(system.body.inertia, dtype=float)))
    return {text: (stays[text], center[text]) for text in stays}


def _holds(tensor: Array) -> Iterator[tuple[str, bool | None]]:
    names, kept = ("Ixx", "Iyy", "Izz"), np.diag(tensor)
    near = EQUAL * float(np.max(kept))
    pairs = ((0, 1), (0, 2), (1, 2))
    equal = [bool(abs(kept[i] - kept[j]) <= near) for i, j in pairs]
    moments, axes = np.linalg.eigh(tensor)
    twice = bool(np.min(np.diff(moments)) <= near)
    diagonal = bool(np.max(np.abs(tensor - np.diag(kept))) <= near)
    for (i, j), same in zip(pairs, equal, strict=True):
        yield f"{names[i]} and {names[j]}{{}} are equal", same
    yield "two of Ixx, Iyy and Izz{} are equal", any(equal)
    yield "two principal moments{} are equal", twice
    yield "the inertia{} is diagonal", diagonal
    others = np.linalg.eig(tensor)[1]
    for solver, found in (("eigh", axes), ("eig", others)):
        # of equal moments that stand off the diagonal rounding chooses the axes
        left = None if twice and not diagonal else bool(np.linalg.det(np.real(found)) < 0.0)
        yield f"the axes that numpy.linalg.{solver} gives of the inertia{{}} are left-handed", left
    for k, name in enumerate(names):
        for end, sign in (("largest", 1.0), ("least", -1.0)):
            before = sign * kept[k] - float(np.max(sign * np.delete(kept, k)))
            # of two that are as large either may be taken
            first = None if abs(before) <= near else before > 0.0
            yield f"{name}{{}} is the {end} on the diagonal", first


def inertias_in_common(
    shown: Sequence[OfInertia],
    others: Sequence[OfInertia],
    tried: Sequence[tuple[OfInertia, bool]],
) -> list[str]:
    """What holds of the inertia of all that show a fault and of none of the others, or opposite.

    tried: further systems, each with whether it shows the fault; none may contradict it.
    """
    found = list[str]()
    for text in shown[0]:
        holds = [_sorts(text, k, shown, others, tried) for k in (0, 1)]
        texts = {
            about: _worded(text, about, wanted)
            for about, wanted in zip(ABOUT, holds, strict=True)
            if wanted is not None
        }
        if len(texts) == 2 and holds[0] is holds[1]:
            found.append(_worded(text, "", bool(holds[0])))
        else:
            found += texts.values()
    return found


def _worded(text: str, about: str, holds: bool) -> str:
    text = text.format(about)
    if holds:
        return text
    end = next((one for one in OPPOSITE if text.endswith(one)), "")
    return text.removesuffix(end) + OPPOSITE[end] if end else f"it does not hold that {text}"


def _sorts(
    text: str,
    k: int,
    shown: Sequence[OfInertia],
    others: Sequence[OfInertia],
    tried: Sequence[tuple[OfInertia, bool]],
) -> bool | None:
    """Whether it holds of all that show a fault; None where it does not sort all systems."""
    here, there = ([h for one in g if (h := one[text][k]) is not None] for g in (shown, others))
    ways = comb(len(here) + len(there), len(here))
    if len(set(here)) != 1 or len(set(there)) != 1 or here[0] is there[0]:
        return None
    # each may hold or not, of two inertias
    if ways < ODDS * 4 * len(shown[0]):
        return None
    known = [(h, wrong) for one, wrong in tried if (h := one[text][k]) is not None]
    return here[0] if all((h is here[0]) is wrong for h, wrong in known) else None
