"""Causes in the scheme: another of the reference, another end of each step, or a slip in it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT, scheme_named
from omegadot.diagnosis.stepping.slips.slips import slipped
from omegadot.diagnosis.stepping.step_ends import (
    End,
    damping_ends,
    kept_ends,
    left_multiplied,
    second_order_turn,
    single_trigonometry,
    straight_quaternion,
    turned_by_last_omega,
    with_end,
)
from omegadot.reference_impl.coordinates import PHRASES, canonical, distinct
from omegadot.reference_impl.schemes import COMMON
from omegadot.reference_impl.system import State, System

SINGLE_TURN = "sine and cosine of the turn of a step are in single precision"
ENDS: dict[str, End] = {
    "the attitude's change in body axes is multiplied from the left": left_multiplied,
    "the attitude is stepped as q + h/2 q omega and not normalised": straight_quaternion,
    "the attitude turns by the step's last omega alone": turned_by_last_omega,
    "the turn of a step is taken by the exponential's series to second order": second_order_turn,
    SINGLE_TURN: single_trigonometry(of_angle=False),
    f"{SINGLE_TURN}, as is its angle": single_trigonometry(of_angle=True),
}


def other_schemes(reported: ReportedRun) -> list[str]:
    """Schemes of the reference by which the run may be stepped, in the declared coordinates first.

    All that fit: a motion may be the same by several.
    """
    system, declared = reported.case.system, reported.integrator.coordinates
    own = canonical(system, declared)
    for way in sorted(distinct(system), key=lambda way: way != own):
        other = replace(reported, integrator=replace(reported.integrator, coordinates=way))
        found = list[str]()
        for name, scheme in COMMON.items():
            same = name == reported.integrator.scheme
            if way not in scheme.coordinates or (same and way == own):
                continue  # what is declared: this is not what is wrong
            if not other.is_made(partial(ReportedRun.stepped, scheme=scheme)):
                continue
            if same:
                return [f"it steps {PHRASES[way]}, which is not what is declared"]
            found.append(name)
        if found:
            names = " or ".join(found)
            return [f"it is stepped by {names}, though {reported.integrator.scheme} is declared"]
    return []


def explicit_schemes(reported: ReportedRun) -> list[str]:
    """Explicit schemes that the reference has not and that make the run; all that fit."""
    way, declared = reported.integrator.coordinates, reported.integrator.scheme
    return [
        f"it is stepped by {name}, though {declared} is declared"
        for name, scheme in EXPLICIT.items()
        if way in scheme.coordinates
        and reported.is_made(partial(ReportedRun.stepped, scheme=scheme))
    ]


def _ended(end: End, run: ReportedRun, system: System | None = None) -> State:
    return run.stepped(with_end(run.declared, end), system)


def other_ends(reported: ReportedRun) -> list[str]:
    """Ends of every step that make the run out of the declared scheme's."""
    ends = ENDS | kept_ends(reported.case.system)
    return [text for text, end in ends.items() if reported.is_made(partial(_ended, end))]


def slips_of(reported: ReportedRun, name: str) -> list[str]:
    """A scheme with one slip in it, whatever is declared or guessed; what states less first.

    All that fit: some differ in what this motion does not have. None where the scheme fits as it
    is, or where it is no mistake: what a slip makes of Euler's method is a first-order scheme.
    """
    due = max(filter(None, reported.integrator.orders.values()), default=0)
    if not reported.integrator.scheme and due <= 1 and name == "semi-implicit-euler":
        return []
    first = reported.until(2)  # the first interval rules out most of them
    if name and reported.is_made(partial(ReportedRun.stepped, scheme=scheme_named(name))):
        return []
    return [
        f"it is stepped by {name}, but {text}"
        for text, scheme in slipped(name).items()
        if reported.integrator.coordinates in scheme.coordinates
        and first.agrees(first.state, first.stepped(scheme))
        and reported.is_made(partial(ReportedRun.stepped, scheme=scheme))
    ]


def slips(reported: ReportedRun) -> list[str]:
    """The declared scheme with one slip in it, or with the damping split off."""
    found = slips_of(reported, reported.integrator.scheme or "")
    if found:
        return found
    system = reported.case.system
    if not float(system.load.damping):
        return []
    undamped = replace(system, load=replace(system.load, damping=np.zeros(())))
    return [
        f"the damping is split off each step: it acts {text}"
        for text, end in damping_ends(system).items()
        if reported.is_made(partial(_ended, end, system=undamped))
    ]
