"""Runs that raise an error: not judged where the scheme itself blows up at so long a step.

What is seen until then is judged as a run that overflows there. If no step of the sweep is
answered, finer ones show whether the scheme is sound.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Sweep
from omegadot.gates.errors.findings import Declared, MeasuredSweep, findings_of
from omegadot.gates.errors.measured_run import MeasuredRun, measure
from omegadot.gates.truth import Truth
from omegadot.harness.judging.judged_run import JudgedRun, diverged, failed
from omegadot.harness.judging.no_solution import unjudged_row
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer
from omegadot.written import written

BLOWS_UP = "not judged: it blows up at so large a step, where the engine raises {}"
AT_ALL = "{}, and so it does at every step down to {} s"
MOST_STEPS = 10**6  # of a run; one of a compiled engine takes seconds


def judge_raised(
    truth: Truth,
    integrator: Integrator,
    sweep: Sweep,
    begun: State,
    tried: Sequence[tuple[Sweep, Answer]],
    declared: Declared,
    known: Sequence[MeasuredRun],
) -> JudgedRun:
    """A run that raises, by its samples until then and by the runs at other steps.

    begun: (n, ...), not numbers from there on.  tried: every run of the integrator, finer ones as
    well.  known: those that were answered.
    """
    answer, eps = dict(tried)[sweep], truth.yardstick.eps
    own = measure(truth.of_kept(sweep, begun), sweep, begun, None)
    findings = findings_of(own, declared, MeasuredSweep((*known, own)))
    until = Answer("ok", result={"time": sweep.times, "state": vars(begun)})
    found = diverged(integrator, sweep, until, own, findings, eps)
    if not found.fails:
        note = BLOWS_UP.format(answer.reason)
        return JudgedRun(integrator, sweep, "diverged", note, [unjudged_row(note)], note)
    raised = failed(integrator, sweep, answer, eps)
    if any(one.ok for _, one in tried):
        return replace(raised, unresolved=found.unresolved)
    finest = min((one for one, _ in tried), key=lambda one: one.timestep)
    finer = _resolving(truth, finest)
    text = AT_ALL.format(answer.reason, written(finest.timestep))
    reason = text if len(tried) > 1 else answer.reason
    unresolved = found.unresolved and finer.steps <= MOST_STEPS
    return replace(raised, reason=reason, unresolved=unresolved, finer=finer)


def _resolving(truth: Truth, finest: Sweep) -> Sweep:
    """Half the step, or a power of two of it at which the body's thin axis turns by a radian."""
    turn = finest.timestep * truth.yardstick.thin_rate
    return finest.refined(2 ** max(1, int(np.ceil(np.log2(max(turn, 1.0))))))
