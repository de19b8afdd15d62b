"""A torque that is not of its state alone, but less that of a run's start, or that of a sample.

Each torque, in body axes or in world axes, is a lane. The start of a run is its first sample, so
that every interval is stepped by itself, from its own sample.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.operators.operands import gyroscopic, loads
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

EXPLAINS = 0.8  # of the runs that fail
LEAST_RUNS, SCENARIOS = 3, 2  # that show it
MOST_STEPS = 16  # between two samples
Torque = Callable[[System, State], Array]


def _of_world(system: System, states: State) -> Array:
    return applied_torque(system, states) - system.load.torque_body


# What states less comes first.
TORQUES: dict[str, Torque] = {
    "the torque of gravity": gravity_torque,
    "the torque in world axes": _of_world,
    "the torque of gravity and in world axes": lambda s, x: gravity_torque(s, x) + _of_world(s, x),
    "the torque of the damping": damping_torque,
    "the gyroscopic term": gyroscopic,
    "the torque of all loads": loads,
    "the whole torque": lambda system, states: loads(system, states) + gyroscopic(system, states),
}
LESS = "in a run, {} has that of the run's start{} subtracted from it"
HELD = "in a run, {} keeps its value of each sample{} until the next"
LANES = [(how, what, axes) for how in (LESS, HELD) for axes in (False, True) for what in TORQUES]


def kept_torque_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The torque of which this makes nearly every run that fails, and every one that does not."""
    near = [run for run in runs if run.sweep.every <= MOST_STEPS]
    failing = [run for run in near if run.fails and not run.sound(by).all()]
    lanes, made = np.ones(len(LANES), bool), np.zeros(len(LANES), int)
    names: list[set[str]] = [set() for _ in LANES]
    for count, run in enumerate((*failing, *(run for run in near if not run.fails)), start=1):
        fits = _fits(run, by)
        if run.fails:
            made += fits
            for lane in np.flatnonzero(fits):
                names[lane].add(run.name)
            lanes &= count - made <= (1.0 - EXPLAINS) * len(failing)
        else:
            lanes &= fits
        if not lanes.any():
            return []
    good = [k for k, on in enumerate(lanes) if on and made[k] >= LEAST_RUNS]
    good = [k for k in good if len(names[k]) >= SCENARIOS]
    most = max((made[k] for k in good), default=0)
    for how, what, world in (LANES[k] for k in good if made[k] == most):
        return [how.format(what, ", in world axes," if world else "")]
    return []


def _fits(run: KeptRun, by: SchemeOf) -> NDArray[np.bool_]:
    """(lanes,): whether each leads from every sample to the next."""
    own = SchemeOf(by.scheme, canonical(run.system, by.coordinates))
    if own.coordinates not in own.scheme.coordinates:
        return np.zeros(len(LANES), bool)
    with np.errstate(all="ignore"):
        good = run.reached(run.ends(own, _motion(run, own), len(LANES)))
    return np.asarray(np.all(good, axis=-1))


def _motion(run: KeptRun, by: SchemeOf) -> Motion:
    """The body's motion with another torque in each lane (lanes, m, ...)."""
    system, back = run.system, inverse(moving_inertia(run.system))
    first, samples = run.state[np.zeros(len(run.times) - 1, dtype=int)], run.state[:-1]
    values, in_world = list[Array](), list[Array]()
    for how, what, _ in LANES:
        start = first if how == LESS else samples
        values.append(TORQUES[what](system, start) + 0.0 * start.angular_velocity)
        in_world.append(rotate(start.orientation, values[-1]))
    own, there = np.stack(values), np.stack(in_world)
    turned = np.array([world for _, _, world in LANES])[:, None, None]
    held = np.array([how == HELD for how, _, _ in LANES])

    def acceleration(state: State) -> Acceleration:
        true = forward_dynamics(system, state)
        kept = np.where(turned, rotate_inverse(state.orientation, there), own)
        more = -kept
        for lane in np.flatnonzero(held):
            here = state[..., lane, :, :]  # differences for a Jacobian stand in front of the lanes
            due = TORQUES[LANES[lane][1]](system, here)
            more[..., lane, :, :] = kept[..., lane, :, :] - due
        return Acceleration(true.angular + apply(back, more), true.linear)

    return motion_over(system, by.coordinates, acceleration)
