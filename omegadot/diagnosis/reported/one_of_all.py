"""Samples that all hold the same: those of one buffer that is kept again and again, not copied.

Every sample then is the last one; of what is never moved, or never filled again, it is the first.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.sample_causes import ALONE
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.system import State

MOST_STEPS = 5000  # of a run that is stepped again to its end
WHOLE = "the state"
QUANTITIES = {**ALONE, WHOLE: tuple(State.__dataclass_fields__)}


def one_of_all(reported: ReportedRun, result: CaseResult) -> str:
    """Which quantities are the same at every sample, and of which sample they are; "" if none.

    The other quantities must be right, and so must these be at that one sample.
    """
    own, came = reported.own, reported.state
    whole = _whole(reported, result)
    if whole is None or len(came.position) != len(own.position) or len(came.position) < 2:
        return ""
    for what, names in QUANTITIES.items():
        same = all(np.ptp(getattr(whole.state, name), axis=0).max() == 0.0 for name in names)
        constant = {n: np.broadcast_to(getattr(came, n)[:1], getattr(own, n).shape) for n in names}
        if not same or reported.agrees(replace(own, **constant), own):
            continue  # the body may be at rest
        right = replace(came, **{name: getattr(own, name) for name in names})
        if reported.agrees(right, own):
            which = _of_which(whole, names, what)
            verb = "are" if "with" in what else "is"
            text = f"{what} {verb} the same at every sample of a run: that of its {which}"
            return text if which else ""
    return ""


def _whole(reported: ReportedRun, result: CaseResult) -> ReportedRun | None:
    """All samples of the run, next to none; None where some are missing."""
    knob = reported.sweep.knob
    sweep = next((one for one in reported.case.sweeps if one.knob == knob), None)
    answer = result.runs.get((reported.integrator.name, knob))
    if sweep is None or answer is None or not answer.ok:
        return None
    state, time = State(**answer.result["state"]), answer.result["time"]
    growth = reported.truth.growth[reported.truth.rows(sweep)]
    whole = replace(reported, sweep=sweep, time=time, state=state, growth=growth)
    return whole if len(time) == len(sweep.times) else None


def _of_which(whole: ReportedRun, names: tuple[str, ...], what: str) -> str:
    """The last sample of the run, or the first; "" where it is neither."""
    first, last = slice(0, 1), slice(-1, None)
    given = State(*(values[None] for values in vars(whole.case.initial).values()))
    held = replace(given, **{name: getattr(whole.state, name)[first] for name in names})
    if whole.agrees(held, given, first):
        return "first sample" if what != WHOLE else ""  # a body that is not moved at all
    if whole.sweep.steps > MOST_STEPS:
        return ""
    ends = whole.agrees(whole.state[last], whole.stepped()[last], last)
    return "last sample, as of one buffer that is not copied" if ends else ""
