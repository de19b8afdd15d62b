"""At which other states the runs of an integrator begin than those they are given.

Where a step of no length leads from many states, over all scenarios, is the state that a run
begins at. One rule must make it of the state given: of all, or of those where some condition holds.
Samples that are misreported show the same in a step of no length; of these the runs are not sound,
stepped on from where they begin.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.models.attitude_misread import attitude_misread
from omegadot.diagnosis.models.other_starts import Made, OtherStart, other_starts
from omegadot.diagnosis.stepping.kept_run import CHANNELS, KeptRun, SchemeOf, scheme_of
from omegadot.diagnosis.stepping.vanishing_steps import LEFT, VanishingSteps
from omegadot.diagnosis.wording.conditions import LEAST, ODDS, only_where
from omegadot.diagnosis.wording.digits import listed
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import attitude_angle, normalize, rotation_matrix
from omegadot.reference_impl.system import Array, State

SCENARIOS = 2  # at least, that show it
FIELDS_OF_STATE = tuple(State.__dataclass_fields__)
FIELDS = ("orientation", "angular_velocity", "linear_velocity", "position")
SLACK = 4.0
RUNS = 2  # of a scenario, that are stepped again
MOST_PAIRS = 64  # attitudes that are taken through other conventions
KNOWN_TO = 1e-9  # rad, about: what the limit of smooth steps is known to
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Starts:
    """statement: where all runs begin.  names: of the scenarios whose failed runs this explains."""

    statement: str
    names: frozenset[str]


@dataclass(frozen=True)
class _Rule:
    text: str
    made: Made | None


def other_start(
    integrator: Integrator,
    steps: Mapping[str, VanishingSteps],
    given: Mapping[str, State],
    kept: Sequence[KeptRun],
) -> Starts | None:
    """The rule by which the runs of an integrator begin elsewhere; None without one.

    steps and given: by scenario, first steps from many states, and the state that its runs are
    given.
    """
    with np.errstate(all="ignore"):
        jumping = {name for name, one in steps.items() if not _is_given(one).all()}
        if len(jumping) < SCENARIOS:
            return None
        rules = dict[str, _Rule]()
        for name in FIELDS:
            scenes = [one for one in steps.values() if _is_of(name, one)]
            if all(same_start(one, name, getattr(one.states, name)).all() for one in scenes):
                continue
            found = _rule(name, scenes)
            if found is None:
                return None
            rules[name] = found
        by = scheme_of(integrator, kept)
        if by is None or not rules:
            return None
        return _held(rules, by, jumping, given, kept)


def _is_of(name: str, steps: VanishingSteps) -> bool:
    """A pivoted body's place follows from its attitude."""
    return name in FIELDS[:2] or steps.system.load.pivot is None


def _is_given(steps: VanishingSteps) -> Flags:
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


def _rule(name: str, scenes: Sequence[VanishingSteps]) -> _Rule | None:
    """What makes all that jump of one quantity, and where."""
    jumps = [~same_start(one, name, getattr(one.states, name)) for one in scenes]
    shown = [one for one, off in zip(scenes, jumps, strict=True) if off.any()]
    if len(shown) < 2 or sum(map(np.count_nonzero, jumps)) < LEAST:
        return None
    given, begins = (_joined(scenes, jumps, which) for which in ("states", "start"))
    conditional = list[tuple[OtherStart, list[Flags]]]()
    for one in other_starts(name, given, begins):
        fits = [same_start(each, name, one.made(each.states)) for each in scenes]
        pairs = list(zip(fits, jumps, strict=True))
        if all(fit.all() for fit in fits):
            return _Rule(one.statement, one.made)
        if all(bool(np.all(fit | ~off)) for fit, off in pairs):
            conditional.append((one, fits))
    if name == "orientation":
        text = _of_convention(scenes)
        if text:
            return _Rule(text, None)
    for one, fits in conditional:
        where = _where(scenes, fits, jumps)
        if where:
            return _Rule(f"{one.statement}, but only where {where}", one.made)
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
    return f"at another attitude: {text}" if text else ""


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


def _held(
    rules: Mapping[str, _Rule],
    by: SchemeOf,
    jumping: set[str],
    given: Mapping[str, State],
    kept: Sequence[KeptRun],
) -> Starts | None:
    """Whether runs are sound from there, and some would not be that are misreported throughout."""
    sound, wrong, decided = Counter[str](), set[str](), False
    failing = [run.short for run in kept if run.fails and run.name in jumping]
    for run in sorted(failing, key=lambda run: run.sweep.every):
        if sound[run.name] >= RUNS or run.name in wrong:
            continue
        start = given[run.name]
        if any(one.sound(by).all() for one in (run, *_from(rules, run, start))):
            sound[run.name] += 1
            decided = decided or _decides(rules, by, run, start)
        else:
            wrong.add(run.name)
    if not decided or len(sound.keys() - wrong) < max(SCENARIOS, len(wrong)):
        return None
    text = listed([rule.text for rule in rules.values()])
    statement = f"a run begins {text}, and is sound from there"
    return Starts(statement, frozenset(jumping - wrong))


def _made(rules: Mapping[str, _Rule], state: State) -> State | None:
    """The states by all rules, whatever their conditions; None where one is of a convention."""
    if any(rule.made is None for rule in rules.values()):
        return None
    made = {name: rule.made(state) for name, rule in rules.items() if rule.made is not None}
    return replace(state, **made)


def _from(rules: Mapping[str, _Rule], run: KeptRun, given: State) -> list[KeptRun]:
    """The run from where it begins by the rules: the first sample may be logged as it is given."""
    made = _made(rules, given)
    if made is None:
        return []
    return [_with_start(run, place_on_pivot(run.system, made))]


def _with_start(run: KeptRun, start: State) -> KeptRun:
    """The run with another first sample."""
    pairs = zip(vars(start).values(), vars(run.state).values(), strict=True)
    return replace(run, state=State(*(np.concatenate((a[None], b[1:])) for a, b in pairs)))


def _decides(rules: Mapping[str, _Rule], by: SchemeOf, run: KeptRun, given: State) -> bool:
    """Whether the first interval would be another of samples that are misreported by the rules."""
    begins = run.state[:1]
    start = State(*(f[None] for f in vars(given).values()))
    if _near(run, begins, start):
        return False
    end = _with_start(run, given).ends(by)[:1]
    made = _made(rules, end)
    if made is None:
        return True  # of a convention no sample is made here
    repeated = (np.repeat(f, len(run.times) - 1, axis=0) for f in vars(made).values())
    apart = run.apart(State(*repeated))
    return any(bool(norm(apart[c])[0] > SLACK * run.bounds[c][0]) for c in CHANNELS)


def _near(run: KeptRun, one: State, other: State) -> bool:
    """Whether two states are the same within the bounds of the first interval."""
    bounds = run.bounds
    turned = attitude_angle(one.orientation, other.orientation)[0] <= SLACK * bounds["attitude"][0]
    w = norm(one.angular_velocity - other.angular_velocity)[0] <= SLACK * bounds["omega"][0]
    v = norm(one.linear_velocity - other.linear_velocity)[0] <= SLACK * bounds["velocity"][0]
    x = norm(one.position - other.position)[0] <= SLACK * bounds["position"][0]
    return bool(turned and w and v and x)
