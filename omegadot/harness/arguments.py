"""Wrong usage, reported in one sentence, and what is made of the arguments."""

from __future__ import annotations

import math
from collections.abc import Sequence

from omegadot.adapters.protocol import Description
from omegadot.adapters.registry import registered
from omegadot.gates.case import Case, sweep_of
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.scenarios import Scenario, builtin_names, find_scenario


def adapters_named(extra: Sequence[str]) -> dict[str, str]:
    """Targets by engine name: the class's, in lower case, without Adapter. Raises UsageError."""
    found = {}
    for target in extra:
        _, separator, name = target.rpartition(":")
        if not separator or not name:
            raise UsageError(
                f"--adapter {target}: no class is named; give FILE.py:Class or module:Class."
            )
        found[name.removesuffix("Adapter").lower()] = target
    return found


def engine_choices(wanted: Sequence[str], extra: Sequence[str] = ()) -> list[EngineChoice]:
    """The engines of ``NAME[:INTEGRATOR]`` arguments; every one registered when there is none.

    The same name may come several times with different integrators. Raises UsageError.
    """
    added = adapters_named(extra)
    known = {**registered(), **added}
    if not wanted:
        chosen = added or known
        return [EngineChoice(name, target) for name, target in {**known, **chosen}.items()]
    picked: dict[str, list[str]] = {}
    for term in wanted:
        name, _, integrator = term.partition(":")
        if name not in known:
            raise UsageError(
                f"--engine {term}: there is no engine {name!r}; {nearest(name, known)}."
            )
        picked.setdefault(name, []).append(integrator)
    picked |= {name: [""] for name in added if name not in picked}
    return [
        EngineChoice(name, known[name], () if "" in names else tuple(dict.fromkeys(names)), True)
        for name, names in picked.items()
    ]


def check_integrators(choice: EngineChoice, description: Description) -> None:
    """Raise UsageError where an integrator is requested that the engine does not have."""
    names = [integrator.name for integrator in description.integrators]
    for wanted in choice.integrators:
        if wanted not in names:
            raise UsageError(
                f"--engine {choice.name}:{wanted}: {choice.name} {description.version} has no "
                f"integrator {wanted!r}; {nearest(wanted, names)}."
            )


def scenarios_of(terms: Sequence[str]) -> list[Scenario]:
    """The scenarios named, each a built-in's name or a path; all built-ins when there is none.

    Raises ScenarioError, and UsageError where two of them have the same name.
    """
    found = [find_scenario(term) for term in terms or builtin_names()]
    seen: dict[str, str] = {}
    for term, scenario in zip(terms or builtin_names(), found, strict=True):
        if scenario.name in seen:
            raise UsageError(
                f"{term}: its name {scenario.name!r} is that of {seen[scenario.name]} too; "
                "give every scenario of a run a name of its own."
            )
        seen[scenario.name] = term
    return found


def case_of(scenario: Scenario, timesteps: Sequence[float]) -> Case:
    """The scenario made ready, with other time steps where some are given. Raises UsageError."""
    duration, sample = scenario.run.duration, scenario.run.sample
    for step in timesteps:
        if not (math.isfinite(step) and step > 0.0):
            raise UsageError(f"--timestep {step:g}: not a positive number of seconds; give one.")
        if step > duration:
            raise UsageError(
                f"--timestep {step:g}: longer than the {duration:g} s of {scenario.name}; "
                "give a shorter one."
            )
    steps = tuple(dict.fromkeys(timesteps)) or scenario.run.timesteps
    sweeps = tuple(sweep_of(duration, step, sample) for step in steps)
    return Case(scenario, system_of(scenario), initial_state_of(scenario), sweeps)
