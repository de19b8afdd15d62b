"""At which states an engine is wrong: what holds for all of these and for no sound one."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.wording.digits import limits
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.system import Array, State, System

# So many states on either side at least: the odds that chance sorts them are then below 1 in 20.
LEAST = 3
ODDS = 20  # as many times as conditions are tried must there be ways to sort the states
CLEAR = 1e-3  # relative: a narrower gap between two sides is chance, where many numbers are tried


def features_of_states(system: System, states: State) -> dict[str, tuple[Array, str]]:
    """Numbers of every state, (n,), with units."""
    w, v, x = states.angular_velocity, states.linear_velocity, states.position
    with np.errstate(all="ignore"):
        q = normalize(states.orientation)
        turned = 2.0 * np.arccos(np.clip(np.abs(q[:, 0]), 0.0, 1.0))
        energy = rotational_kinetic_energy(system, states)
    turn = rotation_matrix(q)
    found = {
        "|omega|": (norm(w), "rad/s"),
        "the angle from the identity": (turned, "rad"),
        "the quaternion's scalar part": (q[:, 0], ""),
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


def kinds_of_states(states: State) -> dict[str, NDArray[np.bool_]]:
    """What holds of a state exactly, or does not, (n,)."""
    w, q, v = states.angular_velocity, states.orientation, states.linear_velocity
    found = {
        "omega is zero": ~np.any(w, axis=-1),
        "the body does not move": ~np.any(v, axis=-1),
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


def only_where(parts: Sequence[tuple[System, State, NDArray[np.bool_]]]) -> str:
    """The condition, over the states of one scenario or of several; "" where none sorts them.

    parts: system, states (n,) and whether the engine is right at each.
    """
    sound = np.concatenate([right for _, _, right in parts])
    if np.count_nonzero(sound) < LEAST or np.count_nonzero(~sound) < LEAST:
        return ""
    exact = [kinds_of_states(states) for _, states, _ in parts]
    for text in exact[0]:
        holds = np.concatenate([one[text] for one in exact])
        if np.array_equal(holds, ~sound):
            return text
    every = [features_of_states(system, states) for system, states, _ in parts]
    ways = comb(len(sound), int(np.count_nonzero(sound)))
    if ways < ODDS * (len(exact[0]) + 2 * len(every[0])):
        return ""
    for text, (_, unit) in every[0].items():
        values = np.concatenate([one[text][0] for one in every])
        low, high = values[sound], values[~sound]
        if not np.all(np.isfinite(values)):
            continue
        for term, a, b in (("above", low, high), ("below", high, low)):
            below, above = float(np.max(a)), float(np.min(b))
            if term == "above" and not np.any(low):
                continue  # what vanishes with it is no limit
            if below < above and above - below > CLEAR * _spacing(values):
                return (
                    f"{text} is {term} a limit that lies at {limits(below, above, unit)}".replace(
                        " and ", " to "
                    )
                )
    return ""


def _spacing(values: Array) -> float:
    """The usual distance of neighbours, which a gap must not be much narrower than."""
    return float(np.median(np.diff(np.sort(values))))
