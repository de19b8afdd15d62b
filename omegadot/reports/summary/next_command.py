"""The command to type next where a gate fails."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Mapping
from typing import Any

from omegadot.reports.summary.provenance import program_of, requested_scenarios

API = "api"
CHECK = "check"
DRAWN = "random-"  # begins the name of a system that was drawn


def next_command(run: Mapping[str, Any], worst: Mapping[str, Any], failing: Collection[str]) -> str:
    """``omegadot check ENGINE``, which shrinks the failure and looks for its cause: as the run was
    started, and to be typed in its folder.

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
    start = [*(engine.get("environment") or ()), *program_of(run)]
    ways = [] if via == API else ["--via", via]
    if worst["setup"] not in (None, "physics"):
        again = _run(worst, given, argument, engine)
        again += ["--seed", str(seed)] if (seed := run.get("seed")) else []
        return shlex.join([*start, "run", *again, *ways])
    names = [own["name"] for own in engine.get("integrators") or ()]
    arguments = [*start, CHECK, argument]
    if len(failing) == 1 < len(names):
        arguments += ["--integrator", *failing]
    if given != worst["scenario"] or given.startswith(DRAWN):
        arguments += ["--scenario", given]
    return shlex.join(arguments + ways)


def is_check(command: str) -> bool:
    """Whether it is ``omegadot check``, and not a run."""
    words = shlex.split(command)
    return CHECK in words and "run" not in words[: words.index(CHECK)]


def _run(
    worst: Mapping[str, Any], scenario: str, argument: str, engine: Mapping[str, Any]
) -> list[str]:
    """What runs the cell of a row alone, after ``omegadot run``."""
    own = argument != engine["name"]
    name = worst["engine"] + (f":{worst['integrator']}" if worst["integrator"] else "")
    arguments = [scenario, *(["--adapter", argument] if own else [])]
    arguments += ["--engine", name, "--setup", worst["setup"]]
    for option, knob in (("--timestep", worst["timestep"]), ("--accuracy", worst.get("accuracy"))):
        arguments += [] if knob is None else [option, repr(knob)]
    return arguments
