"""Steps that take an old number: an operand of the step before, of the run's start, of a stage.

Every hypothesis is a lane. In it one operand of the equation, or of the step, is that of another
place of the same run; all else is the scheme's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.slips.memory import EARLIER, PLACES, PLACES_OF_SOLVED, Memory
from omegadot.diagnosis.stepping.slips.slips import OF_SCHEME
from omegadot.diagnosis.stepping.slips.staged_steps import STAGED
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Array, State, System

SOLVED = {"implicit-midpoint"}  # by an equation, in which nothing but operands can be old
STEPPED = {
    *SOLVED,
    "semi-implicit-euler",
    "rk4-quaternion",
    "lie-rk4",
    "munthe-kaas-rk4",
    *EXPLICIT,
}
# Operands that may be old together: what the cause states, of which place {} stands.
OPERANDS: dict[str, tuple[str, ...]] = {
    "the torque of gravity is taken at the attitude of {}": ("weight",),
    "the torque in world axes is taken at the attitude of {}": ("couple",),
    "the torques of gravity and in world axes are taken at the attitude of {}": (
        "weight",
        "couple",
    ),
    "the torque in body axes is taken along the body's axes of {}": ("body",),
    "the inertia in world axes is that of the attitude of {}": ("spin", "solve"),
    "the inertia in world axes is inverted at the attitude of {}": ("solve",),
    "the gyroscopic term takes the inertia in world axes of {}": ("spin",),
    "the gyroscopic term takes the omega of {}": ("gyroscopic",),
    "the damping takes the omega of {}": ("damping",),
    "the gyroscopic term and the damping take the omega of {}": ("gyroscopic", "damping"),
    "omega moves by the omega-dot of {}": ("angular",),
    "the attitude turns by the omega of {}": ("turn",),
    "the position moves by the velocity of {}": ("move",),
    "attitude and position move by the velocities of {}": ("turn", "move"),
}
SLACK = 4.0
MORE = 6  # samples, after the first that the scheme misses
EXPLAINS = 0.8  # of the runs that fail
LEAST_RUNS, MOST_SAMPLES = 3, 12  # in which an old number shows, from the second step on
Lane = tuple[str, str]  # an operand, as its text, and the place that it is of


def old_operands(by: SchemeOf, runs: Sequence[KeptRun], least: int = LEAST_RUNS) -> list[str]:
    """The operands of which each, taken from another place, makes the runs; none where none does.

    It makes the beginning of nearly every run that fails, and of every one that does not.
    """
    lanes = lanes_of(by)
    if not lanes:
        return []
    shows = shown_by(by, runs)
    failing = len(shows)
    if failing < least:
        return []
    made = Counter[Lane]()
    for run in (*shows, *(run for run in runs if not run.fails)):
        acting = acting_on(run.system)
        here = [lane for lane in lanes if lane[0] in acting]
        good = made_of(run, by, here) if here else set()
        if run.fails:
            made.update(good)
        else:
            lanes = [lane for lane in lanes if lane[0] not in acting or lane in good]
        if not lanes or (run is shows[least - 1] and not made):
            return []  # a mistake that is made in every run is seen in one of three
    most = max((made[lane] for lane in lanes), default=0)
    best = [lane for lane in lanes if made[lane] == most]
    if most < EXPLAINS * failing:
        return []
    return texts_of(best)


def lanes_of(by: SchemeOf) -> list[Lane]:
    """Each operand with each place that it may be of, by a scheme that is known."""
    name = by.scheme.name
    if name not in STEPPED or by.coordinates != "com-world":
        return []
    # within a step of these schemes the slips and the changes of single stages know the places
    within = name in STAGED or (name in OF_SCHEME and name not in EXPLICIT)
    places = PLACES_OF_SOLVED if name in SOLVED else PLACES[:3] if within else PLACES
    return [(text, where) for text in OPERANDS for where in places if _differs(text, where, name)]


def shown_by(by: SchemeOf, runs: Sequence[KeptRun]) -> list[KeptRun]:
    """Those that fail, and begin otherwise than the scheme."""
    return [run for run in runs if run.fails and not run.sound(by)[:MOST_SAMPLES].all()]


def texts_of(best: Sequence[Lane]) -> list[str]:
    """One of each place, as sentences."""
    plain = {where: text for text, where in reversed(best)}  # what states less comes first
    return [f"in each step {text.format(where)}" for where, text in reversed(plain.items())]


def _differs(text: str, where: str, name: str) -> bool:
    """In a scheme of one stage the step before has one place for what is no velocity."""
    moves = bool({"turn", "move"} & {*OPERANDS[text]})
    if name in SOLVED:
        return not moves and "angular" not in OPERANDS[text]
    return where != EARLIER or name != "semi-implicit-euler" or moves


def made_of(run: KeptRun, by: SchemeOf, lanes: Sequence[Lane]) -> set[Lane]:
    """Those that make the beginning of a run, a few samples more than the scheme itself makes."""
    sound = run.sound(by)
    first = len(sound) if sound.all() else int(np.argmin(sound))
    count = min(first + MORE, MOST_SAMPLES, len(sound))
    with np.errstate(all="ignore"):
        good = np.all(run.reached(_in_lanes(run, by, lanes, count), count), axis=-1)
    return {lane for lane, fits in zip(lanes, good, strict=True) if fits}


def acting_on(system: System) -> list[str]:
    """What is there to be old: an operand of no load, or of a sphere, is none."""
    load, pivoted = system.load, system.load.pivot is not None
    there = {
        "weight": pivoted and bool(np.any(load.gravity)) and bool(np.any(lever(system))),
        "couple": bool(np.any(load.torque_world)),
        "body": bool(np.any(load.torque_body)),
        "damping": bool(np.any(load.damping)),
        "move": not pivoted,
    }
    return [
        text for text, slots in OPERANDS.items() if any(there.get(slot, True) for slot in slots)
    ]


def _in_lanes(run: KeptRun, by: SchemeOf, lanes: Sequence[Lane], count: int) -> State:
    """(lanes, count, ...): the scheme with each of these operands old, at the samples."""
    q, v = to_coordinates(run.system, run.state[0], "com-world")
    q, v = (np.broadcast_to(x, (len(lanes), *x.shape)).copy() for x in (q, v))
    old = [(OPERANDS[text], where) for text, where in lanes]
    memory = Memory(run.system, old, solves=by.scheme.name in SOLVED)

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        memory.begin(q, v, h)
        return by.scheme.step(motion, q, v, h)

    remembering, every = replace(by.scheme, step=step), run.sweep.every
    plan = (run.sweep.timestep, count * every, every)
    found = step_through(remembering, memory.motion(), q, v, *plan)
    q, v = (np.moveaxis(x[1:], 0, 1) for x in (found.q, found.v))
    return from_coordinates(run.system, q, v, "com-world")
