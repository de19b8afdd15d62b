"""A system as the tables of its scenario: made from a case, in other units, and read again."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.gates.case import Case
from omegadot.scenarios import Scenario
from omegadot.written import written

Tables = dict[str, Any]

ZERO = [0.0, 0.0, 0.0]
IDENTITY = [1.0, 0.0, 0.0, 0.0]
UNUSUAL = 0.7  # decades from one, for a size or a rate to be left as it is
LARGE_TURN = 0.3  # rad


def tables_of(case: Case, name: str) -> Tables:
    """A case as tables with every number in them, and this name; its torques are a list."""
    body, data = case.system.body, case.scenario.to_dict()
    data["body"] = {
        "mass": float(body.mass),
        "inertia": np.asarray(body.inertia, float).tolist(),
        "center_of_mass": np.asarray(body.center_of_mass, float).tolist(),
        "allow_impossible_inertia": case.scenario.body.allow_impossible_inertia,
    }
    torque = data["load"]["torque"]
    data["load"]["torque"] = torque if isinstance(torque, list) else [torque]
    data.pop("source", None)
    data.pop("shows", None)
    return {**data, "name": name, "title": f"Shrunk from {case.name}"}


def scaled(tables: Tables, mass: float, size: float, time: float) -> Tables:
    """The same motion in other units: of so many kg, m and s."""
    body, initial, load, run = (tables[key] for key in ("body", "initial", "load", "run"))
    inertia = mass * size**2

    def over(values: Any, unit: float) -> Any:
        return (np.asarray(values) / unit).tolist()

    units = {"gravity": size / time**2, "pivot": size, "damping": inertia / time}
    loads = {key: over(load[key], unit) for key, unit in units.items() if key in load}
    torques = [{**one, "value": over(one["value"], inertia / time**2)} for one in load["torque"]]
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
        "load": {**load, **loads, "torque": torques},
        "run": {key: over(run[key], time) for key in ("duration", "timesteps", "sample")},
    }


def ingredients(found: Scenario, stepped: bool = False) -> tuple[str, ...]:
    """What is left in a system, besides a free body of moments 1, 2, 3 and a mass of one.

    stepped: a gate of its runs fails, so that their steps belong to it.
    """
    body, load, start = found.body, found.load, found.initial
    tensor = np.array(body.inertia)
    moments, pull = np.diag(tensor), np.array(load.gravity)
    gravity = "gravity" if pull[2] == -np.linalg.norm(pull) else "gravity that is not along -z"
    rate = float(np.linalg.norm(start.angular_velocity))
    longest = max(found.run.timesteps)
    steps = max(1, round(found.run.duration / longest))
    named = {
        f"a mass of {written(body.mass)} kg": body.mass != 1.0,
        "products of inertia": np.any(tensor != np.diag(moments)),
        f"moments of {', '.join(f'{written(m)}' for m in moments)}": moments.tolist()
        != [1.0, 2.0, 3.0],
        "an offset centre of mass": any(body.center_of_mass or ()),
        "a pivot at the origin": load.pivot is not None and not any(load.pivot),
        "a pivot off the origin": load.pivot is not None and any(load.pivot),
        gravity: any(load.gravity),
        f"a damping of {written(load.damping)} N m s/rad": load.damping > 0.0,
        **{f"a torque in {one.frame} axes": any(one.value) for one in load.torque},
        "a turned start": list(start.orientation) != IDENTITY,
        "a start at rest": not any(start.angular_velocity),
        "a start of several components of omega": sum(map(bool, start.angular_velocity)) > 1,
        f"an omega of {written(rate)} rad/s": rate > 0.0 and abs(np.log10(rate)) > UNUSUAL,
        "a moving centre of mass": any(start.linear_velocity),
        f"{steps} steps": stepped and steps > 1,
        f"a turn of {written(longest * rate, 2)} rad a step": stepped
        and longest * rate > LARGE_TURN,
    }
    return tuple(name for name, holds in named.items() if holds)
