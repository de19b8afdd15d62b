"""A believable record made without any engine: stiff to write, quick to build."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import polars as pl

from omegadot.reports.record import schema
from omegadot.reports.record.record import Record

INTEGRATORS = {
    "reference": {"semi-implicit-euler": 1, "lie-rk4": 4},
    "mujoco": {"Euler": 1, "RK4": 4},
    "dart": {"semi-implicit": 1},
}
SCHEMES = {
    "semi-implicit-euler": "semi-implicit-euler",
    "Euler": "semi-implicit-euler",
    "semi-implicit": "semi-implicit-euler",
    "lie-rk4": "lie-rk4",
    "RK4": "lie-rk4",
}
STEPS = (0.02, 0.01, 0.005)
SAMPLES = 40
RATE = np.array([0.0, 0.0, 2.0])


def spinning(times, late=0.0, faster=0.0):
    """A sphere spun about z: its exact motion, or one that is late or too fast."""
    half = 0.5 * (RATE[2] * times * (1.0 + faster) + late)
    n = len(times)
    columns = {name: np.zeros(n) for name in list(schema.TRAJECTORIES)[6:]}
    columns["time"] = times
    columns["qw"], columns["qz"] = np.cos(half), np.sin(half)
    columns["wz"] = np.full(n, RATE[2] * (1.0 + faster))
    columns["az"] = np.full(n, faster)
    return columns


def _rows(scenario, engine, integrator, timestep, columns):
    return pl.DataFrame(
        {
            "scenario": scenario,
            "engine": engine,
            "setup": "physics",
            "integrator": integrator,
            "timestep": timestep,
            "accuracy": None,
            **columns,
        },
        schema_overrides={"timestep": pl.Float64, "accuracy": pl.Float64},
    )


def metric(scenario, engine, integrator, timestep, gate, channel, name, value, **more):
    row = {
        "scenario": scenario,
        "engine": engine,
        "engine_version": "1.0",
        "setup": "physics",
        "integrator": integrator,
        "timestep": timestep,
        "accuracy": None,
        "gate": gate,
        "channel": channel,
        "metric": name,
        "value": value,
        "unit": "1",
        "bound": 1e-13,
        "verdict": "pass",
        "note": "",
    }
    row |= more
    judged = gate in ("invariants", "trajectory") and row["verdict"] == "pass"
    if judged and row["bound"] is not None and row["value"] > row["bound"]:
        row["note"] = row["note"] or "explained by its scheme, to 1e-15"
    return row


def task(scenario, engine, integrator, timestep, **more):
    gates = dict.fromkeys(("model", "equation", "scheme", "invariants", "trajectory"), "pass")
    row = {
        "scenario": scenario,
        "engine": engine,
        "engine_version": "1.0",
        "setup": "physics",
        "integrator": integrator,
        "timestep": timestep,
        "accuracy": None,
        "outcome": "ok",
        "reason": "",
        "gates": {**gates, "cost": "info"},
        "why": "explained by semi-implicit-euler, to 1.7e-11",
    }
    return {**row, **more}


def scenario_entry(name, title="A sphere, spun"):
    return {
        "name": name,
        "title": title,
        "shows": "Omega-dot is zero and stays so.",
        "source": "Euler, 1752; https://example.org/sphere",
        "definition": {
            "schema": 1,
            "name": name,
            "body": {
                "mass": 1.0,
                "inertia": [[0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.4]],
                "allow_impossible_inertia": True,
            },
            "initial": {
                "orientation": [1.0, 0.0, 0.0, 0.0],
                "angular_velocity": [0.0, 0.0, 0.0],
                "position": [0.0, 0.0, 0.0],
                "linear_velocity": [0.0, 0.0, 0.0],
            },
        },
        "system": {
            "mass": 1.0,
            "center_of_mass": [0.0, 0.0, 0.0],
            "inertia": [[0.4, 0, 0], [0, 0.4, 0], [0, 0, 0.4]],
            "gravity": [0.0, 0.0, 0.0],
            "pivot": None,
            "damping": 0.0,
            "torque_body": [0.0, 0.0, 0.0],
            "torque_world": [0.0, 0.0, 0.0],
        },
    }


def engine_entry(name, integrators):
    return {
        "name": name,
        "version": "1.0",
        "installed": True,
        "reason": "",
        "licence": "Apache-2.0",
        "precision": "float64",
        "conventions": ["quaternions are (w, x, y, z)", "angular velocity in the body frame"],
        "switched_off": ["sleeping"],
        "features": ["free", "pivot"],
        "links": ["https://example.org/issue/1"],
        "integrators": [
            {
                "name": integrator,
                "scheme": SCHEMES.get(integrator),
                "orders": {"omega": order, "attitude": order},
                "knob": "timestep",
                "note": "",
            }
            for integrator, order in integrators.items()
        ],
    }


def clusters(scenario, timestep, engines):
    """One cluster a scheme, without the reference."""
    groups = {}
    for engine, integrators in engines.items():
        for integrator in integrators if engine != "reference" else ():
            groups.setdefault(SCHEMES.get(integrator), []).append(f"{engine}:{integrator}")
    return [
        {"scenario": scenario, "timestep": timestep, "scheme": scheme, "members": members}
        for scheme, members in groups.items()
    ]


def build(scenarios=("sphere", "spun-again"), engines=INTEGRATORS, steps=STEPS, samples=SAMPLES):
    """Every scenario on every engine: late by the step to the power of the scheme's order."""
    frames, metrics, tasks = [], [], []
    for place, scenario in enumerate(scenarios):
        clocks = {h: np.arange(samples + 1) * round(4.0 / samples / h) * h for h in steps}
        union = np.unique(np.concatenate(list(clocks.values())))
        frames.append(_rows(scenario, "exact", "closed-form", None, spinning(union)))
        for engine, integrators in engines.items():
            for integrator, order in integrators.items():
                for h in steps:
                    late = (place + 1) * (h**order) * clocks[h] * 0.3
                    off = 1e-3 * h**order * (engine != "dart")
                    columns = spinning(clocks[h], late, off)
                    frames.append(_rows(scenario, engine, integrator, h, columns))
                    scheme = SCHEMES.get(integrator)
                    tasks.append(task(scenario, engine, integrator, h, scheme=scheme))
                    add = [scenario, engine, integrator, h]
                    seen = {"gate": "scheme", "channel": "attitude"}
                    metrics += [
                        metric(*add, "model", "model", "mass", 0.0),
                        metric(*add, "equation", "omega_dot", "residual", 3.1e-15 * (place + 1)),
                        metric(*add, "invariants", "angular_momentum", "drift_full", h**order),
                        metric(*add, **seen, name="match", value=0.02 * h, bound=1.0),
                        metric(
                            *add, **seen, name="observed_order", value=order + 0.01, bound=order
                        ),
                        metric(*add, "trajectory", "attitude", "error_max", late[-1], unit="rad"),
                        metric(*add, "trajectory", "attitude", "unexplained_max", h * 1e-12),
                        metric(
                            *add, "cost", "time", "time_per_step", 2e-6, unit="s", verdict="info"
                        ),
                    ]
    run = {
        "schema": schema.SCHEMA,
        "omegadot": "0.1.0",
        "created": "2024-01-02T03:04:05+00:00",
        "command": ["omegadot", "run", "--out", "a folder"],
        "seed": 7,
        "seconds": 12.5,
        "complete": True,
        "machine": {"processor": "x86_64", "cores": 2},
        "versions": {"python": "3.11.2", "numpy": "2.0.0"},
        "engines": [engine_entry(name, own) for name, own in engines.items()],
        "scenarios": [scenario_entry(name) for name in scenarios],
        "clusters": [entry for s in scenarios for h in steps for entry in clusters(s, h, engines)],
        "tasks": tasks,
    }
    table = pl.DataFrame(metrics, infer_schema_length=None)
    return Record(
        run,
        schema.conform(table, schema.METRICS, "metrics"),
        schema.conform(pl.concat(frames), schema.TRAJECTORIES, "trajectories"),
    )


def with_metrics(record, *rows):
    """The record with these rows of metrics added."""
    added = schema.conform(pl.DataFrame(list(rows)), schema.METRICS, "metrics")
    return replace(record, metrics=pl.concat([record.metrics, added]))
