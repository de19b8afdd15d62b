"""Causes in the samples of a sound run: rounded to digits, or of half a step before."""

from dataclasses import replace

import numpy as np

from omegadot.diagnosis.reported_run import ReportedRun
from omegadot.gates.equation import BOUND
from omegadot.gates.scales import angular_size, norm
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.system import Array

MOST_DIGITS = 15  # seventeen determine every double, and sixteen most


def not_unit(reported: ReportedRun) -> str:
    """The turning is sound but for the quaternion's length, which may move the places, too."""
    length = norm(reported.state.orientation)[:, None]
    off = float(np.max(np.abs(length - 1.0)))
    places = {"position": reported.own.position, "linear_velocity": reported.own.linear_velocity}
    unit = replace(reported.state, orientation=reported.state.orientation / length, **places)
    if reported.agrees(replace(reported.state, **places), reported.own) or not reported.agrees(
        unit, reported.own
    ):
        return ""
    return f"the quaternion is not of unit length in the run: it is off by up to {off:.1e}"


def digits_reported(reported: ReportedRun) -> str:
    """Every number of the run is one of a few decimal digits."""
    numbers = np.concatenate([np.ravel(values) for values in vars(reported.state).values()])
    if not np.all(np.isfinite(numbers)):
        return ""
    digits = _digits(numbers)
    own = np.concatenate([np.ravel(values) for values in vars(reported.own).values()])
    if digits > MOST_DIGITS or _digits(own) <= digits:
        return ""
    return f"the numbers of the run have {digits} digits: they went through text"


def _digits(numbers: Array) -> int:
    """How many significant digits determine all of these numbers."""
    needed = 1
    for number in numbers.tolist():
        while needed < MOST_DIGITS + 2 and float(f"{number:.{needed}g}") != number:
            needed += 1
    return needed


def half_step(reported: ReportedRun) -> str:
    """Attitude or omega, but for the start, are those of half a step before or after."""
    h = reported.sweep.timestep
    q, w = reported.own.orientation, reported.own.angular_velocity
    w_dot = forward_dynamics(reported.case.system, reported.own).angular
    for sign, when in ((-0.5, "before"), (0.5, "after")):
        turned = _but_for_the_start(q, turn_in_body(q, w, sign * h))
        if reported.agrees(reported.state, replace(reported.own, orientation=turned)):
            return f"the attitude reported is that of half a step {when}"
        moved = _but_for_the_start(w, w + sign * h * w_dot)
        if reported.agrees(reported.state, replace(reported.own, angular_velocity=moved)):
            return f"omega is reported as of half a step {when}"
    return ""


def _but_for_the_start(right: Array, wrong: Array) -> Array:
    return np.concatenate([right[:1], wrong[1:]])


def omega_dot_late(reported: ReportedRun, result: CaseResult) -> str:
    """omega-dot along the run is that of the sample before or after; the ends have none."""
    answer = result.runs[reported.integrator.name, reported.sweep.timestep]
    omega_dot = answer.result["omega_dot"][: len(reported.time)]
    system, inner = reported.case.system, slice(1, -1)
    true = forward_dynamics(system, reported.state)
    bound = BOUND * angular_size(system, reported.state, true)
    for shift, when in ((1, "before"), (-1, "after")):
        apart = norm(np.roll(true.angular, shift, axis=0) - omega_dot)
        if np.all(apart[inner] <= np.maximum(bound, np.roll(bound, shift))[inner]):
            return f"the omega-dot reported along the run is that of the sample {when}"
    return ""
