"""How far samples diverge from the exact ones at the same time, channel by channel."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import polars as pl

from omegadot.reference_impl.energy import kinetic_energy, total_energy
from omegadot.reference_impl.momentum import angular_momentum, linear_momentum
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import Array, Body, Load, State, System

CHANNELS = ("omega_dot", "energy", "angular_momentum", "linear_momentum", "attitude")
STATE = [*("q" + axis for axis in "wxyz"), *(v + axis for v in "wapv" for axis in "xyz")]


def system_from(definition: Mapping[str, Any]) -> System:
    """The system as ``run.json`` holds it."""

    def array(value: object) -> Array:
        return np.asarray(value, dtype=float)

    pivot = definition["pivot"]
    load = Load(
        gravity=array(definition["gravity"]),
        pivot=None if pivot is None else array(pivot),
        damping=array(definition["damping"]),
        torque_body=array(definition["torque_body"]),
        torque_world=array(definition["torque_world"]),
    )
    body = Body(*(array(definition[key]) for key in ("mass", "center_of_mass", "inertia")))
    return System((body,), load)


def _states(samples: pl.DataFrame, suffix: str) -> tuple[State, Array]:
    columns = samples.select(name + suffix for name in STATE).fill_null(float("nan")).to_numpy()
    q, w, a, p, v = np.split(columns, [4, 7, 10, 13], axis=1)
    return State(q, w, p, v), a


def states_of(samples: pl.DataFrame, suffix: str = "") -> State:
    """The states (n,) of samples with the columns STATE, each with the suffix."""
    return _states(samples, suffix)[0]


def _norm(vectors: Array) -> Array:
    return np.asarray(np.sqrt(np.sum(vectors * vectors, axis=-1)))


def _placed(found: State, exact: State) -> State:
    """A trace that gives no position and velocity has the energy of its rotation compared."""
    given = (found.position, found.linear_velocity)
    turning = np.isfinite(found.angular_velocity).all(-1)
    absent = turning & np.all([np.isnan(part).all(-1) for part in given], axis=0)
    if not np.any(absent):
        return found
    rows = absent[:, None]
    return State(
        found.orientation,
        found.angular_velocity,
        np.where(rows, exact.position, found.position),
        np.where(rows, exact.linear_velocity, found.linear_velocity),
    )


def divergence(system: System, samples: pl.DataFrame) -> tuple[Array, dict[str, str]]:
    """(n, channels) errors of samples of one system, and the unit of each channel that matters.

    samples: time, and the columns STATE with and without the suffix ``_exact``; null becomes NaN.
    omega_dot: ``|omega_dot - exact|``, rad/s².  attitude: the angle between the two, rad.
    energy: ``|E - E_exact|`` over the largest exact kinetic energy; of the rotation alone where a
    trace gives no position and velocity.  Momenta: ``|H - H_exact|`` and ``|p - p_exact|``, world
    axes, over the largest exact one. All are absolute where that is zero.
    """
    (found, found_rate), (exact, exact_rate) = _states(samples, ""), _states(samples, "_exact")
    # Samples at the same time share the exact one: its quantities are computed once.
    _, first, at = np.unique(samples["time"], return_index=True, return_inverse=True)
    once = State(*(values[first] for values in vars(exact).values()))
    errors, units = np.full((len(samples), len(CHANNELS)), np.nan), {}
    # A diverged run may hold anything; its overflow is drawn at the top, not warned about.
    with np.errstate(all="ignore"):
        energy = total_energy(system, _placed(found, exact))
        exact_energy = total_energy(system, once)
        absolute = {
            "omega_dot": (_norm(found_rate - exact_rate), None, "rad/s²"),
            "energy": (np.abs(energy - exact_energy[at]), kinetic_energy(system, once), "J"),
            "attitude": (attitude_angle(found.orientation, exact.orientation), None, "rad"),
        }
        for channel, momentum, unit in (
            ("angular_momentum", angular_momentum, "kg m²/s"),
            ("linear_momentum", linear_momentum, "kg m/s"),
        ):
            truth = momentum(system, once)
            absolute[channel] = (_norm(momentum(system, found) - truth[at]), _norm(truth), unit)
        for k, channel in enumerate(CHANNELS):
            error, size, unit = absolute[channel]
            greatest = 0.0 if size is None else float(np.fmax.reduce(size, initial=0.0))
            relative = greatest > 0.0
            errors[:, k] = error / greatest if relative else error
            units[channel] = "1" if relative else unit
    if _without_meaning(system, absolute["linear_momentum"]):
        del units["linear_momentum"]
    return errors, units


def _without_meaning(system: System, measured: tuple[Array, Array | None, str]) -> bool:
    """Linear momentum where a pivot takes it up, or where nothing moves and nothing should."""
    error, size, _ = measured
    at_rest = size is not None and not np.any(size > 0.0) and not np.any(error > 0.0)
    return system.load.pivot is not None or at_rest
