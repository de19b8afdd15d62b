"""What distinguishes states: sizes with units, and what holds of a state exactly."""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, State, System

Numbers = dict[str, tuple[Array, str]]


def features_of_states(system: System, states: State) -> Numbers:
    """Numbers of every state, (n,), with units; the plainest first."""
    w, v, x = states.angular_velocity, states.linear_velocity, states.position
    with np.errstate(all="ignore"):
        q = normalize(states.orientation)
        turned = 2.0 * np.arccos(np.clip(np.abs(q[:, 0]), 0.0, 1.0))
        energy = rotational_kinetic_energy(system, states)
    turn = rotation_matrix(q)
    found: Numbers = {
        "|omega|": (norm(w), "rad/s"),
        "the angle from the identity": (turned, "rad"),
        "the quaternion's scalar part": (q[:, 0], ""),
        "the sine of the pitch, 2 (w y - x z),": (-turn[:, 2, 0], ""),
        "the size of the sine of the pitch, |2 (w y - x z)|,": (np.abs(turn[:, 2, 0]), ""),
        "the kinetic energy of rotation": (energy, "J"),
        "the linear speed": (norm(v), "m/s"),
        "the distance from the world's origin": (norm(x), "m"),
    }
    for k, axis in enumerate("xyz"):
        tilt = turn[:, 2, k]
        found[f"the cosine of the tilt of the body's {axis} axis"] = (tilt, "")
        found[f"the size of the cosine of the tilt of the body's {axis} axis"] = (np.abs(tilt), "")
        found[f"omega_{axis}"] = (w[:, k], "rad/s")
        found[f"|omega_{axis}|"] = (np.abs(w[:, k]), "rad/s")
        found[f"the velocity along {axis}"] = (v[:, k], "m/s")
        found[f"the position along {axis}"] = (x[:, k], "m")
    return found


def further_features(system: System, states: State) -> Numbers:
    """More of them, which go with the plain ones on a single motion; nan where one is undefined."""
    return _directions(states.angular_velocity) | _dynamic(system, states)


def _directions(w: Array) -> Numbers:
    """How near omega is to an axis of the body; nan where there is none, as of an omega of zero."""
    found: Numbers = {}
    size = np.abs(w)
    with np.errstate(all="ignore"):
        for k, axis in enumerate("xyz"):
            others = [j for j in range(3) if j != k]
            largest = _over(np.max(size[:, others], axis=-1), size[:, k])
            found[f"the larger of omega's other components over |omega_{axis}|"] = (largest, "")
            angle = np.where(np.any(w, axis=-1), np.arctan2(norm(w[:, others]), size[:, k]), np.nan)
            found[f"the angle of omega from the body's {axis} axis"] = (angle, "rad")
        for j, k in permutations(range(3), 2):
            if j < k:
                text = f"|omega_{'xyz'[j]}| over |omega_{'xyz'[k]}|"
                found[text] = (_over(size[:, j], size[:, k]), "")
    return found


def _over(one: Array, other: Array) -> Array:
    """Finite over a zero as well; nan where both are zero, of which either side is right."""
    return np.minimum(one / other, np.finfo(float).max)


def _dynamic(system: System, states: State) -> Numbers:
    """Sizes of what the equation is made of, by which an engine may branch."""
    with np.errstate(all="ignore"):
        rate = norm(forward_dynamics(system, states).angular)
        energy = rotational_kinetic_energy(system, states)
        energy = energy + 0.5 * system.body.mass * norm(states.linear_velocity) ** 2
        w = states.angular_velocity
        about = 0.5 * np.sum(w * apply(moving_inertia(system), w), axis=-1)
        momentum = norm(angular_momentum(system, states))
        applied = norm(applied_torque(system, states) + 0.0 * w)
    return {
        "the kinetic energy of rotation, about the pivot where there is one,": (about, "J"),
        "the kinetic energy": (energy, "J"),
        "the kinetic energy over the mass": (energy / system.body.mass, "J/kg"),
        "the size of the angular momentum": (momentum, "kg m^2/s"),
        "|omega-dot|": (rate, "rad/s^2"),
        "the size of the applied torque, of both frames together,": (applied, "N m"),
    }


def kinds_of_states(states: State) -> dict[str, NDArray[np.bool_]]:
    """What holds of a state exactly, or does not, (n,)."""
    w, q, v = states.angular_velocity, states.orientation, states.linear_velocity
    found = {
        "omega is zero": ~np.any(w, axis=-1),
        "the body does not move": ~np.any(v, axis=-1),
        "the quaternion's scalar part is negative": q[:, 0] < 0.0,
        "the attitude is the identity": ~np.any(q[:, 1:], axis=-1),
    }
    for k, axis in enumerate("xyz"):
        others = [j for j in range(3) if j != k]
        turns = ~np.any(w[:, others], axis=-1)
        found[f"omega is along {axis} alone"] = turns & (w[:, k] != 0.0)
        found[f"omega has no {axis} component"] = w[:, k] == 0.0
        about = ~np.any(q[:, 1:][:, others], axis=-1)
        found[f"the body is turned about {axis} alone"] = about & (q[:, 1 + k] != 0.0)
    turning = np.count_nonzero(w, axis=-1)
    found["omega is along an axis of the body"] = turning == 1
    found["a component of omega is zero"] = (turning == 1) | (turning == 2)
    return found
