"""Causes in the equation that a run is stepped over: all that are known, side by side in lanes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations
from omegadot.diagnosis.equations.hypotheses import hypotheses, wrong_form
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.fitted import SLACK
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State

SEEN = 1e-9  # relative: a change that is smaller is not followed
NOT_STEPPED = ("report", "precision")


def other_equations(reported: ReportedRun) -> list[str]:
    """The scheme over another equation, all hypotheses side by side in lanes."""
    system, states = reported.case.system, reported.own
    known = [h for h in hypotheses(system) if h.part not in NOT_STEPPED and not h.unlikely]
    found, forms, kept = list[str](), list[Form](), list[Array]()
    true = forward_dynamics(system, states)
    for one in known:
        form = wrong_form([one], system)
        if form is None:
            continue
        tried = accelerations(form, states)
        change = np.concatenate([tried.angular - true.angular, tried.linear - true.linear])
        size = float(np.max(np.abs(change)))
        if size <= SEEN * float(np.max(np.abs(true.angular)) + np.max(np.abs(true.linear))):
            continue
        if any(np.max(np.abs(change - other)) <= SEEN * size for other in kept):
            continue
        found.append(one.text.strip())
        forms.append(form)
        kept.append(change)
    if not forms:
        return []
    for run in (reported.beginning, reported):  # the beginning rules most of them out
        stepped = _in_lanes(run, forms)
        fits = [k for k in range(len(forms)) if run.agrees(run.state, stepped[:, k], slack=SLACK)]
        found, forms = [found[k] for k in fits], [forms[k] for k in fits]
        if not forms or run is reported:
            break
    return [f"in the steps, {text}" for text in found]


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
