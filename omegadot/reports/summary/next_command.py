"""The command to type next where a gate fails."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Mapping
from typing import Any

from omegadot.reports.summary.provenance import requested_scenarios

API = "api"
CHECK = "omegadot check "
DRAWN = "random-"  # begins the name of a system that was drawn


def next_command(run: Mapping[str, Any], worst: Mapping[str, Any], failing: Collection[str]) -> str:
    """``omegadot check ENGINE``, which shrinks the failure and looks for its cause.

    worst: the row that is worst.  failing: the integrators with a run that fails.  A scenario that
    is not among those that `check` runs by itself is named. Of another setup, which `check` does
    not have, it is the run of the worst row alone; "" where the record does not hold how the engine
    is named, as of a trace.
    """
    engine = next((e for e in run["engines"] if e["name"] == worst["engine"]), None)
    argument = engine.get("argument") if engine else None
    if engine is None or not argument:
        return ""
    given = requested_scenarios(run).get(worst["scenario"], worst["scenario"])
    via = engine.get("via") or API
    ways = [] if via == API else ["--via", via]
    if worst["setup"] not in (None, "physics"):
        return shlex.join(_run(worst, given, argument, engine) + ways)
    names = [own["name"] for own in engine.get("integrators") or ()]
    arguments = [*CHECK.split(), argument]
    if len(failing) == 1 < len(names):
        arguments += ["--integrator", *failing]
    if given != worst["scenario"] or given.startswith(DRAWN):
        arguments += ["--scenario", given]
    return shlex.join(arguments + ways)


def _run(
    worst: Mapping[str, Any], scenario: str, argument: str, engine: Mapping[str, Any]
) -> list[str]:
    """The command that runs the cell of a row alone."""
    own = argument != engine["name"]
    name = worst["engine"] + (f":{worst['integrator']}" if worst["integrator"] else "")
    arguments = ["omegadot", "run", scenario, *(["--adapter", argument] if own else [])]
    arguments += ["--engine", name, "--setup", worst["setup"]]
    step = worst["timestep"]
    return arguments + ([] if step is None else ["--timestep", repr(step)])
