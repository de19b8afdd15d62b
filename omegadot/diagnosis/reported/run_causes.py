"""Causes in what is reported of a run: frames, orders, samples, clocks; the stepping is sound."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.diagnosis.models.fitted_misreadings import ADDED, fitted_misreadings
from omegadot.diagnosis.models.misreadings import NOT_UNIT, OF_ANY_STATE, misreadings
from omegadot.diagnosis.reported.precision import decimals_reported, digits_reported
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.reported.sample_causes import half_step
from omegadot.diagnosis.wording.kinds import kind_of
from omegadot.gates.bounds.scales import norm
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.rotations import quaternion_product
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

NEAR = 1e-9  # relative: a number is passed on as it is, or through a few roundings
ROOM = 2.0  # steps; two neighbours are not of one length
LARGEST = float(np.sqrt(np.finfo(float).max))  # beyond it squares overflow


def begin_apart(reported: ReportedRun, result: CaseResult) -> str:
    """Runs of the same case that do not even begin at the same state; "" where all do.

    One that begins at what a run before it has come to, in one quantity at least that has moved, is
    left over from that.
    """
    first = slice(0, 1)
    runs = [
        (name, state)
        for (name, _), run in result.runs.items()
        if run.ok and len(run.result["time"]) and run.result["time"][0] == 0.0
        if _is_measurable(state := State(**run.result["state"]))
    ]
    states, given = [one for _, one in runs], reported.case.initial
    starts = [one[first] for one in states]
    apart = [n for n, one in enumerate(starts) if not reported.agrees(one, starts[0], first)]
    if any(_is_kept(states[n], before, given) for n in apart for before in states[:n]):
        return "runs begin at other states than the one given: one is left over from a run before"
    own = [one[first] for name, one in runs if name == reported.integrator.name]
    if all(reported.agrees(one, own[0], first) for one in own):
        return ""
    return "runs begin at other states than the one given, and at different ones"


def _is_measurable(state: State) -> bool:
    """Whether the first state is finite, and so is its distance from any other."""
    sizes = [np.abs(values[0]) for values in vars(state).values()]
    return all(bool(np.all(one < LARGEST)) for one in sizes)


def _is_kept(state: State, before: State, given: State) -> bool:
    """Whether a quantity begins where the run before has ended, and not where it was to begin.

    A step may lie between the two: one goes before every run, so that its cost is not counted.
    """
    begins, ends, due = vars(state), vars(before), vars(given)
    for name, values in begins.items():
        step = float(norm(np.diff(values[:2], axis=0)).sum())
        near = ROOM * step + NEAR * float(norm(values[0]))
        if norm(values[0] - ends[name][-1]) <= near < norm(values[0] - due[name]):
            return True
    return False


def not_finite(reported: ReportedRun) -> str:
    """From when on numbers are not finite; "" where all are."""
    finite = {name: np.isfinite(f).all(-1) for name, f in vars(reported.state).items()}
    bad = np.flatnonzero(~np.logical_and.reduce(list(finite.values())))
    if not len(bad):
        return ""
    names = [name.replace("_", " ") for name, ok in finite.items() if not ok.all()]
    before = reported.state[: bad[0]]
    sound = bad[0] > 0 and reported.agrees(before, reported.own[: bad[0]], slice(0, bad[0]))
    until = ", after a sound beginning" if sound else ""
    return (
        f"{' and '.join(names)}: not finite from t = {written(reported.time[bad[0]], 4)} s{until}"
    )


def last_repeated(reported: ReportedRun) -> str:
    """The last sample is the one before it in every number, and the body moves between them."""
    if len(reported.time) < 3:
        return ""
    end, before = slice(-1, None), slice(-2, -1)
    state, own = reported.state, reported.own
    same = [np.array_equal(values[-1], values[-2]) for values in vars(state).values()]
    asleep = all(np.array_equal(values[-2], values[-3]) for values in vars(state).values())
    if not all(same) or asleep or reported.agrees(own[before], own[end], end):
        return ""
    sweep = reported.sweep
    ends = [one.times[-1] for one in reported.case.sweeps if one.timestep == sweep.timestep]
    if ends and reported.time[-1] < ends[0]:
        return ""  # of a run that is looked at until it is off
    numbers = sweep.sample_steps
    short = numbers[-1] - numbers[-2] != reported.sweep.every
    where = ", after an interval shorter than the others," if short else ""
    return f"the last sample{where} is the one before, reported twice"


def misread(reported: ReportedRun) -> list[str]:
    """Conventions in which all samples are the declared run's: every one that fits."""
    if reported.agrees(reported.state, reported.own):
        return []
    later, own = slice(1, None), reported.own[1:]  # the start may be passed on as it was given
    came, found = reported.state[1:], list[str]()
    if len(own.position) > 1 and not reported.agrees(came, own, later):
        begins = reported.agrees(reported.state[:1], reported.own[:1], slice(0, 1))
        known = (one for one in misreadings(reported.case.system) if one is not NOT_UNIT)
        for one in (*known, *fitted_misreadings(came, own)):
            if ADDED in one.statement and not begins:
                continue  # it is a run from another state as well
            if reported.agrees(one.right(came), own, later):
                found.append(f"in the run, {one.statement}")
        first = reported.case.initial.orientation
        turned = quaternion_product(
            np.broadcast_to(first, came.orientation.shape), came.orientation
        )
        if reported.agrees(replace(came, orientation=turned), own, later):
            text = "the attitude of a run is relative to its start, or starts from the identity"
            found.append(text)
        moved = replace(came, position=reported.case.initial.position + came.position)
        if reported.agrees(moved, own, later):
            found = ["the position of a run is reported from where it began"]
        unsigned = own.orientation.copy()
        unsigned[:, 0] = np.abs(unsigned[:, 0])
        signed = bool(np.any(came.orientation[:, 0] < 0.0))
        if not signed and reported.agrees(came, replace(own, orientation=unsigned), later):
            found.append("the quaternion's scalar part is reported without its sign")
    for one in OF_ANY_STATE if not found else ():
        start = one.right(reported.case.initial)
        runs = (reported.beginning, reported)
        if all(run.agrees(one.right(run.state), run.stepped(initial=start)) for run in runs):
            found.append(f"on the way in and on the way out, {one.statement}")
    kinds = {kind_of(text): text for text in reversed(found)}
    plain = [text for text in found if "axes of" not in text and text in kinds.values()]
    return plain or found[:1]


def another_start(reported: ReportedRun) -> str:
    """The run begins at a state that is not the one given; "" where it does not."""
    first = slice(0, 1)
    if reported.agrees(reported.state[first], reported.own[first], first):
        return ""
    start = reported.state[0]
    unit = 0.5 < norm(start.orientation) < 2.0  # else it has hardly a direction
    if unit and reported.agrees(reported.state, reported.stepped(initial=start), slack=2.0):
        return "the run does not begin at the state it is given, and is sound from where it begins"
    return "the run does not begin at the state it is given"


def _rescaled(reported: ReportedRun) -> str:
    """Omega of the right direction and of a size that keeps something constant."""
    w, own = reported.state.angular_velocity, reported.own.angular_velocity
    sized = w * (norm(own) / norm(w))[:, None]
    if not reported.agrees(replace(reported.state, angular_velocity=sized), reported.own):
        return ""
    system = reported.case.system
    sizes: dict[str, Array] = {
        "kinetic energy of rotation": rotational_kinetic_energy(system, reported.state),
        "angular momentum": norm(angular_momentum(system, reported.state)),
    }
    bounds = reported.bounds
    for (what, size), channel in zip(sizes.items(), ("energy", "angular_momentum"), strict=True):
        if np.all(np.abs(size / size[0] - 1.0) <= bounds[channel]):
            return f"omega is rescaled so that the {what} stays the same"
    return ""


# What is seen of the numbers, whatever made them.
SEEN = (not_finite, last_repeated, digits_reported, decimals_reported)
CAUSES_REPORTED = (half_step, _rescaled)
