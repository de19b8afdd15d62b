"""What the scenarios that show a fault have in common, and the others lack."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import comb

import numpy as np

from omegadot.diagnosis.wording.decided import decided
from omegadot.diagnosis.wording.digits import limits
from omegadot.diagnosis.wording.implied import only_where
from omegadot.diagnosis.wording.inertia_features import (
    EQUAL,
    OfInertia,
    inertia_features,
    inertias_in_common,
)
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.system import State, System

# How unlikely chance must be to sort the scenarios so: one in so many ways to sort them. A kind is
# likely by itself; of a size the limit may lie anywhere, and every size is tried from both sides.
SORTED_BY_KIND, ODDS = 6, 20
MOST_CONDITIONS = 2  # in one sentence
COMPONENT = "has no"  # of a vector
FOLLOWS = {
    "the body is pivoted": ("the pivot lies off the origin", "the body does not move at the start"),
    "the body is free": ("the pivot lies at the origin", "the body moves at the start"),
    "a torque acts": ("a torque in body axes acts", "a torque in world axes acts"),
    "no torque acts": ("no torque in body axes acts", "no torque in world axes acts"),
}


ANY_TORQUE = "a torque acts (applied, of damping or of the weight)"


@dataclass(frozen=True)
class Features:
    """kinds: sentences that hold for a scenario, or do not.  sizes: numbers of it, with units.

    inertia: sentences of its inertia; see `inertia_features`.
    """

    kinds: dict[str, bool]
    sizes: dict[str, tuple[float, str]]
    inertia: OfInertia = field(default_factory=dict)


def _weighs(system: System) -> bool:
    """Whether the weight exerts a torque about a pivot."""
    load = system.load
    return load.pivot is not None and bool(np.any(load.gravity) and np.any(lever(system)))


def features_of(system: System, initial: State) -> Features:
    """Those of one scenario."""
    body, load = system.body, system.load
    tensor, gravity = np.asarray(body.inertia, dtype=float), np.asarray(load.gravity, dtype=float)
    pivoted, pulled = load.pivot is not None, bool(np.any(gravity))
    driven = bool(np.any(load.torque_body)), bool(np.any(load.torque_world))
    products = bool(np.any(np.abs(tensor - np.diag(np.diag(tensor))) > 1e-12 * np.max(tensor)))
    moments = np.linalg.eigvalsh(tensor)
    kinds = {
        "the body is pivoted": pivoted,
        "the body is damped": bool(np.any(load.damping)),
        "a torque acts": any(driven),
        ANY_TORQUE: any(driven) or bool(np.any(load.damping)) or _weighs(system),
        "a torque in body axes acts": driven[0],
        "a torque in world axes acts": driven[1],
        "gravity acts": pulled,
        "gravity points elsewhere than along -z": pulled
        and not (gravity[2] < 0.0 and np.all(gravity[:2] == 0.0)),
        "the centre of mass lies off the origin": bool(np.any(body.center_of_mass)),
        "the inertia has products": products,
        "the moments of inertia are unequal": bool(np.ptp(moments) > EQUAL * moments[-1]),
        "the pivot lies off the origin": pivoted and bool(np.any(load.pivot)),
        "the first attitude is not the identity": bool(abs(initial.orientation[0]) < 1.0 - 1e-12),
        "the scalar part of the first quaternion is negative": bool(initial.orientation[0] < 0.0),
        "the body moves at the start": bool(np.any(initial.linear_velocity)),
    }
    vectors = {
        "gravity": gravity,
        "the torque in body axes": load.torque_body,
        "the torque in world axes": load.torque_world,
        "the centre of mass": body.center_of_mass,
        "the pivot": load.pivot if pivoted else (),
    }
    for what, vector in vectors.items():
        for k, axis in enumerate("xyz"):
            none = bool(np.any(vector)) and float(np.asarray(vector)[k]) == 0.0
            kinds[f"{what} {COMPONENT} {axis} component"] = none
    moving = np.asarray(moving_inertia(system), dtype=float)
    about, held = np.linalg.eigvalsh(moving), np.diag(moving)
    arm = float(norm(lever(system))) if pivoted else 0.0
    mass = float(body.mass)
    sizes = {
        "the mass": (mass, "kg"),
        "the body's radius of gyration": (float(np.sqrt(np.trace(tensor) / mass)), "m"),
        "the trace of the inertia about the centre of mass": (float(np.trace(tensor)), "kg m^2"),
        "the trace of the inertia about what stays": (
            float(np.trace(moving_inertia(system))),
            "kg m^2",
        ),
        "the least moment of inertia": (float(moments[0]), "kg m^2"),
        "the largest moment of inertia": (float(moments[-1]), "kg m^2"),
        "the least moment of inertia about what stays": (float(about[0]), "kg m^2"),
        "the largest moment of inertia about what stays": (float(about[-1]), "kg m^2"),
        "the determinant of the inertia about what stays": (float(np.prod(about)), "kg^3 m^6"),
        "the largest number on the inertia's diagonal": (float(np.max(np.diag(tensor))), "kg m^2"),
        "the ratio of the largest moment of inertia to the least": (
            float(moments[-1] / moments[0]),
            "",
        ),
        "the ratio of the largest moment of inertia about what stays to the least": (
            float(about[-1] / about[0]),
            "",
        ),
        "the ratio of the largest to the least number on the diagonal of the inertia about what "
        "stays": (float(np.max(held) / np.min(held)), ""),
        "the difference of the largest and the least moment of inertia": (
            float(moments[-1] - moments[0]),
            "kg m^2",
        ),
        "|omega| at the start": (float(norm(initial.angular_velocity)), "rad/s"),
        "the linear speed at the start": (float(norm(initial.linear_velocity)), "m/s"),
        "the distance from the pivot to the centre of mass": (arm, "m"),
        "the weight": (mass * float(norm(gravity)), "N"),
        "the largest torque of the weight": (mass * float(norm(gravity)) * arm, "N m"),
        "the size of gravity": (float(norm(gravity)), "m/s^2"),
        "the damping": (float(load.damping), "N m s/rad"),
        "the size of the torque": (
            float(norm(load.torque_body) + norm(load.torque_world)),
            "N m",
        ),
    }
    return Features(kinds, sizes, inertia_features(system))


def ways_of(scenarios: Sequence[Features]) -> int:
    """In how many ways scenarios must be sorted so that by chance one condition in 20 runs does.

    Every kind, or its opposite, and every size, above or below a limit, is one.
    """
    return ODDS * sum(2 * len(one.kinds) + 2 * len(one.sizes) for one in scenarios[:1])


def surely_only_where(
    text: str, shown: Sequence[Features], others: Sequence[Features]
) -> str | None:
    """A cause with the scenarios on which alone it is so; None where that is not known.

    As `in_common`, where no experiment can refute what is chance: of many scenarios alone.
    """
    ways = comb(len(shown) + len(others), len(shown))
    common = in_common(shown, others) if ways >= ways_of(shown) > 0 else []
    if not 0 < len(common) <= MOST_CONDITIONS:
        return None
    return text + only_where(text, " or where ".join(common))


def in_common(
    shown: Sequence[Features],
    others: Sequence[Features],
    tried: Sequence[tuple[Features, bool]] = (),
) -> list[str]:
    """Conditions that hold for all that show a fault and for none of the others, kinds first.

    What holds of the inertia alone is looked at where nothing else does.
    tried: further systems, each with whether it shows the fault; none may contradict a condition.
    None where so few scenarios are sorted by chance.
    """
    if not shown or not others:
        return []
    ways = comb(len(shown) + len(others), len(shown))
    kinds = list[tuple[str, bool]]()
    if ways >= SORTED_BY_KIND:
        for text in shown[0].kinds:
            here, there = ({one.kinds[text] for one in group} for group in (shown, others))
            if here != there and len(here) == len(there) == 1:
                kinds.append((text, True in here))
    # a single component is looked at where nothing plainer holds
    plain = [one for one in kinds if COMPONENT not in one[0]]
    kinds = plain or [(text, holds) for text, holds in kinds if holds]
    every = [(one.kinds, wrong) for one, wrong in tried]
    texts = [[worded(*one) for one in each] for each in decided(kinds, every)]
    found = [" and ".join(plainest(each)) for each in texts]
    if kinds or ways < ODDS * 2 * len(shown[0].sizes):
        return plainest(found)
    wrong_and_right = [[one.inertia for one in group] for group in (shown, others)]
    shown = [*shown, *(one for one, wrong in tried if wrong)]
    others = [*others, *(one for one, wrong in tried if not wrong)]
    for name, (_, unit) in shown[0].sizes.items():
        low, high = ([one.sizes[name][0] for one in group] for group in (others, shown))
        if max(low) < min(high):
            found.append(f"{name} is above a limit between {limits(max(low), min(high), unit)}")
        elif max(high) < min(low):
            found.append(f"{name} is below a limit between {limits(max(high), min(low), unit)}")
    more = [(one.inertia, wrong) for one, wrong in tried]
    return found or inertias_in_common(wrong_and_right[0], wrong_and_right[1], more)


def plainest(found: list[str]) -> list[str]:
    """Without what goes with a plainer condition anyhow: only free bodies move at the start."""
    for text, follow in FOLLOWS.items():
        if text in found:
            found = [one for one in found if one not in follow]
    return found


def worded(text: str, holds: bool) -> str:
    """A sentence, or its negation."""
    return text if holds else _negated(text)


def _negated(text: str) -> str:
    known = {
        "the body is pivoted": "the body is free",
        "the body is damped": "nothing damps the body",
        "gravity points elsewhere than along -z": "gravity is zero or points along -z",
        "the inertia has products": "the inertia has no products",
        "the moments of inertia are unequal": "the moments of inertia are equal",
        "the centre of mass lies off the origin": "the centre of mass lies at the origin",
        "the pivot lies off the origin": "the pivot lies at the origin",
        "omega is zero": "omega is not zero",
        "the quaternion's scalar part is negative": "the quaternion's scalar part is not negative",
        "the body moves at the start": "the body does not move at the start",
        "the first attitude is not the identity": "the first attitude is the identity",
    }
    if text.endswith(" acts") or " acts" in text:
        return "no " + text.removeprefix("a ")
    if text.endswith((" is negative", " is positive", " is not zero")) and "scalar" not in text:
        return (
            text.replace(" is not ", " is ")
            if " not " in text
            else text.replace(" is ", " is not ")
        )
    return known.get(text, f"it does not hold that {text}")
