"""What holds of a system in a state, and its sizes, as the columns of a table of states."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.wording.features import ANY_TORQUE, COMPONENT, Features, features_of
from omegadot.diagnosis.wording.inertia_features import ABOUT
from omegadot.diagnosis.wording.state_features import (
    Numbers,
    features_of_states,
    further_features,
    kinds_of_states,
)
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import damping_torque, gravity_torque
from omegadot.reference_impl.system import Array, State, System

START = ("the first", "at the start")  # of a run, of which an answer at a state knows nothing
SIGNS = (("negative", -1.0), ("positive", 1.0))
UNDEFINED = np.nan  # either way is right
SEVERAL = "several torques act (applied, of damping or of the weight)"


@dataclass(frozen=True)
class Traits:
    """Of states (n,) of one system.

    plain: by sentence, 1 where it holds, 0 where not, NaN where that is not defined, (n,).
    particular: the same of single components and of the inertia.  sizes: (n,) with units.
    """

    plain: dict[str, Array]
    particular: dict[str, Array]
    sizes: Numbers


def traits_of(system: System, states: State) -> Traits:
    """What answers at these states may depend on."""
    count = len(states.angular_velocity)
    whole = features_of(system, states[0])

    def everywhere(kinds: Iterator[tuple[str, bool | None]]) -> dict[str, Array]:
        return {
            text: np.full(count, UNDEFINED if holds is None else float(holds))
            for text, holds in kinds
        }

    kinds = {t: h for t, h in whole.kinds.items() if not any(start in t for start in START)}
    plain = everywhere((t, h) for t, h in kinds.items() if COMPONENT not in t)
    particular = everywhere((t, h) for t, h in kinds.items() if COMPONENT in t)
    particular |= everywhere(_signs(system)) | everywhere(_of_inertia(whole))
    plain |= _torques(system, states)
    for text, held in kinds_of_states(states).items():
        plain[text] = held.astype(float)
    w = states.angular_velocity
    for k, axis in enumerate("xyz"):
        for sign, way in SIGNS:
            particular[f"omega's {axis} component is {sign}"] = (way * w[:, k] > 0.0).astype(float)
    with np.errstate(all="ignore"):
        sizes = features_of_states(system, states) | further_features(system, states)
    for text, (size, unit) in whole.sizes.items():
        if not any(start in text for start in START):
            sizes[text] = np.full(count, size), unit
    for text, part in _asymmetries(system):
        sizes[text] = np.full(count, part), ""
    return Traits(plain, particular, sizes)


def _asymmetries(system: System) -> Iterator[tuple[str, float]]:
    """How far two moments on the diagonal differ, as a part of the third, or of the larger."""
    kept = np.diag(np.asarray(moving_inertia(system), dtype=float))
    names = ("Ixx", "Iyy", "Izz")
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        apart, text = float(abs(kept[i] - kept[j])), f"|{names[i]} - {names[j]}|"
        yield f"{text} / {names[k]}", apart / float(kept[k])
        yield f"{text} / max({names[i]}, {names[j]})", apart / float(max(kept[i], kept[j]))


def _torques(system: System, states: State) -> dict[str, Array]:
    """How many kinds of torque act: none, one or several."""
    load, zero = system.load, np.zeros_like(states.angular_velocity)
    with np.errstate(all="ignore"):
        of_weight = gravity_torque(system, states) if load.pivot is not None else zero
        parts = (
            load.torque_body + zero,
            load.torque_world + zero,
            damping_torque(system, states) if np.any(load.damping) else zero,
            of_weight,
        )
    count = sum(np.any(part != 0.0, axis=-1).astype(float) for part in parts)
    pulled = bool(load.pivot is not None and np.any(load.gravity) and np.any(lever(system)))
    return {
        ANY_TORQUE: (count > 0.0).astype(float),
        SEVERAL: (count > 1.0).astype(float),
        "the weight exerts a torque about the pivot": np.full(len(zero), float(pulled)),
    }


def _signs(system: System) -> Iterator[tuple[str, bool | None]]:
    """Of every component of a vector; zero has neither sign."""
    body, load = system.body, system.load
    for what, vector in {
        "gravity's": load.gravity,
        "the body torque's": load.torque_body,
        "the world torque's": load.torque_world,
        "the centre of mass's": body.center_of_mass,
        "the pivot's": np.zeros(3) if load.pivot is None else load.pivot,
        "the lever's": np.zeros(3) if load.pivot is None else lever(system),
    }.items():
        for value, axis in zip(np.asarray(vector, dtype=float), "xyz", strict=True):
            for sign, way in SIGNS:
                yield f"{what} {axis} component is {sign}", bool(way * value > 0.0)
    tensor = np.asarray(body.inertia, dtype=float)
    for i, j in ((0, 1), (0, 2), (1, 2)):
        value, text = tensor[i, j], f"the product {'xyz'[i]}{'xyz'[j]} of the inertia"
        for sign, way in SIGNS:
            yield f"{text} is {sign}", bool(way * value > 0.0)
        yield f"{text} is not zero", bool(value != 0.0)


def _of_inertia(whole: Features) -> Iterator[tuple[str, bool | None]]:
    for text, holds in whole.inertia.items():
        for about, held in zip(ABOUT, holds, strict=True):
            yield text.format(about), held
