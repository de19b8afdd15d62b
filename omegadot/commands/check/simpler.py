"""Ways in which a system can be simpler: each makes the tables of a scenario from others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from omegadot.gates.case import Case
from omegadot.scenarios import Scenario

Tables = dict[str, Any]
Simpler = Callable[[Tables], Tables]

ZERO = [0.0, 0.0, 0.0]
IDENTITY = [1.0, 0.0, 0.0, 0.0]
LOADS = ("torque", "gravity", "damping", "pivot", "center_of_mass")
NO_TORQUE: Tables = {"frame": "body", "value": ZERO}
VECTORS = (
    ("initial", "angular_velocity"),
    ("load", "gravity"),
    ("load", "pivot"),
    ("body", "center_of_mass"),
)


def tables_of(case: Case, name: str) -> Tables:
    """A case as tables with every number in them, and this name."""
    body, data = case.system.body, case.scenario.to_dict()
    data["body"] = {
        "mass": float(body.mass),
        "inertia": np.asarray(body.inertia, float).tolist(),
        "center_of_mass": np.asarray(body.center_of_mass, float).tolist(),
        "allow_impossible_inertia": case.scenario.body.allow_impossible_inertia,
    }
    data.pop("source", None)
    data.pop("shows", None)
    return {**data, "name": name, "title": f"Shrunk from {case.name}"}


def _with(tables: Tables, table: str, **values: Any) -> Tables:
    """The tables with other values; None takes a key out."""
    changed = {**tables[table], **values}
    return {**tables, table: {k: v for k, v in changed.items() if v is not None}}


def scaled(tables: Tables, mass: float, size: float, time: float) -> Tables:
    """The same motion in other units: of so many kg, m and s."""
    body, initial, load, run = (tables[key] for key in ("body", "initial", "load", "run"))
    inertia = mass * size**2

    def over(values: Any, unit: float) -> Any:
        return (np.asarray(values) / unit).tolist()

    units = {"gravity": size / time**2, "pivot": size, "damping": inertia / time}
    loads = {key: over(load[key], unit) for key, unit in units.items() if key in load}
    torque = over(load["torque"]["value"], inertia / time**2)
    places = {"position": size, "linear_velocity": size / time, "angular_velocity": 1.0 / time}
    return {
        **tables,
        "body": {
            **body,
            "mass": body["mass"] / mass,
            "inertia": over(body["inertia"], inertia),
            "center_of_mass": over(body["center_of_mass"], size),
        },
        "initial": {
            **initial,
            **{k: over(initial[k], u) for k, u in places.items() if k in initial},
        },
        "load": {**load, **loads, "torque": {**load["torque"], "value": torque}},
        "run": {key: over(run[key], time) for key in ("duration", "timesteps", "sample")},
    }


def _in_its_own_units(tables: Tables, units: str) -> Tables:
    """A mass, a size and a rate of one, or some of the three."""
    body, rate = tables["body"], float(np.linalg.norm(tables["initial"]["angular_velocity"]))
    size = float(np.sqrt(np.trace(body["inertia"]) / body["mass"]))
    time = 1.0 / rate if rate else tables["run"]["duration"]
    own = {"mass": body["mass"], "size": size, "time": time}
    return scaled(tables, **{k: own[k] if k in units else 1.0 for k in own})


def _without(tables: Tables, loads: Sequence[str] = LOADS) -> Tables:
    """Without these loads; an offset centre of mass counts as one."""
    nothing = {"torque": NO_TORQUE, "gravity": ZERO, "damping": 0.0, "pivot": None}
    if "center_of_mass" in loads:
        tables = _with(tables, "body", center_of_mass=ZERO)
    return _with(tables, "load", **{load: nothing[load] for load in loads if load in nothing})


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


def _torque_along_one_axis(tables: Tables) -> Tables:
    torque = {"load": {"value": tables["load"]["torque"]["value"]}}
    value = _along_one_axis(torque, "load", "value")["load"]["value"]
    return _with(tables, "load", torque={**tables["load"]["torque"], "value": value})


def _shorter(tables: Tables) -> Tables:
    """Half of the run, of whole steps of the longest size."""
    run = tables["run"]
    step = max(run["timesteps"])
    steps = max(1, int(run["duration"] / step / 2))
    duration = min(run["duration"], steps * step * (1.0 + 1e-12))
    return _with(tables, "run", duration=duration, sample=min(run["sample"], duration))


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
    value = _rounded_value(load["torque"]["value"], digits)
    initial = {k: v for k, v in tables["initial"].items() if k != "orientation"}
    return {
        **tables,
        "body": {k: _rounded_value(v, digits) for k, v in tables["body"].items()},
        "initial": {**tables["initial"], **_rounded_value_of(initial, digits)},
        "load": {**rounded, "torque": {**load["torque"], "value": value}},
        "run": {
            "duration": duration,
            "timesteps": steps,
            "sample": min(float(f"{every * short:.12g}"), duration),
        },
    }


def _rounded_value_of(table: Tables, digits: int) -> Tables:
    return {key: _rounded_value(value, digits) for key, value in table.items()}


SIMPLER: tuple[Simpler, ...] = (
    _bare,
    *(partial(_without, loads=(load,)) for load in LOADS),
    partial(_one_step_size, number=0),
    partial(_one_step_size, number=-1),
    _shorter,
    partial(_in_its_own_units, units="mass size time"),
    *(partial(_in_its_own_units, units=unit) for unit in ("mass", "size", "time")),
    _in_place,
    _unturned,
    _one_two_three,
    _principal,
    *(partial(_along_one_axis, table=table, key=key) for table, key in VECTORS),
    _torque_along_one_axis,
    *(partial(_rounded, digits=digits) for digits in (1, 2, 3)),
)
"""In the order in which they are tried: what leaves out the most, or makes runs cheap, first."""


def ingredients(found: Scenario) -> tuple[str, ...]:
    """What is left in a system, besides a free body of moments 1, 2, 3 and a mass of one."""
    body, load, start = found.body, found.load, found.initial
    tensor = np.array(body.inertia)
    moments, pull = np.diag(tensor), np.array(load.gravity)
    gravity = "gravity" if pull[2] == -np.linalg.norm(pull) else "gravity that is not along -z"
    named = {
        f"a mass of {body.mass:g} kg": body.mass != 1.0,
        "products of inertia": np.any(tensor != np.diag(moments)),
        f"moments of {', '.join(f'{m:g}' for m in moments)}": moments.tolist() != [1.0, 2.0, 3.0],
        "an offset centre of mass": any(body.center_of_mass or ()),
        "a pivot at the origin": load.pivot is not None and not any(load.pivot),
        "a pivot off the origin": load.pivot is not None and any(load.pivot),
        gravity: any(load.gravity),
        f"a damping of {load.damping:g} N m s/rad": load.damping > 0.0,
        f"a torque in {load.torque.frame} axes": any(load.torque.value),
        "a turned start": list(start.orientation) != IDENTITY,
        "a start at rest": not any(start.angular_velocity),
        "a start of several components of omega": sum(map(bool, start.angular_velocity)) > 1,
        "a moving centre of mass": any(start.linear_velocity),
    }
    return tuple(name for name, holds in named.items() if holds)
