"""The origin of a number: its source, and the command that reproduces it."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

SCENARIO = "--scenario"
# Options that change what a run computes, and must stand in the command that repeats it.
_KEPT = ("--adapter", "--exceptions")


@dataclass(frozen=True)
class Source:
    """The source of a number; None where a field does not apply (a residual has no step)."""

    engine: str
    version: str = ""
    setup: str = "physics"
    integrator: str | None = None
    timestep: float | None = None
    accuracy: float | None = None


@dataclass
class Sources:
    """Every source that the page names, once: tables and charts refer to them by number."""

    versions: Mapping[str, str] = field(default_factory=dict)
    numbers: dict[Source, int] = field(default_factory=dict)

    def number(self, row: Mapping[str, Any]) -> int:
        """The number of the source of a row of metrics, a task, or any such mapping."""
        engine = row["engine"]
        source = Source(
            engine,
            row.get("engine_version") or self.versions.get(engine, ""),
            row.get("setup") or "physics",
            row.get("integrator") or None,
            row.get("timestep"),
            row.get("accuracy"),
        )
        return self.numbers.setdefault(source, len(self.numbers))


def sources_for(engines: Iterable[Mapping[str, Any]]) -> Sources:
    """An empty list of sources with the engines' versions."""
    return Sources({engine["name"]: str(engine.get("version") or "") for engine in engines})


def provenance_payload(
    run: Mapping[str, Any], sources: Sources, anchors: Mapping[str, str]
) -> dict[str, Any]:
    """What the page's script makes its cards from: sources by number, scenarios by address.

    scenarios: each with the argument that requested it, which for a file is its path as given.
    options: those that the run's repetition needs.  steps: those requested instead of the
    scenarios' own.
    """
    texts, options = _arguments([str(text) for text in run.get("command") or ()])
    requested = requested_scenarios(run)
    return {
        "sources": [list(vars(source).values()) for source in sources.numbers],
        "scenarios": {
            anchor: [name, requested.get(name, name)] for name, anchor in anchors.items()
        },
        "requested": texts,
        "seed": run.get("seed"),
        "options": [text for option in options if option[0] in _KEPT for text in option],
        "steps": [value for name, value in options if name == "--timestep"],
        "command": command_of(run),
        "traces": [engine["name"] for engine in run.get("engines", []) if "trace" in engine],
    }


def requested_scenarios(run: Mapping[str, Any]) -> dict[str, str]:
    """The arguments that requested the scenarios, by name; none where they were not all named."""
    texts, _ = _arguments([str(text) for text in run.get("command") or ()])
    names = [entry["name"] for entry in run["scenarios"]]
    return dict(zip(names, texts, strict=True)) if len(texts) == len(names) else {}


def program_of(run: Mapping[str, Any]) -> list[str]:
    """How omegadot was started for a record, as typed: the words before ``run``."""
    command = [str(text) for text in run.get("command") or ()]
    return command[: command.index("run")] if "run" in command else ["omegadot"]


def _arguments(command: Sequence[str]) -> tuple[list[str], list[tuple[str, str]]]:
    """The scenarios after ``run``, with an option or without, and the other options' values.

    As the command takes them: those with an option stand after the others.
    """
    texts: list[str] = []
    options: list[tuple[str, str]] = []
    rest: Iterator[str] = iter(command[command.index("run") + 1 :] if "run" in command else [])
    for text in rest:
        if not text.startswith("--"):
            texts.append(text)
        elif "=" in text:
            name, _, value = text.partition("=")
            options.append((name, value))
        else:  # every option of the command takes a value
            options.append((text, next(rest, "")))
    texts += [value for name, value in options if name == SCENARIO]
    return texts, [option for option in options if option[0] != SCENARIO]


def command_of(run: Mapping[str, Any]) -> str:
    """The command that made the record, as one would type it."""
    return shlex.join(str(text) for text in run.get("command") or ())
