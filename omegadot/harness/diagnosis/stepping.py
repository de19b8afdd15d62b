"""Causes in the stepping: another scheme, another step, another force, a limit on omega."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.harness.diagnosis.told_run import ToldRun, told_run
from omegadot.harness.drive import CaseResult
from omegadot.harness.faults.step_ends import (
    End,
    clipped_at,
    held_below,
    left_multiplied,
    straight_quaternion,
    turned_by_last_omega,
    with_end,
)
from omegadot.harness.judge_case import JudgedRun
from omegadot.harness.plan import Case
from omegadot.harness.scales import norm
from omegadot.harness.truth import Truth
from omegadot.reference_impl.body_origin import is_offset
from omegadot.reference_impl.growth import changes
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State

ENDS: dict[str, End] = {
    "the attitude's change in body axes is multiplied from the left": left_multiplied,
    "the attitude is stepped as q + h/2 q omega and not normalised": straight_quaternion,
    "the attitude turns by the step's last omega alone": turned_by_last_omega,
}
MOST_TRIES = 8
MOST_STEPS = 5000  # causes are tried by stepping anew, and a step takes about 0.1 ms
# A fitted run has come out of a search that ends within rounding, and bounds are of one run.
SLACK = 4.0


def causes(case: Case, truth: Truth, result: CaseResult, run: JudgedRun) -> list[str]:
    """One sentence, or none."""
    told = told_run(case, truth, result, run)
    finite = told is not None and all(np.all(np.isfinite(f)) for f in vars(told.state).values())
    if told is None or not finite or len(told.time) != len(told.sweep.times):
        return []
    if told.sweep.steps > MOST_STEPS:
        return []
    for cause in (
        _precision,
        _asleep,
        _other_scheme,
        _other_end,
        _longer,
        _damped,
        _clipped,
        _held,
    ):
        said = cause(told)
        if said:
            return [said]
    return []


def _precision(told: ToldRun) -> str:
    """Attitude or omega of every sample after the start are numbers of single precision.

    Places are not looked at: they may follow, in double, from what is kept.
    """

    def single(state: State, field: str) -> bool:
        kept = getattr(state, field)[1:]
        moves = bool(np.ptp(kept, axis=0).any())  # a body put to sleep has zeros
        return moves and np.array_equal(kept, kept.astype(np.float32).astype(float))

    fields = {"orientation": "attitude", "angular_velocity": "omega"}
    found = [s for f, s in fields.items() if single(told.state, f) and not single(told.own, f)]
    what = "state" if len(found) == 2 else "".join(found)
    return f"the {what} is kept in single precision" if found else ""


def _asleep(told: ToldRun) -> str:
    still = ~np.any(told.state.angular_velocity, axis=-1)
    if not still.any() or not np.all(np.any(told.own.angular_velocity, axis=-1)):
        return ""
    first = int(np.argmax(still))
    if not np.all(still[first:]):
        return ""
    rate = float(norm(told.own.angular_velocity[first]))
    when = f"from t = {told.time[first]:.4g} s on"
    return f"the body is put to sleep: omega is zero {when}, where it should be {rate:.2g} rad/s"


def _held(told: ToldRun) -> str:
    """The greatest |omega| that is told is a limit, and nearly the one that the steps keep to."""
    greatest = float(np.max(norm(told.state.angular_velocity[1:])))
    if not 0.0 < greatest < float(np.max(norm(told.own.angular_velocity[1:]))):
        return ""
    declared = SCHEMES[told.integrator.scheme or ""]

    def stepped(more: float) -> State:
        return told.stepped(with_end(declared, held_below(greatest * (1.0 + more))))

    more = _search(told, stepped, 1e-6)
    return "" if more is None else f"omega is held below {greatest * (1.0 + more):.6g} rad/s"


def _clipped(told: ToldRun) -> str:
    """The greatest component of omega that is told is a limit to each of them."""
    greatest = float(np.max(np.abs(told.state.angular_velocity[1:])))
    if not 0.0 < greatest < float(np.max(np.abs(told.own.angular_velocity[1:]))):
        return ""
    declared = SCHEMES[told.integrator.scheme or ""]

    def stepped(more: float) -> State:
        return told.stepped(with_end(declared, clipped_at(greatest * (1.0 + more))))

    more = _search(told, stepped, 1e-6)
    if more is None:
        return ""
    return f"each component of omega is held within {greatest * (1.0 + more):.6g} rad/s"


def _other_scheme(told: ToldRun) -> str:
    for name, scheme in SCHEMES.items():
        declared = told.integrator.steps_origin
        for origin in (declared, not declared) if is_offset(told.case.system) else (declared,):
            other = replace(told, integrator=replace(told.integrator, steps_origin=origin))
            if told.agrees(told.state, other.stepped(scheme)):
                where = "the body's origin" if origin else "the centre of mass"
                if name == told.integrator.scheme:
                    return f"it steps {where}, which is not what is declared"
                return f"it is stepped by {name}, though {told.integrator.scheme} is declared"
    return ""


def _other_end(told: ToldRun) -> str:
    for said, end in ENDS.items():
        declared = SCHEMES[told.integrator.scheme or ""]
        if told.agrees(told.state, told.stepped(with_end(declared, end))):
            return said
    return ""


def _search(told: ToldRun, stepped: Callable[[float], State], delta: float) -> float | None:
    """The number with which a run comes to the told one, by Gauss-Newton; None if none does.

    delta: a small change of the number, of which one per cent is still told from rounding.
    """
    rate, found = told.truth.yardstick.rate, 0.0

    def apart(state: State) -> Array:
        return np.ravel(changes(state, told.state, rate))

    for _ in range(MOST_TRIES):
        here = stepped(found)
        if told.agrees(told.state, here, slack=SLACK):
            return found
        slope = (apart(here) - apart(stepped(found + delta))) / delta
        size = float(slope @ slope)
        if not size > 0.0 or not np.isfinite(size):
            return None
        found += float(slope @ apart(here)) / size
        if not np.isfinite(found):
            return None
    return None


def _longer(told: ToldRun) -> str:
    h = told.sweep.timestep
    part = _search(told, lambda k: told.stepped(timestep=h * (1.0 + k)), 1e-6)
    if part is None or part == 0.0:
        return ""
    return f"steps are {100 * abs(part):.4g} % too {'long' if part > 0 else 'short'}"


def _damped(told: ToldRun) -> str:
    system, yardstick = told.case.system, told.truth.yardstick

    def stepped(damping: float) -> State:
        more = replace(system.load, damping=system.load.damping + damping)
        return told.stepped(system=replace(system, load=more))

    scale = yardstick.scale.smallest / float(told.time[-1])  # takes a run's time to act
    found = _search(told, stepped, 1e-6 * scale)
    if found is None or found == 0.0:
        return ""
    return f"a damping of {found:.3g} N m s/rad acts in the steps that nobody asked for"
