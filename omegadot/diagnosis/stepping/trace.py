"""Causes in a trace: what leads from every sample to the next, by other equations side by side.

A trace has no forward dynamics and cannot be stepped again from elsewhere. From each sample a
hypothesis is stepped to the next one, so that an error made once does not spoil the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.equation_form import (
    Form,
    accelerations,
    form_of,
    same_form,
    stacked,
)
from omegadot.diagnosis.equations.families import ONE_NUMBER, Family
from omegadot.diagnosis.equations.hypotheses import hypotheses, wrong_form
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import attitude_angle, normalize
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

MOST_SAMPLES = 48  # intervals, spread over the trace
RADIANS = 0.01  # of a step between samples, where the trace's own is unknown
MOST_STEPS = 400
SLACK = 4.0
MOST_NAMED = 3
TRIES = 6
LEFT_OUT = ("report", "precision", "drag")


@dataclass(frozen=True)
class Trace:
    """times: (n,) s.  state: (n, ...), of which omega and attitude are looked at.

    omega_open and attitude_open: (n,) rad/s and rad, what the digits of the data leave open.
    scheme and timestep: how it was stepped, where that is known; else every scheme's error counts
    as wrong, but for that of a fourth-order one with short steps.
    """

    times: Array
    state: State
    omega_open: Array
    attitude_open: Array
    scheme: str | None = None
    timestep: float | None = None


def trace_causes(system: System, trace: Trace) -> list[str]:
    """Sentences that name a wrong equation by which the whole trace was made; none where none is.

    system: what it should be a motion of. A trace that follows the right equation, or none that is
    known, has none. It is held in omega, and in attitude, from each sample to the next.
    """
    with np.errstate(all="ignore"):
        return _causes(system, trace)


def _causes(system: System, trace: Trace) -> list[str]:
    intervals = _Intervals.of(system, trace)
    if intervals is None or intervals.fits([form_of(system)])[0]:
        return []
    known = [h for h in hypotheses(system) if h.part not in LEFT_OUT and not h.unlikely]
    made = [(one, wrong_form([one], system)) for one in known]
    usable = [(one, form) for one, form in made if form is not None]
    fits = intervals.fits([form for _, form in usable])
    texts, kept = list[str](), list[Form]()
    for (one, form), good in zip(usable, fits, strict=True):
        if good and not any(same_form(form, other) for other in kept):
            texts.append(one.text.strip())
            kept.append(form)
    if not texts:
        found = [(family, intervals.numbers(family)) for family in ONE_NUMBER]
        texts = [family.text(system, p) for family, p in found if p is not None]
    if not 0 < len(texts) <= MOST_NAMED:
        return []
    return [texts[0] if len(texts) == 1 else "either " + ", or ".join(texts)]


@dataclass(frozen=True)
class _Intervals:
    """Starts and ends (m, ...) of intervals of a trace, with their lengths (m,) s and bounds."""

    system: System
    start: State
    end: State
    length: Array
    bounds: tuple[Array, Array]
    scheme: Scheme
    steps: int

    @classmethod
    def of(cls, system: System, trace: Trace) -> _Intervals | None:
        """Some intervals; None where there are none, or too long ones."""
        if len(trace.times) < 3:
            return None
        first = np.unique(np.linspace(0, len(trace.times) - 2, MOST_SAMPLES).round().astype(int))
        length, scheme = trace.times[first + 1] - trace.times[first], SCHEMES["munthe-kaas-rk4"]
        rate = float(np.max(norm(trace.state.angular_velocity)))
        steps = int(np.ceil(float(np.max(length)) * rate / RADIANS)) or 1
        known = trace.scheme in SCHEMES and trace.timestep is not None
        if known and trace.timestep is not None and trace.scheme is not None:
            whole = np.round(length / trace.timestep).astype(int)
            usual = int(np.median(whole))
            first, length = first[whole == usual], length[whole == usual]
            scheme, steps = SCHEMES[trace.scheme], usual
        if not 0 < steps <= MOST_STEPS or not len(first):
            return None
        state = State(**{**vars(trace.state), "orientation": normalize(trace.state.orientation)})
        left = 0.0 if known else RADIANS**4
        omega, attitude = (
            SLACK * (opened[first] * (1.0 + rate * length) + opened[first + 1])
            for opened in (trace.omega_open, trace.attitude_open)
        )
        rounding = 64 * np.finfo(float).eps * steps + left
        bounds = (omega + rate * rounding, attitude + omega * length + rounding)
        return cls(system, state[first], state[first + 1], length, bounds, scheme, steps)

    def ends(self, forms: Sequence[Form]) -> State:
        """(lanes, m, ...): where each equation leads."""
        lanes = stacked(forms)
        motion = motion_over(self.system, "com-world", lambda state: accelerations(lanes, state))
        start = {
            name: np.broadcast_to(x, (len(forms), *x.shape)).copy()
            for name, x in vars(self.start).items()
        }
        plan = (self.length / self.steps, self.steps, self.steps)
        return step_body(self.scheme, self.system, State(**start), *plan, motion=motion)[1][-1]

    def fits(self, forms: Sequence[Form]) -> list[bool]:
        """Whether each equation leads from every sample to the next."""
        ends = self.ends(forms)
        omega = norm(ends.angular_velocity - self.end.angular_velocity) <= self.bounds[0]
        turned = attitude_angle(ends.orientation, self.end.orientation) <= self.bounds[1]
        return [bool(good) for good in np.all(omega & turned, axis=-1)]

    def numbers(self, family: Family) -> Array | None:
        """The number with which a family leads from sample to sample; None if none does."""
        right, starts = form_of(self.system), family.starts(self.system)
        if not starts:
            return None
        p = np.asarray(starts[0], dtype=float)
        delta = 1e-4 * (float(np.abs(p[0])) or _unit(self.system, family))
        for _ in range(TRIES):
            try:
                forms = [family.form(right, self.system, p + d) for d in (0.0, delta)]
            except (ValueError, np.linalg.LinAlgError):
                return None  # no body has such numbers
            ends = self.ends(forms).angular_velocity / self.bounds[0][:, None]
            line = np.ravel(ends[1] - ends[0]) / delta
            rest = np.ravel(self.end.angular_velocity / self.bounds[0][:, None] - ends[0])
            size = float(line @ line)
            if not size > 0.0 or not np.isfinite(size):
                return None
            if self.fits(forms[:1])[0]:
                return p
            p = p + float(line @ rest) / size
            if not np.isfinite(p).all():
                return None
        return None


def _unit(system: System, family: Family) -> float:
    return float(np.trace(form_of(system).spin)) if family.unit == "kg m^2" else 1.0
