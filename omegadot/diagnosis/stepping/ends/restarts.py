"""Causes in what a run remembers: it is compared with itself, restarted at one of its samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.reference_impl.system import Array, State
from omegadot.written import written


def restart_cause(truth: Truth, result: CaseResult, run: JudgedRun) -> str:
    """How a restarted run differs from the rest of the run; "" where it does not, or anyhow."""
    name, sweep = run.integrator.name, run.sweep
    sample, left, answer = result.restarts.get((name, sweep.timestep), (0, sweep, None))
    whole = result.runs.get((name, sweep.timestep))
    if answer is None or whole is None or not answer.ok or not whole.ok:
        return ""
    state, again = State(**whole.result["state"]), State(**answer.result["state"])
    rest = state[sample : sample + len(left.times)]
    count = len(rest.angular_velocity)
    if len(again.angular_velocity) != count or count < 3:
        return ""
    same = _alike(truth, sweep, sample, rest, again)
    if same.all():
        return ""
    if not same[0]:
        pairs = ((rest[0].orientation, again[0].orientation), *_omegas(rest, again))
        turned = not all(np.allclose(one, two, rtol=1e-9, atol=1e-12) for one, two in pairs)
        finite = all(np.isfinite(one).all() for pair in pairs for one in pair)
        # a pivoted body's place follows from its attitude, whatever is given
        if not finite or (truth.yardstick.system.load.pivot is not None and not turned):
            return ""
        return "a run does not begin at the state that it is given"
    for shift, when in ((1, "late"), (-1, "early")):
        first, second = (rest[:-1], again[1:]) if shift > 0 else (rest[1:], again[:-1])
        if _alike(truth, sweep, sample + 1, first, second).all():
            return f"the run is logged one sample {when}: restarted, it is one sample apart"
    first_apart = int(np.argmin(same))
    if first_apart > 1:
        steps = int(sweep.sample_steps[sample + first_apart] - sweep.sample_steps[sample])
        return (  # what is logged in fewer digits than are stepped does the same
            f"restarted at its own sample at t = {written(sweep.times[sample], 4)} s, the run is "
            f"the same for a while and another after {steps} steps: they depend on how many went "
            "before, or a sample is not all of the state"
        )
    return ""


def _omegas(one: State, other: State) -> list[tuple[Array, Array]]:
    return [(one.angular_velocity[0], other.angular_velocity[0])]


def _alike(truth: Truth, sweep: Sweep, sample: int, one: State, other: State) -> NDArray[np.bool_]:
    """(n,): whether two runs agree, with rounding grown as along the exact trajectory."""
    yardstick, count = truth.yardstick, len(one.angular_velocity)
    growth = truth.growth[truth.rows(sweep)]
    bounds = yardstick.round_off(sweep.timestep, sweep.sample_steps, growth)
    same = np.ones(count, bool)
    for channel in CHANNELS:
        allowed = 2.0 * bounds[channel][sample : sample + count]
        same &= yardstick.distance(channel, one, other)[: len(allowed)] <= allowed
    return same
