"""A load whose impulse in a step, its size times the step's length, is held below a number."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from omegadot.diagnosis.equations.operators.operands import gyroscopic
from omegadot.diagnosis.stepping.kept_run import CHANNELS, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.loads.acting import shares_of
from omegadot.diagnosis.stepping.loads.load_parts import (
    fitted_parts,
    leads,
    least_stated,
    looked_at,
    missed,
    own_scheme,
)
from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

Torque = Callable[[System, State], Array]
TORQUES: Mapping[str, Torque] = {
    "the applied torque in body axes": lambda system, state: system.load.torque_body,
    "the applied torque in world axes": lambda system, state: rotate_inverse(
        state.orientation, system.load.torque_world
    ),
    "the applied torque": applied_torque,
    "the damping": damping_torque,
    "the gyroscopic term": gyroscopic,
    "the torque of gravity": gravity_torque,
}
MOST_TRIED = 3  # runs, in which an impulse is looked for


def impulse_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The load whose impulse in a step is held below a number in all runs; none without any."""
    with np.errstate(all="ignore"):
        failing, _ = looked_at(runs)
        for run in failing[:MOST_TRIED]:
            found = _impulses(run.short, by)
            if found:
                made = {
                    name: f"in the steps, the impulse of {name} in one step is held below "
                    f"{number(most)} N m s"
                    for name, most in found.items()
                    if _makes(name, most, by, runs)
                }
                return least_stated(made)
    return []


def _impulses(run: KeptRun, by: SchemeOf) -> dict[str, float]:
    """Of each load the impulse below which it makes one run, where that is less than its own."""
    own, found = own_scheme(run, by), dict[str, float]()
    shares = shares_of(run, by) if own is not None else {}
    for name in TORQUES.keys() & shares.keys():
        share = shares[name].share
        due = run.timestep * norm(_torque(name, run.system, run.state[:-1]))
        held = (share < 1.0) & (share > 0.0) & shares[name].used
        if own is None or not held.any():
            continue
        most = _fitted(run, own, name, float(np.median((share * due)[held])))
        if 0.0 < most < float(np.max(due)):
            found[name] = most
    return found


def _fitted(run: KeptRun, own: SchemeOf, name: str, start: float) -> float:
    """The impulse with which the run is made; nan where none does it."""
    shows = np.ones((1, len(CHANNELS)))

    def off(part: Array) -> tuple[Array, Array]:
        return missed(run, run.ends(own, _held(run, own, name, start * part), 1), shows)

    (one,) = fitted_parts(1, off)
    most, room = start * one.part, start * one.known_to
    short = float(f"{most:.6g}")  # in six digits, where it is not known to be another
    return (short if abs(short - most) <= room else most) if one.fits and one.shows else np.nan


def _torque(name: str, system: System, state: State) -> Array:
    return TORQUES[name](system, state) + 0.0 * state.angular_velocity


def _held(run: KeptRun, own: SchemeOf, name: str, most: float | Array) -> Motion:
    """The body's motion with the load scaled down to an impulse in N m s."""
    system, back = run.system, inverse(moving_inertia(run.system))

    def acceleration(state: State) -> Acceleration:
        true, torque = forward_dynamics(system, state), _torque(name, system, state)
        due = run.timestep * norm(torque)[..., None]
        less = torque * np.maximum(0.0, 1.0 - most / np.where(due > 0.0, due, np.inf))
        return Acceleration(true.angular - apply(back, np.where(due > 0.0, less, 0.0)), true.linear)

    return motion_over(system, own.coordinates, acceleration)


def _makes(name: str, most: float, by: SchemeOf, runs: Sequence[KeptRun]) -> bool:
    """Whether the limit leads from each sample to the next, in all runs in which it acts."""
    for run in sorted(runs, key=lambda run: (not run.fails, run.sweep.every)):
        own = own_scheme(run, by)
        if own is None:
            return False
        due = run.timestep * norm(_torque(name, run.system, run.state))
        acts = run.fails or float(np.max(due)) > most
        if acts and not np.all(leads(run, own, _held(run, own, name, most), 1)):
            return False
    return True
