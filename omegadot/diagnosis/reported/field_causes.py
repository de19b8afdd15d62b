"""Causes in one quantity of a run, all others being right: what is made of it before it is logged.

What is logged of a quantity is held against values around the same sample: its own, those of the
sample before, what was logged before, and the difference quotient of what it is the rate of. An
attitude is also held against those on the way from the one before.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.reported.of_steps import SLACK, Way, ways_of_steps
from omegadot.diagnosis.reported.recursions import added_in_steps, both_summed, sums_of_steps
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import (
    conjugate,
    exp_quaternion,
    normalize,
    quaternion_product,
    rotation_between,
)
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

LEAST = 5  # samples
NEAR = 1e-6  # a share that is none, or all
SMALL = ", for small angles"
QUANTITIES = {
    "angular_velocity": ("omega", "rad/s"),
    "linear_velocity": ("the linear velocity", "m/s"),
    "position": ("the position", "m"),
}


def field_causes(reported: ReportedRun) -> list[str]:
    """What makes the one quantity that is wrong, or places that are summed up; else none."""
    own, came = reported.own, reported.state
    if len(came.position) != len(own.position) or len(came.position) < LEAST:
        return []
    later = slice(1, None)
    if reported.agrees(came[later], own[later], later):
        return []
    for name, (what, unit) in QUANTITIES.items():
        right = replace(came, **{name: getattr(own, name)})
        if reported.agrees(right[later], own[later], later):
            made = _ways(reported, name, what, unit)
            return _plain(text for text, v, slack in made if _is(reported, name, v, slack))
    name = "orientation"
    right = replace(came, orientation=own.orientation)
    if not reported.agrees(right[later], own[later], later):
        return both_summed(reported)
    made = _attitude_ways(reported)
    return list(dict.fromkeys(t for t, v, slack in made if _is(reported, name, v, slack)))


def _is(reported: ReportedRun, name: str, values: Array, slack: float) -> bool:
    """Whether these values are the logged ones, and the right ones are not, within the rounding."""
    other, later = replace(reported.own, **{name: values}), slice(1, None)
    came, own = reported.state[later], reported.own[later]
    made = reported.agrees(came, other[later], later, slack)
    return made and not reported.agrees(came, own, later, slack)


def _plain(found: Iterable[str]) -> list[str]:
    """Without those that add to another what makes no difference here."""
    texts = list(found)
    return [
        text for text in texts if not text.endswith(SMALL) or text.removesuffix(SMALL) not in texts
    ]


def _ways(reported: ReportedRun, name: str, what: str, unit: str) -> Iterator[Way]:
    due, came = getattr(reported.own, name), getattr(reported.state, name)
    with np.errstate(all="ignore"):
        largest, longest = float(np.max(np.abs(came[1:]))), float(np.max(norm(came[1:])))
        short = due * np.minimum(1.0, longest / norm(due))[:, None]
    clip = f"is reported within {number(float(f'{largest:.9g}'))} {unit}"
    yield f"each component of {what} {clip}", np.clip(due, -largest, largest), SLACK
    yield f"{what} is reported below {number(float(f'{longest:.9g}'))} {unit}", short, SLACK
    every = reported.stepped(every_step=True)
    yield from _quotients(reported, every, name, what)
    yield from _shares(due, came, what)
    yield from sums_of_steps(reported, every, name)
    yield from added_in_steps(reported, every) if name == "position" else ()
    yield from ways_of_steps(reported, every, name, what)


def _attitude_ways(reported: ReportedRun) -> Iterator[Way]:
    """On the way from the attitude of the step or of the sample before to its own, or past it.

    Along the great arc between the two quaternions, or along the chord and normalised.
    """
    every = reported.stepped(every_step=True).orientation
    numbers, came = reported.sweep.sample_steps, reported.state.orientation
    own, places = every[numbers], np.arange(len(numbers))
    if not np.isfinite(came).all():
        return
    ways = {
        "step": every[np.maximum(numbers - 1, 0)],
        "sample": own[np.maximum(places - 1, 0)],
    }
    for which, before in ways.items():
        whole = rotation_between(before, own)
        gone = rotation_between(before, came)
        size = float(np.sum(whole * whole))
        share = float(np.sum(whole * gone)) / size if size > 0.0 else 1.0
        if abs(share - 1.0) < NEAR or abs(share) < NEAR:
            continue
        between = _between(share, f"that of the {which} before")
        arc = quaternion_product(before, exp_quaternion(share * whole))
        yield between, arc, SLACK
        near = own * np.sign(np.sum(own * before, axis=-1, keepdims=True))
        lines = np.stack([np.ravel(near), np.ravel(before)], axis=-1)
        signed = came * np.sign(np.sum(came * before, axis=-1, keepdims=True))
        one, other = np.linalg.lstsq(lines, np.ravel(signed), rcond=None)[0]
        if abs(one + other) > NEAR:
            mixed = normalize(one * near + other * before)
            yield _between(float(one / (one + other)), f"that of the {which} before"), mixed, SLACK


def _between(share: float, before: str) -> str:
    if abs(share - 0.5) < NEAR:
        return f"the attitude is reported halfway between {before} and its own"
    return f"the attitude is reported as {written(share, 4)} of the way from {before} to its own"


def _quotients(reported: ReportedRun, every: State, name: str, what: str) -> Iterator[Way]:
    """Over the sample or the step before, and about the sample."""
    if name == "position":
        return
    numbers, h = reported.sweep.sample_steps, reported.sweep.timestep
    before = np.maximum(numbers - 1, 0)
    of = "the attitude" if name == "angular_velocity" else "the position"
    text = f"{what} is a difference quotient of {of}, over the"
    last = np.maximum(np.arange(len(numbers)) - 1, 0)
    own, time = reported.own, reported.sweep.times
    with np.errstate(all="ignore"):
        # a difference has the rounding of what it is of, over a short time
        slack = SLACK * max(1.0, 1.0 / (h * reported.truth.yardstick.rate))
        length = (time - time[last])[:, None]
        for which, start, over in (("step", every[before], h), ("sample", own[last], length)):
            yield f"{text} {which} before", _change(name, start, own) / over, slack
            if name == "angular_velocity":
                turn = quaternion_product(conjugate(start.orientation), own.orientation)
                small = 2.0 * turn[..., 1:] * np.sign(turn[..., :1])
                yield f"{text} {which} before{SMALL}", small / over, slack


def _change(name: str, before: State, after: State) -> Array:
    if name == "angular_velocity":
        return rotation_between(before.orientation, after.orientation)
    return after.position - before.position


def _shares(due: Array, came: Array, what: str) -> Iterator[Way]:
    """Of the new value and the one before, or of the new value and what was logged before."""
    ways = {
        "of that of the sample before": (due[1:], due[:-1]),
        "of what was reported before: it is filtered": (due[1:], came[:-1]),
    }
    for text, (new, old) in ways.items():
        lines = np.stack([np.ravel(new), np.ravel(old)], axis=-1)
        if not (np.isfinite(lines).all() and np.isfinite(came).all()):
            return
        one, other = np.linalg.lstsq(lines, np.ravel(came[1:]), rcond=None)[0]
        if abs(other) < NEAR:
            continue
        values = np.concatenate((came[:1], one * new + other * old))
        shown = f"{number(float(f'{one:.6g}'))} of itself and {number(float(f'{other:.6g}'))}"
        if abs(one) < NEAR:
            yield f"{what} alone is reported one sample late", values, SLACK
        else:
            yield f"{what} is reported as {shown} {text}", values, SLACK
