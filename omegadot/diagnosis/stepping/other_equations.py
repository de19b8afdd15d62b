"""Causes in the equation that a run is stepped over: all that are known, side by side in lanes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations, form_of, stacked
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.hypotheses import hypotheses, wrong_form
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.fitted import SLACK
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State, System

SEEN = 1e-9  # relative: a change that is smaller is not followed
IN_STEPS = "in the steps, "
NOT_STEPPED = ("report", "precision")


@dataclass(frozen=True, eq=False)
class _Same:
    """A system that is compared by identity: one is looked up again and again."""

    system: System

    def __hash__(self) -> int:
        return id(self.system)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and other.system is self.system


@lru_cache(maxsize=2)
def _forms(same: _Same) -> dict[str, Form]:
    """The equation with one thing wrong, by what is wrong, where it has a meaning here."""
    system, right = same.system, form_of(same.system)
    known = [h for h in hypotheses(system) if h.part not in NOT_STEPPED and not h.unlikely]
    made = {one.text.strip(): wrong_form([one], system, right) for one in known}
    return {text: form for text, form in made.items() if form is not None}


def _distinct(system: System, states: State) -> dict[str, Form]:
    """Those that change what moves the body at these states, each in a way of its own."""
    every = _forms(_Same(system))
    tried, true = (
        accelerations(stacked([*every.values()]), states),
        forward_dynamics(system, states),
    )
    changes = np.concatenate([tried.angular - true.angular, tried.linear - true.linear], axis=1)
    sizes = np.max(np.abs(changes), axis=(1, 2))
    least = SEEN * float(np.max(np.abs(true.angular)) + np.max(np.abs(true.linear)))
    kept = list[int]()
    for k in np.flatnonzero(~(sizes <= least)):
        apart = np.max(np.abs(changes[kept] - changes[k]), axis=(1, 2))
        if not np.any(apart <= SEEN * sizes[k]):
            kept.append(int(k))
    texts = [*every]
    return {texts[k]: every[texts[k]] for k in kept}


def other_equations(reported: ReportedRun) -> list[str]:
    """The scheme over another equation, all hypotheses side by side in lanes."""
    distinct = _distinct(reported.case.system, reported.own)
    found, forms = [*distinct], [*distinct.values()]
    if not forms:
        return []
    for run in (reported.beginning, reported):  # the beginning rules most of them out
        stepped = _in_lanes(run, forms)
        fits = [k for k in range(len(forms)) if run.agrees(run.state, stepped[:, k], slack=SLACK)]
        found, forms = [found[k] for k in fits], [forms[k] for k in fits]
        if not forms or run is reported:
            break
    return [f"{IN_STEPS}{text}" for text in found]


def is_refuted(text: str, evidence: Evidence) -> bool:
    """Whether such a cause would show in the sound steps of another scenario."""
    system = evidence.system
    if not text.startswith(IN_STEPS) or not np.all(evidence.sound):
        return False
    what = text.removeprefix(IN_STEPS)
    named = [one for one in hypotheses(system) if one.text.strip() == what]
    form = wrong_form(named[:1], system, form_of(system)) if named else None
    return form is not None and evidence.visible(accelerations(form, evidence.states))


def _in_lanes(reported: ReportedRun, forms: Sequence[Form]) -> State:
    """(n, lanes, ...): the declared scheme over each of these equations."""
    lanes = Form(*(np.stack(part) for part in zip(*(vars(f).values() for f in forms), strict=True)))
    system, sweep = reported.case.system, reported.sweep
    coordinates = reported.integrator.coordinates
    motion = motion_over(system, coordinates, lambda state: accelerations(lanes, state))
    start = State(*(np.stack([f] * len(forms)) for f in vars(reported.case.initial).values()))
    plan = (sweep.timestep, sweep.steps, sweep.every, coordinates, motion)
    with np.errstate(all="ignore"):
        return step_body(reported.declared, system, start, *plan)[1]
