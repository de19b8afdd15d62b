"""Gate 3 for an unknown scheme: a run restarted at one of its samples must repeat the rest.

The motion is that of an autonomous system, so a step depends on the state alone: not on the clock,
nor on how the state was reached. A run from the state reported at one sample then reports the same
samples after it. It does not where a sample is not the state that was stepped (reported late, or
made up afterwards), where something acts for a while only, and where there is noise.
"""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.likeness import Likeness, likeness
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

GATE = "scheme"
METRIC = "restarted"
STIFF = "not judged: of so thin a body so long a step of its momentum amplifies rounding"


def restart_of(sweep: Sweep, coarsest: Sweep | None = None) -> tuple[int, Sweep] | None:
    """The sample in the middle and what is left of a sweep from there on; None without any.

    coarsest: of this integrator's sweeps; no more steps than it has left are taken, and to a sample
    at least. A step depends on the state alone, or it does not, whatever its length.
    """
    kept = sweep.sample_steps
    sample = (len(kept) - 1) // 2
    if sample == 0:
        return None
    left = int(sweep.steps - kept[sample])
    found = restart_of(coarsest) if coarsest is not None else None
    if found is not None and found[1].steps < left:
        left = max(1, found[1].steps // sweep.every) * sweep.every
    return sample, Sweep(sweep.timestep, min(left, int(sweep.steps - kept[sample])), sweep.every)


def refused(reason: str) -> Row:
    """A run that cannot be restarted where it has been."""
    note = f"a run cannot be restarted at its own sample: {reason}"
    return Row(GATE, "omega", METRIC, float("inf"), "1", 1.0, "fail", note)


def row(
    truth: Truth, integrator: Integrator, sweep: Sweep, state: State, sample: int, restarted: State
) -> Row:
    """The largest distance between the two runs, in parts of what rounding allows.

    restarted: (m,), as many samples of the rest as were requested.

    Each lies within the round-off bound of one trajectory, so that they differ by twice that at
    most. A scheme that is not known may step the angular momentum; where that amplifies rounding at
    every step, two runs that differ show nothing.

    From where rounding has made another motion of a run that is faster than the exact one there is
    no bound. The run's own speed gives none: by how much steps of a radian and more amplify the
    rounding of both halves depends on the scheme, which is not known. Such a run is off by the size
    of the motion itself, and the gate of the trajectory holds that against finer steps.
    """
    yardstick = truth.of_kept(sweep, state).yardstick.of_momentum()
    again = slice(sample, sample + len(restarted.angular_velocity))
    rest = state[again]
    apart = {c: yardstick.distance(c, rest, restarted) for c in CHANNELS}

    def alike(growth: Array) -> Likeness:
        faster = yardstick.faster(state, sweep.timestep)
        bounds = yardstick.round_off(sweep.timestep, sweep.sample_steps, growth, faster)
        return likeness(apart, {c: 2.0 * bounds[c][again] for c in CHANNELS})

    found = alike(np.ones(len(sweep.times)))
    if not found.agree:  # most agree to the bit, and growth takes long to work out
        found = alike(growth_along(yardstick.system, sweep.times, state, yardstick.rate))
    start = (found.channel, METRIC, found.share, "1", 1.0)
    if np.isnan(found.share):
        return Row(GATE, *start, "info", "not judged: the run blows up")
    if found.agree:
        return Row(GATE, *start, "pass")
    if not integrator.one_step:
        return Row(GATE, *start, "info", "steps use earlier ones, as is declared")
    if yardstick.is_stiff(sweep.timestep):
        return Row(GATE, *start, "info", STIFF)
    when = f"t = {written(sweep.times[sample], 4)} s"
    note = f"a run restarted at its own sample at {when} gives other samples: they are not the"
    note = f"{note} state that is stepped, or steps depend on the past (declared by one_step=False)"
    return Row(GATE, *start, "fail", note)
