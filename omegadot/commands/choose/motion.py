"""What is to be simulated: scenarios by name or path, or a body of one's own set in motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from omegadot.adapters.mujoco.body_file import bodies_of_mjcf
from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of, scenarios_of
from omegadot.harness.usage import UsageError
from omegadot.scenarios import Scenario, ScenarioLike, scenario_of
from omegadot.scenarios.links.body_file import body_of_argument
from omegadot.scenarios.model import MOST_SAMPLES, MOST_STEPS
from omegadot.scenarios.tensor import ALLOWED
from omegadot.written import written

STEPS_TO_BEGIN = (500, 1000, 2000)  # a horizon, where no scenario states which steps are usual


@dataclass(frozen=True)
class Motion:
    """The arguments that give what moves and how.

    body: ``FILE#LINK`` or a TOML file.  duration: s, over the scenarios' own.
    allow_impossible_inertia: go on with a body that breaks the triangle inequality.
    """

    scenarios: Sequence[ScenarioLike] = ()
    body: str | None = None
    angular_velocity: Sequence[float] | None = None
    orientation: Sequence[float] | None = None
    duration: float | None = None
    allow_impossible_inertia: bool = False


def cases_of(motion: Motion) -> list[Case]:
    """The cases to choose for. Raises UsageError and ScenarioError."""
    if motion.scenarios:
        chosen = [scenario.to_dict() for scenario in scenarios_of(motion.scenarios)]
    elif motion.body is not None:
        chosen = [_bare(motion)]
    else:
        raise UsageError("nothing to simulate; give a SCENARIO or --body FILE#LINK.")
    return [case_of(_changed(data, motion), ()) for data in chosen]


def _bare(motion: Motion) -> dict[str, Any]:
    """A free body that is thrown, with nothing acting on it."""
    needed = {
        "--angular-velocity X Y Z": motion.angular_velocity,
        "--duration S": motion.duration,
    }
    missing = " and ".join(option for option, given in needed.items() if given is None)
    if missing:
        raise UsageError(f"--body: no scenario defines its motion; give one, or {missing}.")
    return {"schema": 1, "name": "body", "initial": {}, "run": {}}


def _changed(data: dict[str, Any], motion: Motion) -> Scenario:
    """The scenario with the body, the start and the horizon that were given."""
    where = str(data["name"])
    if motion.body is not None:
        where = motion.body
        named = body_of_argument(motion.body, bodies_of_mjcf)
        own = f"{named.name} in {data['name']}" if motion.scenarios else named.name
        kept = {key: value for key, value in data.items() if key not in ("shows", "source")}
        data = {**kept, "body": named.body, "title": own}
        if not motion.scenarios:
            data["name"] = named.kebab
    if motion.allow_impossible_inertia and "part" not in data["body"]:
        data = {**data, "body": {**data["body"], ALLOWED: True}}
    start = {"angular_velocity": motion.angular_velocity, "orientation": motion.orientation}
    given = {key: list(values) for key, values in start.items() if values is not None}
    data = {**data, "initial": {**data["initial"], **given}}
    if motion.duration is not None:
        data = {**data, "run": _run_of(data["run"], motion.duration)}
    return scenario_of(data, where)


def _run_of(run: dict[str, Any], duration: float) -> dict[str, Any]:
    """The run over another horizon, with those of its steps that fit. Raises UsageError."""
    steps = [step for step in run.get("timesteps", ()) if step <= duration]
    steps = steps or [duration / count for count in STEPS_TO_BEGIN]
    fitting = [step for step in steps if duration / step <= MOST_STEPS]
    if not fitting:
        raise _too_long(duration, "steps", max(steps), MOST_STEPS)
    sample = min(run.get("sample", duration / STEPS_TO_BEGIN[0]), duration)
    if duration / max(sample, min(fitting)) > MOST_SAMPLES:
        raise _too_long(duration, "samples", max(sample, min(fitting)), MOST_SAMPLES)
    return {"duration": duration, "timesteps": fitting, "sample": sample}


def _too_long(duration: float, what: str, gap: float, most: int) -> UsageError:
    return UsageError(
        f"--duration {written(duration)} needs {written(duration / gap, 3)} {what} of "
        f"{written(gap)} s; "
        f"the limit is {most:,}."
    )
