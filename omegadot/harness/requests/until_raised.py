"""Runs that raise, requested again up to where they do: what they come to is what a gate judges."""

from __future__ import annotations

import numpy as np

from omegadot.gates.case import Case, Sweep
from omegadot.harness.drive import CaseResult, Driver
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer


def request_until_raised(driver: Driver, case: Case, result: CaseResult) -> None:
    """Have the runs that raise begun again, up to their last sample before that, into `result`.

    A known scheme overflows where the reference's run does, and nothing more need be known.
    """
    for integrator in result.integrators:
        if integrator.scheme in SCHEMES or integrator.knob == "accuracy":
            continue
        for sweep in case.sweeps:
            key = (integrator.name, sweep.timestep)
            answer = result.runs.get(key)
            if answer is not None and answer.outcome == "raised":
                begun = _until_raised(driver, case, integrator.name, sweep)
                if begun is not None:
                    result.begun[key] = begun


def _until_raised(driver: Driver, case: Case, integrator: str, sweep: Sweep) -> State | None:
    """The samples of a run up to where it raises, (n, ...), and no numbers from there on.

    The last is found by bisection. None where an answer fails by anything else.
    """
    count = len(sweep.times)
    state = State(*(np.array(values)[None] for values in vars(case.initial).values()))
    answered, raised = 1, count  # samples; the first is the state given
    while raised - answered > 1:
        half = (answered + raised) // 2
        answer: Answer = driver.replay(case, integrator, sweep.until(half), case.initial)
        if answer.ok and len(answer.result["state"]["position"]) == half:
            state, answered = State(**answer.result["state"]), half
        elif answer.outcome == "raised":
            raised = half
        else:
            return None
    lost = [np.full((count - answered, f.shape[-1]), np.nan) for f in vars(state).values()]
    pairs = zip(vars(state).values(), lost, strict=True)
    return State(*(np.concatenate(pair) for pair in pairs))
