"""What is seen of a difference where no cause fits: its components, direction and size."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.equation_form import form_of
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array

PARALLEL = 1e-6  # the sine of the angle up to which two directions are the same
CLEAN = 1e-4  # of an exponent, where a power law is exact but for rounding
LEAST, MOST = 6, 0.9  # states that show it; part of them, above which a few are special ones
DECADE = float(np.log(10.0))  # of a size, over which a power law must hold
CLEAR_OF_ROUNDING = 1.0 / CLEAN  # in bounds, which are of many more roundings than there are


@dataclass(frozen=True)
class Off:
    """Of one scenario, or of several.

    axes: of the components that are off, each set on some scenario.  along: what the difference is
    along at every state.  power: of |omega|, in the size of what is along `of`; None where too
    little is seen, NaN where it is no power.  share: of the states, the least and the most that are
    off.  turns: whether it is another vector at other states, in body axes.
    """

    axes: frozenset[frozenset[str]]
    along: frozenset[str]
    power: float | None
    share: tuple[float, float]
    turns: bool
    of: str = ""


def off_of(evidence: Evidence, kind: str) -> Off | None:
    """Of omega-dot ("angular") or of the linear acceleration; None where too little is seen."""
    angular = kind == "angular"
    rest = getattr(evidence.found, kind) - getattr(evidence.true, kind)
    bound = evidence.angular_bound if angular else evidence.linear_bound
    size = norm(rest)
    clear = np.isfinite(size) & (size > CLEAR_OF_ROUNDING * bound)
    if np.count_nonzero(clear) < LEAST:
        return None
    wrong = np.abs(rest) > CLEAR_OF_ROUNDING * bound[:, None]
    axes = frozenset(axis for k, axis in enumerate("xyz") if np.any(wrong[clear, k]))
    found = _directions(evidence, rest, clear) if angular else {}
    of, vectors = next(iter(found.items()), ("", rest))
    power = _power(norm(evidence.states.angular_velocity)[clear], norm(vectors)[clear])
    units = rest[clear] / size[clear][:, None]
    turns = bool(np.max(norm(units - units[0])) > PARALLEL)
    share = np.count_nonzero(~evidence.sound) / len(size)
    return Off(frozenset({axes}), frozenset(found), power, (share, share), turns, of)


def off_over(every: Sequence[Off]) -> Off | None:
    """What holds wherever something is seen; a power that one scenario lacks holds on none."""
    if not every:
        return None
    powers = {round(one.power, 3) for one in every if one.power is not None}
    along = frozenset.intersection(*(one.along for one in every))
    of = {one.of for one in every}
    same = len(powers) == 1 and len(of) == 1
    return Off(
        frozenset().union(*(one.axes for one in every)),
        along,
        powers.pop() if same else None,
        (min(one.share[0] for one in every), max(one.share[1] for one in every)),
        all(one.turns for one in every),
        of.pop() if same else "",
    )


def off_text(what: str, off: Off, along: str = "") -> str:
    """``omega-dot is off in x alone, by a torque along omega``."""
    texts = [f"{what} is off"]
    axes = sorted(frozenset().union(*off.axes))
    if len(axes) < 3:
        texts[0] += f" in {(' and ' if len(off.axes) == 1 else ' or ').join(axes)} alone"
    low, high = (f"{100 * share:.0f}" for share in off.share)
    if off.share[1] < MOST:
        texts.append(
            f"at {low} % of the states" if low == high else f"at {low} to {high} % of the states"
        )
    named = along or next((one for one in ALONG if one in off.along), "")
    if named:
        texts.append(f"by {named}")
    # one amount here may grow elsewhere; a torque grows as its rate does, along one axis alone
    if off.power is not None and abs(off.power) >= CLEAN and named == off.of:
        texts.append(f"by an amount that goes as |omega|^{number(round(off.power, 3))}")
    return ", ".join(texts)


NAMES = (
    "omega",
    "the angular momentum",
    "omega x I omega",
    "the torque of gravity",
    "gravity",
    "the torque in body axes",
    "the torque in world axes",
)
ALONG = tuple(f"{kind} along {name}" for kind in ("a torque", "a rate") for name in NAMES)


def _directions(evidence: Evidence, rest: Array, clear: NDArray[np.bool_]) -> dict[str, Array]:
    """What the torque or the rate that is too much is along, and these vectors."""
    system, w = evidence.system, evidence.states.angular_velocity
    form = form_of(system)
    momentum = apply(form.spin, w)
    down = rotate_inverse(evidence.states.orientation, system.load.gravity)
    driven = rotate_inverse(evidence.states.orientation, system.load.torque_world)
    own = system.load.torque_body + 0 * w
    known = (w, momentum, cross(w, momentum), cross(form.arm + 0 * w, down), down, own, driven)
    moment, found = apply(form.spin, rest), dict[str, Array]()
    for what, vectors in (("a torque", moment), ("a rate", rest)):
        for name, direction in zip(NAMES, known, strict=True):
            sizes = norm(direction)[clear] * norm(vectors)[clear]
            sine = norm(cross(vectors, direction))[clear]
            if np.all(sizes > 0.0) and np.all(sine <= PARALLEL * sizes):
                found[f"{what} along {name}"] = vectors
    return found


def _power(x: Array, y: Array) -> float | None:
    """The exponent of an exact power law, from the slope of the logarithms; NaN where it is none.

    None where too few states show it, or over less than a decade.
    """
    used = (x > 0.0) & (y > 0.0)
    if np.count_nonzero(used) < LEAST or np.ptp(np.log(x[used])) < DECADE:
        return None
    slope, start = np.polyfit(np.log(x[used]), np.log(y[used]), 1)
    left = np.log(y[used]) - slope * np.log(x[used]) - start
    return float(slope) if float(np.max(np.abs(left))) < 10 * CLEAN else float("nan")
