"""What the two records were made with, where it differs: versions, machine, seed, scenarios."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.numbers import plain
from omegadot.reports.two_runs.sides import Side, definition_of, of_both

_OF_AN_ENGINE = ("version", "precision", "conventions", "switched_off", "features")
NONE = "–"
_PACKAGE_VERSION, _ENGINE_VERSION = "version of ", " version"

Facts = dict[str, Any]


@dataclass(frozen=True)
class Difference:
    """What differs, and how it stands on either side; – where it is absent."""

    what: str
    was: str
    now: str


def differences(was: Side, now: Side) -> list[Difference]:
    """Everything that differs but the figures, the time and the command itself."""
    found = [
        Difference(what, _text(one.get(what)), _text(other.get(what)))
        for one, other in _facts(was, now)
        for what in dict.fromkeys((*one, *other))
        if one.get(what) != other.get(what)
    ]
    engines = [d for d in found if d.what.endswith(_ENGINE_VERSION)]
    return [d for d in dict.fromkeys(found) if not any(_is_package_of(d, own) for own in engines)]


def _is_package_of(one: Difference, engine: Difference) -> bool:
    """Whether it is the version of an engine's package, such as pin, which the engine shows too."""
    package, name = one.what.removeprefix(_PACKAGE_VERSION), engine.what.split()[0]
    alike = name.startswith(package) or package.startswith(name)
    return alike and one.what != package and (one.was, one.now) == (engine.was, engine.now)


def _text(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_text(entry)}" for key, entry in value.items()) or NONE
    if isinstance(value, list | tuple):
        return ", ".join(map(_text, value)) or NONE
    return NONE if value is None or value == "" else str(value)


def _facts(*sides: Side) -> Iterator[list[Facts]]:
    """Subject by subject, the facts of either side. Only what both records describe is compared."""
    runs = [side.run for side in sides]
    yield [
        {"omegadot": s.run.get("omegadot"), "seed": s.run.get("seed"), "complete": s.complete}
        for s in sides
    ]
    yield [_flat(run.get("machine"), "machine ") for run in runs]
    yield [_flat(run.get("versions"), _PACKAGE_VERSION) for run in runs]
    for name, *entries in of_both(*(run["engines"] for run in runs)):
        if all(entry.get("installed") is not False for entry in entries):
            yield from _of_an_engine(name, entries)
    for name, *entries in of_both(*(run["scenarios"] for run in runs)):
        yield [_flat(definition_of(entry), f"{name} ") for entry in entries]
    then, today = map(_steps_of, sides)
    for name in (name for name in then if name in today):
        # The steps that it was really run with.
        yield [{f"{name} steps in s": steps[name]} for steps in (then, today)]
    if runs[0]["scenarios"] == runs[1]["scenarios"]:
        truths = (summarise(side.record).truths for side in sides)
        yield [_flat(own, "scenarios with a truth by ") for own in truths]


def _of_an_engine(name: str, entries: list[Mapping[str, Any]]) -> Iterator[list[Facts]]:
    """What the engine declares."""
    yield [
        {f"{name} {key.replace('_', ' ')}": entry.get(key) for key in _OF_AN_ENGINE}
        for entry in entries
    ]
    then, today = ({i["name"]: i for i in entry.get("integrators") or ()} for entry in entries)
    for integrator in dict.fromkeys((*then, *today)):
        one, other = then.get(integrator), today.get(integrator)
        if one and other:
            start = f"{name} {integrator}, declared"
            yield [
                {f"{start} {k}": own.get(k) for k in ("scheme", "orders")} for own in (one, other)
            ]
        else:
            yield [{f"{name} integrator {integrator}": own and "there"} for own in (one, other)]


def _flat(table: Any, above: str) -> Facts:
    """Keys as they stand in a scenario's file: load.torque.frame; none where it is no table."""
    found: Facts = {}
    for key, value in table.items() if isinstance(table, Mapping) else ():
        if isinstance(value, Mapping):
            found |= _flat(value, f"{above}{key}.")
        else:
            found[f"{above}{key}"] = value
    return found


def _steps_of(side: Side) -> dict[str, str]:
    found: dict[str, set[float]] = {}
    for task in side.run["tasks"]:
        if task.get("timestep") is not None:
            found.setdefault(task["scenario"], set()).add(task["timestep"])
    return {name: ", ".join(map(plain, sorted(steps))) for name, steps in found.items()}
