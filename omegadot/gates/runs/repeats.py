"""Gate 5 for runs that are requested again: the answer depends on the request alone.

Neither earlier runs nor the system that was loaded before may change a run. Where the scheme is
known, neither may the sign of the start's quaternion: q and -q are one attitude. (An unknown scheme
may step coordinates that have two points for it, such as modified Rodrigues parameters, and what a
step leaves out then differs.) Each of two runs lies within the round-off bound of one trajectory,
so that they differ by twice that at most.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from omegadot.gates.bounds.likeness import likeness
from omegadot.gates.errors.measured_run import CHANNELS, MeasuredRun
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.reference_impl.system import State

GATE = "trajectory"
# "short" is no answer to judge: it is what one "reloaded" is compared with.
How = Literal["repeated", "short", "negated", "reloaded"]
NOTES: dict[How, str] = {
    "repeated": (
        "the first samples, requested again, are others: they depend on earlier runs, or on how "
        "many steps are requested"
    ),
    "negated": "a run from -q gives other samples than from q, which is the same attitude",
    "reloaded": "the same run, after another system was loaded in between, gives other samples",
}


def refused(how: How, reason: str) -> Row:
    """A run that was answered once, and not when it was requested again."""
    requests: dict[How, str] = {
        "repeated": "the same run, requested again, fails",
        "negated": "a run from -q fails where that from q does not",
        "reloaded": "the same run, after another system was loaded in between, fails",
    }
    return Row(GATE, "omega", how, float("inf"), "1", 1.0, "fail", f"{requests[how]}: {reason}")


def row(truth: Truth, measured: MeasuredRun, state: State, how: How, again: State) -> Row:
    """The largest distance between the first samples of two runs, in parts of what rounding allows.

    again: (m,), of the m first samples at most, the first among them.
    """
    count = len(again.angular_velocity)
    apart = {c: truth.yardstick.distance(c, state[:count], again) for c in CHANNELS}
    found = likeness(apart, {c: 2.0 * measured.round_off[c][:count] for c in CHANNELS})
    if np.isnan(found.share):
        return Row(GATE, found.channel, how, found.share, "1", 1.0, "info", "the run blows up")
    verdict, note = ("pass", "") if found.agree else ("fail", NOTES[how])
    return Row(GATE, found.channel, how, found.share, "1", 1.0, verdict, note)
