"""Where no cause fits an integrator's runs: what is off, and how it goes with step and time."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.wording.digits import listed
from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION, norm
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

CLEAN = 0.05  # of an exponent
# Times rounding: that of one step then changes the exponent of a halved error by half as much.
CLEAR = 2.0 * ROUNDINGS_PER_EVALUATION / (CLEAN * np.log(2.0))
LEAST = 4  # samples that show how an error grows
EARLY = 0.05  # of the vector itself, up to which its error is that of single steps added up
CHANNELS = {  # as they are worded, and as rows name them
    "omega": "omega",
    "attitude": "attitude",
    "linear velocity": "linear_momentum",
    "position": "position",
}
AXES = {"omega": "the body", "attitude": "the body", "position": "the world"}


@dataclass(frozen=True)
class Known:
    """What is off in a scenario's runs. step and time: exponents, None where there are none."""

    channel: str
    axes: frozenset[str]
    step: float | None
    time: float | None

    def with_others(self, others: Iterable[Known]) -> Known:
        """The same channel on other scenarios: what holds wherever it is off."""
        same = [self, *(one for one in others if one.channel == self.channel)]
        step, time = ({getattr(one, k) for one in same} for k in ("step", "time"))
        return Known(
            self.channel,
            frozenset().union(*(one.axes for one in same)),
            step.pop() if len(step) == 1 else None,
            time.pop() if len(time) == 1 else None,
        )

    @property
    def text(self) -> str:
        """``omega is off in z of the body alone, by an error that goes as step^1 and time^1``."""
        plain = self.channel in ("omega", "attitude")
        text = f"{self.channel if plain else f'the {self.channel}'} is off"
        if len(self.axes) < 3:
            where = AXES.get(self.channel, "the world")
            text += f" in {' and '.join(sorted(self.axes))} of {where} alone"
        powers = {"step": self.step, "time": self.time}
        goes = [f"as {k}^{written(p)}" for k, p in powers.items() if p]
        text += f", by an error that goes {listed(goes)}" if goes else ""
        return text + (", as far by the shortest steps as by the longest" * (self.step == 0.0))


def known_of_runs(
    truth: Truth, result: CaseResult, runs: Sequence[JudgedRun], shortest: float
) -> Known | None:
    """Of the first channel that is off beyond rounding: attitude follows omega, and place both.

    runs: those that fail.  shortest: of all steps that were taken, in s.
    """
    failed = {row.channel for run in runs for row in run.rows if row.verdict == "fail"}
    errors = [found for run in runs if (found := _errors(truth, result, run)) is not None]
    for channel in (c for c, name in CHANNELS.items() if name in failed):
        shown = [(run, e[channel]) for run, e in errors if np.any(e[channel].clear)]
        if shown:
            seen = _known(channel, shown)
            tried = min(run.sweep.timestep for run, _ in shown) <= shortest
            due = runs[0].integrator.orders.get(CHANNELS[channel])
            if seen.step is not None and due is not None and seen.step >= due:
                return replace(seen, step=None, time=None)  # until there it is a sound scheme's own
            return seen if tried or seen.step != 0.0 else replace(seen, step=None)
    return None


class _Error:
    """vectors: (n, 3), of each sample.  size: of what it is an error of.  time: (n,) s."""

    def __init__(self, vectors: Array, size: float, time: Array, eps: float) -> None:
        self.vectors, self.size, self.time = vectors, size, time
        self.lengths = norm(vectors)
        self.clear: NDArray[np.bool_] = np.isfinite(self.lengths) & (
            self.lengths > CLEAR * eps * size * np.sqrt(1.0 + np.arange(len(time)))
        )


def _errors(
    truth: Truth, result: CaseResult, run: JudgedRun
) -> tuple[JudgedRun, dict[str, _Error]] | None:
    answer = result.runs.get((run.integrator.name, run.sweep.knob))
    if answer is None or not answer.ok or len(answer.result["time"]) != len(run.sweep.times):
        return None
    came, due, eps = State(**answer.result["state"]), truth.at(run.sweep), truth.yardstick.eps
    with np.errstate(all="ignore"):
        vectors = {
            "omega": came.angular_velocity - due.angular_velocity,
            "attitude": rotation_between(due.orientation, came.orientation),
            "linear velocity": came.linear_velocity - due.linear_velocity,
            "position": came.position - due.position,
        }
    sizes = {
        "omega": _largest(due.angular_velocity),
        "attitude": 1.0,
        "linear velocity": _largest(due.linear_velocity),
        "position": _largest(due.position),
    }
    times = run.sweep.times
    return run, {k: _Error(v, sizes[k], times, eps) for k, v in vectors.items()}


def _largest(vectors: Array) -> float:
    return float(np.max(norm(vectors)))


def _known(channel: str, shown: Sequence[tuple[JudgedRun, _Error]]) -> Known:
    _, first = shown[0]
    early = first.clear & (first.lengths <= EARLY * first.size)
    used = early if early.any() else first.clear
    off = np.abs(first.vectors[used])
    axes = frozenset(a for k, a in enumerate("xyz") if np.any(off[:, k] > 1e-6 * np.max(off)))
    return Known(channel, axes, _of_step(shown), _of_time(first))


def _near(powers: Array) -> float | None:
    """The half or whole number that all are near to; None without one."""
    if not len(powers) or not np.all(np.isfinite(powers)):
        return None
    near = round(2.0 * float(np.median(powers))) / 2.0
    return near if np.max(np.abs(powers - near)) < CLEAN else None


def _of_step(shown: Sequence[tuple[JudgedRun, _Error]]) -> float | None:
    """The exponent of the step in the error at the first time that all runs have."""
    stepped = [pair for pair in shown if pair[0].sweep.accuracy is None]
    by_step = sorted(stepped, key=lambda pair: -pair[0].sweep.timestep)
    if len(by_step) < 2:
        return None
    for t in by_step[0][1].time[1:]:
        places = [int(np.argmin(np.abs(e.time - t))) for _, e in by_step]
        pairs = list(zip(by_step, places, strict=True))
        if all(abs(e.time[k] - t) <= 1e-9 * t and e.clear[k] for (_, e), k in pairs):
            steps = np.array([run.sweep.timestep for (run, _), _ in pairs])
            sizes = np.array([e.lengths[k] for (_, e), k in pairs])
            if any(e.lengths[k] > EARLY * e.size for (_, e), k in pairs):
                return None  # what has grown so far shows no order
            return _near(np.diff(np.log(sizes)) / np.diff(np.log(steps)))
    return None


def _of_time(error: _Error) -> float | None:
    """The exponent of the time, while the error is small."""
    used = np.flatnonzero(error.clear & (error.lengths <= EARLY * error.size) & (error.time > 0))
    if len(used) < LEAST:
        return None
    used = used[: 2 * LEAST]
    return _near(np.diff(np.log(error.lengths[used])) / np.diff(np.log(error.time[used])))
