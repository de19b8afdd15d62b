"""What the answers for the same system with one thing changed show, as scenarios of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.left_over import LeftOver
from omegadot.diagnosis.wording.digits import listed
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.harness.drive import CaseResult
from omegadot.harness.requests import siblings
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration, Array, System

AFTER_ANOTHER = "something of a system that was loaded before is left over"
SCALE = "scale"  # the sibling of which every number is changed, slightly
OTHER = 1e-6  # relative: values that are two


class Siblings:
    """Of one engine: every scenario, and each with one thing changed, loaded after it.

    left_over: what is kept of systems, of these and of all else that is known of the engine.
    """

    def __init__(self, left_over: LeftOver | None = None) -> None:
        self._across = Across(left_over)
        self._first: dict[str, System] = {}  # of the scenarios on which forward dynamics are right

    def add(self, scene: Scene, case: Case, result: CaseResult) -> None:
        """One more scenario with its siblings."""
        own = scene.evidence.get(FORWARD)
        if own is None or not result.siblings:
            return
        self._across.add(replace(scene, evidence={FORWARD: own}, scaled={}, opposites={}))
        if np.all(own.sound):
            self._first[case.name] = case.system
        for what, (system, states, answer) in result.siblings.items():
            if answer.ok:
                found, eps = Acceleration(**answer.result), eps_of(result.precision)
                evidence = {FORWARD: of_forward_dynamics(system, states, found, eps)}
                features = features_of(system, case.initial)
                before = {"": result.before[what]} if what in result.before else {}
                one = Scene(_name(case, what), system, features, evidence, before=before)
                self._across.add(one)

    def follow(self, case: Case, one: Candidate) -> bool:
        """Whether a cause of other scenarios, by its own numbers, makes every sibling's answer."""
        names = [_name(case, what) for what, _ in siblings.siblings_of(case)]
        known = [
            self._across.scenes[n].evidence[FORWARD] for n in names if n in self._across.scenes
        ]
        made = [(evidence, one.predicted(evidence)) for evidence in known]
        return bool(made) and all(a is not None and one.fits(e, a) for e, a in made)

    def causes(self, case: Case) -> list[str]:
        """A wrong equation that shows in the siblings alone, what is left over, or either."""
        kept_of_others = self.left_over(case)
        if kept_of_others:
            return [kept_of_others]
        failing = dict[str, bool]()  # by what is changed: whether the answer is the first system's
        for what in (what for what, _ in siblings.siblings_of(case) if what != SCALE):
            scene = self._across.scenes.get(_name(case, what))
            if scene is not None and not np.all((one := scene.evidence[FORWARD]).sound):
                failing[what] = one.fits(forward_dynamics(case.system, one.states))
        texts = [self._across.plain(_name(case, what), FORWARD) for what in failing]
        found = list(dict.fromkeys(filter(None, texts)))
        kept = all(failing.values())  # also where numbers that differ slightly are wrong alone
        named = listed([what.replace("_", " ").replace("center", "centre") for what in failing])
        if failing and kept and all(self._right_with_others(what) for what in failing):
            return [f"{AFTER_ANOTHER}: its {named}"]
        if len(found) == 1 and all(texts):
            return [f"either {found[0]}, or {AFTER_ANOTHER}" if kept else found[0]]
        other = f"another {named}" if failing else "slightly other numbers"
        return [f"either forward dynamics are wrong with {other}, or {AFTER_ANOTHER}"]

    def left_over(self, case: Case) -> str:
        """What is kept of a system, if it makes all that is wrong; "" where nothing does."""
        known = {
            self._across.left_over(name, FORWARD)
            for what, _ in siblings.siblings_of(case)
            if (name := _name(case, what)) in self._across.scenes
            and self._across.scenes[name].evidence[FORWARD].clear
        }
        return known.pop() if len(known) == 1 else ""

    def _right_with_others(self, what: str) -> bool:
        """Whether scenarios that differ in this are right where they are loaded by themselves."""
        values = [v for s in self._first.values() if (v := _value(s, what)) is not None]
        return any(np.max(np.abs(one - values[0])) > OTHER for one in values[1:])


def _name(case: Case, what: str) -> str:
    return f"{case.name} with another {what}"


def _value(system: System, what: str) -> Array | None:
    """What a sibling has another of: a vector or a tensor by direction; None where it is zero."""
    body, load = system.body, system.load
    if what == "mass":
        return np.asarray(np.log(body.mass), dtype=float).reshape(1)
    value = getattr(load if hasattr(load, what) else body, what)
    if value is None or not np.any(value):
        return None
    flat = np.ravel(np.asarray(value, dtype=float))
    return flat if what == "damping" else np.asarray(flat / np.linalg.norm(flat))
