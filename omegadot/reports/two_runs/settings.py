"""What the two records were made with, where it differs: versions, machine, seed, scenarios."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.numbers import plain
from omegadot.reports.two_runs.sides import Side, definition_of

_OF_AN_ENGINE = ("version", "precision", "conventions", "switched_off", "features")
NONE = "–"


@dataclass(frozen=True)
class Difference:
    """What differs, and how it stands on either side; – where it is absent."""

    what: str
    was: str
    now: str


def differences(was: Side, now: Side) -> list[Difference]:
    """Everything that differs but the figures, the time and the command itself."""
    found = [
        *_plain("omegadot", was.run.get("omegadot"), now.run.get("omegadot")),
        *_plain("seed", was.run.get("seed"), now.run.get("seed")),
        *_plain("complete", was.complete, now.complete),
        *_each("machine", was.run.get("machine"), now.run.get("machine")),
        *_each("version of", was.run.get("versions"), now.run.get("versions")),
        *_engines(was, now),
        *_scenarios(was, now),
    ]
    return list(dict.fromkeys(found))


def _text(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_text(entry)}" for key, entry in value.items()) or NONE
    if isinstance(value, list | tuple):
        return ", ".join(map(_text, value)) or NONE
    return NONE if value is None or value == "" else str(value)


def _plain(what: str, was: Any, now: Any) -> Iterator[Difference]:
    if was != now:
        yield Difference(what, _text(was), _text(now))


def _each(what: str, was: Any, now: Any) -> Iterator[Difference]:
    then, today = (value if isinstance(value, Mapping) else {} for value in (was, now))
    for key in dict.fromkeys((*then, *today)):
        yield from _plain(f"{what} {key}", then.get(key), today.get(key))


def _engines(was: Side, now: Side) -> Iterator[Difference]:
    """Of the engines that both records describe: what they declare."""
    then = {entry["name"]: entry for entry in was.run["engines"]}
    for entry in now.run["engines"]:
        before = then.get(entry["name"])
        if before is None or before.get("installed") is False or entry.get("installed") is False:
            continue
        for key in _OF_AN_ENGINE:
            name = f"{entry['name']} {key.replace('_', ' ')}"
            yield from _plain(name, before.get(key), entry.get(key))
        yield from _integrators(entry["name"], before, entry)


def _integrators(name: str, was: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[Difference]:
    then = {entry["name"]: entry for entry in was.get("integrators") or ()}
    today = {entry["name"]: entry for entry in now.get("integrators") or ()}
    for key in dict.fromkeys((*then, *today)):
        if key not in then or key not in today:
            there = ("there", NONE) if key in then else (NONE, "there")
            yield Difference(f"{name} integrator {key}", *there)
            continue
        for field in ("scheme", "orders"):
            message = f"{name} {key}, declared {field}"
            yield from _plain(message, then[key].get(field), today[key].get(field))


def _scenarios(was: Side, now: Side) -> Iterator[Difference]:
    then = {entry["name"]: entry for entry in was.run["scenarios"]}
    for entry in now.run["scenarios"]:
        before = then.get(entry["name"])
        if before is None:
            continue
        own = (_flat(definition_of(before)), _flat(definition_of(entry)))
        for key in dict.fromkeys((*own[0], *own[1])):
            yield from _plain(f"{entry['name']} {key}", own[0].get(key), own[1].get(key))
    yield from _steps(was, now)
    truths = [summarise(side.record).truths for side in (was, now)]
    if was.run["scenarios"] == now.run["scenarios"]:
        yield from _each("scenarios with a truth by", *truths)


def _flat(table: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """A definition's keys as they stand in its file: load.torque.frame."""
    found: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            found |= _flat(value, f"{above}{key}.")
        else:
            found[f"{above}{key}"] = value
    return found


def _steps(was: Side, now: Side) -> Iterator[Difference]:
    """The steps that a scenario was really run with."""
    then, today = (_steps_of(side) for side in (was, now))
    for name in then:
        if name in today and then[name] != today[name]:
            texts = (", ".join(map(plain, sorted(steps))) for steps in (then[name], today[name]))
            yield Difference(f"{name} steps in s", *texts)


def _steps_of(side: Side) -> dict[str, set[float]]:
    found: dict[str, set[float]] = {}
    for task in side.run["tasks"]:
        if task.get("timestep") is not None:
            found.setdefault(task["scenario"], set()).add(task["timestep"])
    return found
