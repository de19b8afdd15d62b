"""How runs begin, held against steps with changes in single stages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun
from omegadot.diagnosis.stepping.slips.stage_changes import Change
from omegadot.diagnosis.stepping.slips.staged_steps import STAGED, staged_run
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import to_coordinates
from omegadot.reference_impl.schemes import Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

MORE = 6  # samples, after the first that the scheme misses
MOST_STEPS = 48  # of a run, that are stepped again
FAR = 10.0  # times as fast as the scheme's own run
Lanes = NDArray[np.bool_]


@dataclass(frozen=True)
class Beginning:
    """The first samples of a run. first: how many the scheme makes.  count: that are looked at."""

    run: KeptRun
    name: str
    first: int
    count: int

    def made(self, changes: Sequence[Change], count: int) -> tuple[Lanes, Lanes]:
        """Of each change, whether it makes the first samples, and whether it acts in them."""
        apart = self.run.apart(_ends(self.run, self.name, changes, count), count)
        bounds = {c: SLACK * self.run.bounds[c][:count] for c in CHANNELS}
        good = [norm(apart[c]) <= bounds[c] for c in CHANNELS]
        acts = [~(norm(apart[c] - apart[c][:1]) <= bounds[c]) for c in CHANNELS]
        return np.all(good, axis=(0, 2))[1:], np.any(acts, axis=(0, 2))[1:]

    def made_by(self, scheme: Scheme) -> bool:
        """Whether another scheme makes the first samples."""
        run, every = self.run, self.run.sweep.every
        plan = (run.sweep.timestep, self.count * every, every)
        _, found = step_body(scheme, run.system, run.state[0], *plan)
        return bool(np.all(run.reached(found[1:], self.count)))


def beginning(run: KeptRun, name: str) -> Beginning:
    """Of no samples from where on the run has left the motion, of which alone bounds are known."""
    count = min(max(1, MOST_STEPS // run.sweep.every), len(run.times) - 1)
    ends = _ends(run, name, [], count)
    most = FAR * float(np.max(norm(ends.angular_velocity)))
    near = norm(run.state.angular_velocity[1 : count + 1]) <= most
    count = count if near.all() else int(np.argmin(near))
    good = run.reached(ends, len(near))[0, :count]
    if good.all():
        return Beginning(run, name, count, count)
    first = int(np.argmin(good))
    return Beginning(run, name, first, min(first + MORE, count))


def _ends(run: KeptRun, name: str, changes: Sequence[Change], count: int) -> State:
    """(1 + changes, count, ...): by the scheme, then by it with each of the changes."""
    own = Change((), (1.0,) * len(STAGED[name][0]), "")
    q, v = to_coordinates(run.system, run.state[0], "com-world")
    plan = (run.sweep.timestep, run.sweep.every, count)
    return staged_run(run.system, name, [own, *changes], (q, v), plan)
