"""By which rule the states that runs begin at are made of those that they are given.

Where a step of no length leads, from many states of all scenarios, is the state that a run begins
at. One rule must make it of the state given: of all, or of those where some condition holds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.models.attitude_misread import attitude_misread
from omegadot.diagnosis.models.changed_starts import Made, OtherStart, other_starts
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import LEFT, VanishingSteps
from omegadot.diagnosis.wording.conditions import LEAST, ODDS, only_where
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import attitude_angle, normalize, rotation_matrix
from omegadot.reference_impl.system import Array, State

FIELDS_OF_STATE = tuple(State.__dataclass_fields__)
FIELDS = ("orientation", "angular_velocity", "linear_velocity", "position")
MOST_PAIRS = 64  # attitudes that are taken through other conventions
KNOWN_TO = 1e-9  # rad, about: what the limit of smooth steps is known to
ELSEWHERE = "at another attitude: "
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Rule:
    """text: completes ``a run begins ...``.  made: the quantity; None of a convention."""

    text: str
    made: Made | None


def rules_of_starts(scenes: Sequence[VanishingSteps]) -> dict[str, Rule]:
    """By quantity, what makes it of the state given; none where a quantity has no rule."""
    found = dict[str, Rule]()
    for name in FIELDS:
        shown = [one for one in scenes if _is_of(name, one)]
        if all(same_start(one, name, getattr(one.states, name)).all() for one in shown):
            continue
        rule = _rule(name, shown)
        if rule is None:
            return {}
        found[name] = rule
    return found


def convention_of_attitudes(scenes: Sequence[VanishingSteps]) -> str:
    """Through which convention attitudes go, where no plainer rule makes them; else ""."""
    rule = rules_of_starts(scenes).get("orientation")
    return rule.text.removeprefix(ELSEWHERE) if rule is not None and rule.made is None else ""


def _is_of(name: str, steps: VanishingSteps) -> bool:
    """A pivoted body's place follows from its attitude."""
    return name in FIELDS[:2] or steps.system.load.pivot is None


def is_given(steps: VanishingSteps) -> Flags:
    """(m,): whether steps of no length begin at the state given."""
    names = [name for name in FIELDS if _is_of(name, steps)]
    return np.asarray(
        np.all([same_start(steps, name, getattr(steps.states, name)) for name in names], axis=0)
    )


def same_start(steps: VanishingSteps, name: str, made: Array) -> Flags:
    """(m,): whether these are where steps of no length begin, but for what is left of them."""
    before, after, moved = steps.states, steps.start, steps.moved
    if name == "orientation":
        off = np.maximum(
            attitude_angle(made, after.orientation), np.abs(norm(after.orientation) - 1.0)
        )
        return np.asarray(off <= LEFT + 2.0 * norm(moved.orientation))
    size = norm(getattr(before, name))
    if name in FIELDS[2:]:
        lever = float(norm(steps.system.body.center_of_mass))
        size = size + lever * (norm(before.angular_velocity) if name == FIELDS[2] else 1.0)
    off = norm(made - getattr(after, name))
    return np.asarray(off <= LEFT * size + norm(getattr(moved, name)))


def _rule(name: str, scenes: Sequence[VanishingSteps]) -> Rule | None:
    """What makes all that jump of one quantity, and where."""
    jumps = [~same_start(one, name, getattr(one.states, name)) for one in scenes]
    shown = [one for one, off in zip(scenes, jumps, strict=True) if off.any()]
    if len(shown) < 2 or sum(map(np.count_nonzero, jumps)) < LEAST:
        return None
    given, begins = (_joined(scenes, jumps, which) for which in ("states", "start"))
    conditional = list[tuple[OtherStart, list[Flags]]]()
    for one in other_starts(name, given, begins):
        fits = [same_start(each, name, one.made(each.system, each.states)) for each in scenes]
        pairs = list(zip(fits, jumps, strict=True))
        if all(fit.all() for fit in fits):
            return Rule(one.statement, one.made)
        if all(bool(np.all(fit | ~off)) for fit, off in pairs):
            conditional.append((one, fits))
    if name == "orientation":
        text = _of_convention(scenes)
        if text:
            return Rule(text, None)
    for one, fits in conditional:
        where = _where(scenes, fits, jumps)
        if where:
            return Rule(f"{one.statement}, but only where {where}", one.made)
    return None


def _joined(scenes: Sequence[VanishingSteps], chosen: Sequence[Flags], which: str) -> State:
    """The chosen states of all scenarios."""
    parts = [vars(getattr(one, which)) for one in scenes]
    return State(
        *(
            np.concatenate([part[field][on] for part, on in zip(parts, chosen, strict=True)])
            for field in FIELDS_OF_STATE
        )
    )


def _of_convention(scenes: Sequence[VanishingSteps]) -> str:
    """Attitudes that go through another convention on their way in, tried on some, then on all."""
    given = np.concatenate([one.states.orientation for one in scenes])
    begins = np.concatenate([one.limit.orientation for one in scenes])
    some = np.unique(np.linspace(0, len(given) - 1, MOST_PAIRS).astype(int))
    text = attitude_misread(given[some], begins[some], KNOWN_TO)
    text = text and attitude_misread(given, begins, KNOWN_TO)
    return f"{ELSEWHERE}{text}" if text else ""


def _where(scenes: Sequence[VanishingSteps], fits: Sequence[Flags], jumps: Sequence[Flags]) -> str:
    """Where the rule acts; states that it leaves as they are say nothing."""
    used = [~fit | off for fit, off in zip(fits, jumps, strict=True)]
    states, acts = _joined(scenes, used, "states"), _chosen(jumps, used)
    pivoted = np.concatenate(
        [
            np.full(np.count_nonzero(on), s.system.load.pivot is not None)
            for s, on in zip(scenes, used, strict=True)
        ]
    )
    signs = {"the body is pivoted": pivoted, "the body is free": ~pivoted, **_signs(states)}
    sides = sorted((int(np.count_nonzero(acts)), int(np.count_nonzero(~acts))))
    if sides[0] >= LEAST and comb(sum(sides), sides[0]) >= ODDS * len(signs):
        for text, holds in signs.items():
            if np.array_equal(holds, acts):
                return text
    parts = []
    for one, on, off in zip(scenes, used, jumps, strict=True):
        if on.any():
            parts.append((one.system, one.states[np.flatnonzero(on)], ~off[on]))
    return only_where(parts)


def _chosen(values: Sequence[Flags], used: Sequence[Flags]) -> Flags:
    return np.concatenate([one[on] for one, on in zip(values, used, strict=True)])


def _signs(states: State) -> dict[str, Flags]:
    """Of the entries of the rotation matrix and of the quaternion; on zero both sides are open."""
    turn, q = rotation_matrix(normalize(states.orientation)), states.orientation
    found = dict[str, Flags]()
    for i, row in enumerate("xyz"):
        for j, column in enumerate("xyz"):
            found[f"R_{row}{column} < 0"] = turn[:, i, j] < 0.0
            found[f"R_{row}{column} > 0"] = turn[:, i, j] > 0.0
    trace = np.trace(turn, axis1=-2, axis2=-1)
    found |= {"trace(R) < 0": trace < 0.0, "trace(R) > 0": trace > 0.0}
    for k, part in enumerate("wxyz"):
        found[f"the quaternion's {part} is negative"] = q[:, k] < 0.0
        found[f"the quaternion's {part} is positive"] = q[:, k] > 0.0
    return found
