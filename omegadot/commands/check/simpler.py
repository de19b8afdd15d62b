"""Ways in which a system can be simpler: each makes the tables of a scenario from others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from omegadot.commands.check.tables import IDENTITY, UNUSUAL, ZERO, Tables, scaled

Simpler = Callable[[Tables], Tables]

LOADS = ("torque", "gravity", "damping", "pivot", "center_of_mass")
NO_TORQUE = [{"frame": "body", "value": ZERO}]
FRAMES = ("body", "world")
VECTORS = (
    ("initial", "angular_velocity"),
    ("load", "gravity"),
    ("load", "pivot"),
    ("body", "center_of_mass"),
)


def _with(tables: Tables, table: str, **values: Any) -> Tables:
    """The tables with other values; None takes a key out."""
    changed = {**tables[table], **values}
    return {**tables, table: {k: v for k, v in changed.items() if v is not None}}


def _in_its_own_units(tables: Tables, units: str) -> Tables:
    """A mass of one, a size and a rate of about one, or some of the three.

    A size of one is that of moments 1, 2, 3 at a mass of one.
    """
    body, rate = tables["body"], float(np.linalg.norm(tables["initial"]["angular_velocity"]))
    size = float(np.sqrt(np.trace(body["inertia"]) / body["mass"] / 6.0))
    time = 1.0 / rate if rate else tables["run"]["duration"]
    own = {"mass": body["mass"], "size": size, "time": time}
    near = {"mass": 0.0, "size": UNUSUAL, "time": UNUSUAL}
    far = {k: k in units and abs(np.log10(own[k])) > near[k] for k in own}
    return scaled(tables, **{k: own[k] if far[k] else 1.0 for k in own})


def _without(tables: Tables, loads: Sequence[str] = LOADS) -> Tables:
    """Without these loads; an offset centre of mass counts as one."""
    nothing = {"torque": NO_TORQUE, "gravity": ZERO, "damping": 0.0, "pivot": None}
    if "center_of_mass" in loads:
        tables = _with(tables, "body", center_of_mass=ZERO)
    return _with(tables, "load", **{load: nothing[load] for load in loads if load in nothing})


def _without_one_torque(tables: Tables, frame: str) -> Tables:
    """The other torque alone, where there are two."""
    torques = tables["load"]["torque"]
    others = [one for one in torques if one["frame"] != frame]
    return _with(tables, "load", torque=others or torques)


def _unturned(tables: Tables) -> Tables:
    return _with(tables, "initial", orientation=IDENTITY)


def _in_place(tables: Tables) -> Tables:
    return _with(tables, "initial", position=None, linear_velocity=None)


def _bare(tables: Tables) -> Tables:
    """A body about its origin on which nothing acts, of mass one and so on."""
    return _in_its_own_units(_in_place(_unturned(_without(tables))), "mass size time")


def _principal(tables: Tables) -> Tables:
    moments = np.linalg.eigvalsh(np.array(tables["body"]["inertia"]))
    return _with(tables, "body", inertia=np.diag(moments).tolist())


def _one_two_three(tables: Tables) -> Tables:
    return _with(tables, "body", inertia=np.diag([1.0, 2.0, 3.0]).tolist())


def _along_one_axis(tables: Tables, table: str, key: str) -> Tables:
    """Its largest component alone."""
    if key not in tables[table]:
        return tables
    vector = np.array(tables[table][key])
    vector[np.abs(vector) < np.max(np.abs(vector))] = 0.0
    return _with(tables, table, **{key: vector.tolist()})


def _torque_along_one_axis(tables: Tables, frame: str) -> Tables:
    torques = [
        _along_one_axis({"torque": one}, "torque", "value")["torque"]
        if one["frame"] == frame
        else one
        for one in tables["load"]["torque"]
    ]
    return _with(tables, "load", torque=torques)


def _shorter(tables: Tables) -> Tables:
    """Half of the run, of whole steps of the longest size."""
    run = tables["run"]
    step = max(run["timesteps"])
    steps = max(1, int(run["duration"] / step / 2))
    duration = min(run["duration"], steps * step * (1.0 + 1e-12))
    return _with(tables, "run", duration=duration, sample=min(run["sample"], duration))


def brief(tables: Tables) -> Tables:
    """One step of the longest size: the gates of the engine itself need no more."""
    step = max(tables["run"]["timesteps"])
    return _with(tables, "run", timesteps=[step], duration=step, sample=step)


def _one_step_size(tables: Tables, number: int) -> Tables:
    steps = tables["run"]["timesteps"]
    return _with(tables, "run", timesteps=[steps[min(number, len(steps) - 1)]])


def _rounded_value(value: Any, digits: int) -> Any:
    if isinstance(value, list):
        return [_rounded_value(item, digits) for item in value]
    return float(f"{value:.{digits}g}") if isinstance(value, float) else value


def _rounded(tables: Tables, digits: int) -> Tables:
    """Numbers of so many digits; steps that are, and a run that is a number of them."""
    run, load = tables["run"], tables["load"]
    step = max(run["timesteps"])
    short = _rounded_value(step, digits)
    count, every = int(run["duration"] / step * (1 + 1e-9)), max(1, round(run["sample"] / step))
    steps = [short * (other / step) for other in run["timesteps"]]
    duration = float(f"{max(1, count) * short:.12g}")
    rounded = {k: _rounded_value(v, digits) for k, v in load.items() if k != "torque"}
    torques = [_rounded_value_of(one, digits) for one in load["torque"]]
    initial = {k: v for k, v in tables["initial"].items() if k != "orientation"}
    return {
        **tables,
        "body": {k: _rounded_value(v, digits) for k, v in tables["body"].items()},
        "initial": {**tables["initial"], **_rounded_value_of(initial, digits)},
        "load": {**rounded, "torque": torques},
        "run": {
            "duration": duration,
            "timesteps": steps,
            "sample": min(float(f"{every * short:.12g}"), duration),
        },
    }


def _rounded_value_of(table: Tables, digits: int) -> Tables:
    return {key: _rounded_value(value, digits) for key, value in table.items()}


def _turned_about(tables: Tables, axis: int) -> Tables:
    """A turn about one axis, of a quaternion of few digits, in the place of any other."""
    if np.count_nonzero(tables["initial"]["orientation"]) <= 2:
        return tables
    return _with(tables, "initial", orientation=[0.6, *(0.8 * np.eye(3)[axis]).tolist()])


SIMPLER: tuple[Simpler, ...] = (
    brief,
    _bare,
    *(partial(_without, loads=(load,)) for load in LOADS),
    *(partial(_without_one_torque, frame=frame) for frame in FRAMES),
    partial(_one_step_size, number=0),
    partial(_one_step_size, number=-1),
    _shorter,
    partial(_in_its_own_units, units="mass size time"),
    *(partial(_in_its_own_units, units=unit) for unit in ("mass", "size", "time")),
    _in_place,
    _unturned,
    *(partial(_turned_about, axis=axis) for axis in range(3)),
    _one_two_three,
    _principal,
    *(partial(_along_one_axis, table=table, key=key) for table, key in VECTORS),
    *(partial(_torque_along_one_axis, frame=frame) for frame in FRAMES),
    *(partial(_rounded, digits=digits) for digits in (1, 2, 3)),
)
"""In the order in which they are tried: what leaves out the most, or makes runs cheap, first."""
