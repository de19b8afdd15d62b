"""What is made of a command's arguments, typed or passed by a script: engines and cases."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from numbers import Real
from os import PathLike
from typing import Any, Literal, TypeVar, get_args

from omegadot.adapters.protocol import Description, Integrator
from omegadot.adapters.registry import is_absent
from omegadot.gates.case import ACCURACIES, Case, sweep_of
from omegadot.harness.engine_target import EngineLike, is_target, name_of, target_of
from omegadot.harness.own_engines import check_own_name, known_engines, nearest_engine
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.scenarios import Scenario, ScenarioLike, builtin_names, scenario
from omegadot.scenarios.model import MOST_STEPS
from omegadot.written import written

T = TypeVar("T")


def several(given: T | Sequence[T] | None, name: str = "") -> list[T]:
    """One argument, or several in any iterable, as a list; a text, a table or a class is one.

    An array is taken for its plain numbers. None is an empty list, for which a default may stand.
    name: of an argument that has such a default; a list that is empty, as a filter leaves it, is
    no request for the default, and raises UsageError.
    """
    if given is None:
        return []
    plain: Any = given.tolist() if hasattr(given, "tolist") else given
    one = isinstance(plain, str | PathLike | Mapping | type | Scenario)
    found = [plain] if one or not isinstance(plain, Iterable) else list(plain)
    if name and not found:
        raise UsageError(f"{name}: is empty; name at least one, or leave it out for the default.")
    return found


def adapters_named(extra: Sequence[EngineLike]) -> dict[str, str]:
    """Targets by engine name, see `name_of`. Raises UsageError."""
    found: dict[str, str] = {}
    for adapter in extra:
        target = target_of(adapter)
        name = name_of(target)
        check_own_name(name, target)
        if found.setdefault(name, target) != target:
            raise UsageError(
                f"--adapter: two engines are called {name}, {found[name]} and {target}; run them "
                "apart, or give the class of one another name."
            )
    return found


def engine_choices(
    wanted: Sequence[EngineLike], extra: Sequence[EngineLike] = (), option: str = "--engine"
) -> list[EngineChoice]:
    """The engines given, by ``NAME[:INTEGRATOR]`` or by class; without any every one registered,
    but optional ones that are not installed.

    extra: engines of one's own, by class.  option: by which they were given, for errors.  The same
    name may come several times with different integrators. Raises UsageError.
    """
    known = known_engines()
    # A file engine.py stands for engine:Class as well, unless an engine given has that name.
    own = {**known, **adapters_named(extra)}
    names = [e for e in wanted if isinstance(e, str) and not is_target(e, own)]
    added = adapters_named([*extra, *(engine for engine in wanted if engine not in names)])
    known |= added
    if not wanted:
        there = {name: target for name, target in known.items() if not is_absent(name)}
        return [EngineChoice(n, target, required=n in added) for n, target in there.items()]
    picked: dict[str, list[str]] = {}
    for given in names:
        name, _, integrator = given.partition(":")
        if name not in known:
            raise UsageError(f"{option} {given}: no such engine; {nearest_engine(name, known)}.")
        picked.setdefault(name, []).append(integrator)
    picked |= {name: [""] for name in added if name not in picked}
    return [_choice(name, known[name], tuple(dict.fromkeys(i))) for name, i in picked.items()]


def _choice(name: str, target: str, integrators: tuple[str, ...]) -> EngineChoice:
    """An engine requested by its integrators, of which "" stands for all."""
    if "" not in integrators:
        return EngineChoice(name, target, integrators, required=True)
    named = tuple(integrator for integrator in integrators if integrator)
    return EngineChoice(name, target, required=True, named=named)


Via = Literal["api", "urdf", "mjcf"]
API = "api"
WAYS = get_args(Via)


def check_way(via: str) -> None:
    """Raise UsageError unless it is a way by which bodies go in."""
    if via not in WAYS:
        raise UsageError(f"--via {via}: no such way; {nearest(via, WAYS)}.")


def by_ways(choices: Sequence[EngineChoice], ways: Sequence[str]) -> list[EngineChoice]:
    """The engines, each once for every way by which its bodies are to go in; by its API without.

    One that reads a file goes by another name, such as mujoco-via-urdf. The exact solution and the
    reference, which read none, stay as they are where they were not requested by name.
    Raises UsageError.
    """
    for way in ways:
        check_way(way)
    found = []
    for choice in choices:
        ours = choice.name in ("exact", "reference") and not choice.required
        for way in dict.fromkeys(ways or (API,)):
            plain = way == API or ours
            named = choice if plain else replace(choice, name=f"{choice.name}-via-{way}", via=way)
            found.append(named)
    return list(dict.fromkeys(found))


def integrators_chosen(choice: EngineChoice, description: Description) -> tuple[Integrator, ...]:
    """The integrators requested, in the engine's order; all of them when none was named.

    Raises UsageError where one is requested that the engine does not have.
    """
    names = [integrator.name for integrator in description.integrators]
    for wanted in (*choice.integrators, *choice.named):
        if wanted not in names:
            raise UsageError(
                f"{choice.name}:{wanted}: {choice.name} {description.version} has no "
                f"integrator {wanted!r}; {nearest(wanted, names)}."
            )
    return tuple(i for i in description.integrators if i.name in (choice.integrators or names))


def scenarios_of(wanted: Sequence[ScenarioLike]) -> list[Scenario]:
    """The scenarios given, each by name, path, tables or as one; all built-ins without any.

    Raises ScenarioError, and UsageError where two of them have the same name.
    """
    seen: dict[str, Scenario] = {}
    origin: dict[str, ScenarioLike] = {}
    for given in wanted or builtin_names():
        found = scenario(given)
        if seen.get(found.name) == found:  # given twice
            continue
        if found.name in seen:
            raise UsageError(
                f"{_origin(given)}: its name {found.name!r} is that of "
                f"{_origin(origin[found.name])} too; give every scenario of a run a name of its "
                "own."
            )
        seen[found.name], origin[found.name] = found, given
    return list(seen.values())


def _origin(given: ScenarioLike) -> str:
    return str(given) if isinstance(given, str | PathLike) else "a scenario built in code"


def case_of(
    scenario: Scenario, timesteps: Sequence[float], accuracies: Sequence[float] = ()
) -> Case:
    """The scenario made ready, with other time steps and accuracies where some are given.

    Raises UsageError.
    """
    duration, sample = scenario.run.duration, scenario.run.sample
    for step in timesteps:
        if not (isinstance(step, Real) and math.isfinite(step) and step > 0.0):
            shown = written(step) if isinstance(step, Real) else repr(step)
            raise UsageError(f"--timestep {shown}: not a positive number of seconds; give one.")
        if step > duration:
            raise UsageError(
                f"--timestep {written(step)}: longer than the {written(duration)} s of "
                f"{scenario.name}; "
                "give a shorter one."
            )
        if duration / step > MOST_STEPS:
            raise UsageError(
                f"--timestep {written(step)}: {scenario.name} would take "
                f"{written(duration / step, 1)} steps; "
                f"give one of at least {written(duration / MOST_STEPS, 1)} s."
            )
    for one in accuracies:
        if not (isinstance(one, Real) and 0.0 < one < 1.0):
            shown = written(one) if isinstance(one, Real) else repr(one)
            raise UsageError(f"--accuracy {shown}: not a relative tolerance; give one from 0 to 1.")
    steps = tuple(dict.fromkeys(map(float, timesteps))) or scenario.run.timesteps
    sweeps = tuple(sweep_of(duration, step, sample) for step in steps)
    own = tuple(dict.fromkeys(map(float, accuracies))) or scenario.run.accuracies or ACCURACIES
    return Case(scenario, system_of(scenario), initial_state_of(scenario), sweeps, own)
