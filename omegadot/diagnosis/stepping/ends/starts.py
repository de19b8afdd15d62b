"""At which other states the runs of an integrator begin, and that they are sound from there.

Samples that are misreported begin elsewhere as well; stepped on from there, they are not sound.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.ends.start_rules import Rule, is_given, rules_of_starts
from omegadot.diagnosis.stepping.kept_run import CHANNELS, KeptRun, SchemeOf, scheme_of
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.diagnosis.wording.digits import listed
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import State, System

SLACK = 4.0
SCENARIOS = 2  # at least, that show it
RUNS = 2  # of a scenario, that are stepped again


@dataclass(frozen=True)
class Starts:
    """statement: where all runs begin.  names: of the scenarios whose failed runs this explains.

    rules and by: what is made of the state that is given, and the scheme that goes on from there.
    """

    statement: str
    names: frozenset[str]
    rules: Mapping[str, Rule]
    by: SchemeOf

    def makes(self, run: KeptRun, given: State) -> bool:
        """Whether a run that is given this state begins so, and is sound from there."""
        return any(one.sound(self.by).all() for one in _from(self.rules, run.short, given))


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
        jumping = {name for name, one in steps.items() if not is_given(one).all()}
        if len(jumping) < SCENARIOS:
            return None
        rules = rules_of_starts([*steps.values()])
        by = scheme_of(integrator, kept)
        if by is None or not rules:
            return None
        return _held(rules, by, jumping, given, kept)


def _held(
    rules: Mapping[str, Rule],
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
        good = [one for one in (run, *_from(rules, run, start)) if one.sound(by).all()]
        if good:
            sound[run.name] += 1
            decided = decided or _decides(rules, by, good[0], start)
        else:
            wrong.add(run.name)
    if not decided or len(sound.keys() - wrong) < max(SCENARIOS, len(wrong)):
        return None
    text = listed([rule.text for rule in rules.values()])
    statement = f"a run begins {text}, and is sound from there"
    return Starts(statement, frozenset(jumping - wrong), rules, by)


def _made(rules: Mapping[str, Rule], system: System, state: State) -> State | None:
    """The states by all rules, whatever their conditions; None where one is of a convention."""
    if any(rule.made is None for rule in rules.values()):
        return None
    made = {n: rule.made(system, state) for n, rule in rules.items() if rule.made is not None}
    return replace(state, **made)


def _from(rules: Mapping[str, Rule], run: KeptRun, given: State) -> list[KeptRun]:
    """The run from where it begins by the rules: the first sample may be logged as it is given."""
    made = _made(rules, run.system, given)
    if made is None:
        return []
    return [_with_start(run, place_on_pivot(run.system, made))]


def _with_start(run: KeptRun, start: State) -> KeptRun:
    """The run with another first sample."""
    pairs = zip(vars(start).values(), vars(run.state).values(), strict=True)
    return replace(run, state=State(*(np.concatenate((a[None], b[1:])) for a, b in pairs)))


def _decides(rules: Mapping[str, Rule], by: SchemeOf, run: KeptRun, given: State) -> bool:
    """Whether the first interval would be another of samples that are misreported by the rules."""
    begins = run.state[:1]
    start = State(*(f[None] for f in vars(given).values()))
    if _near(run, begins, start):
        return False
    end = _with_start(run, given).ends(by)[:1]
    made = _made(rules, run.system, end)
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
