"""Every command with every adverse value in every place: generated from the command line itself."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import adverse_values as values
import typer

from omegadot.commands.cli import app

# What each command is given beside the adverse value: small enough to be run where it is accepted.
SCORE = ("trace.csv", "--scenario", "quick.toml", "--out", "scored")
VERSIONS = ("mujoco", f"1.0={sys.executable}", "--offline", "--cache", "cache", "--no-speed")
BASE: dict[str, tuple[str, ...]] = {
    "run": ("quick.toml", "--engine", "exact", "--out", "out"),
    "engines": (),
    "scenarios": (),
    "schemes": ("--engine", "exact"),
    "check": ("exact", "--scenario", "quick.toml"),
    "faults": ("--engine", "nowhere"),  # one that is accepted would take minutes
    "choose": ("quick.toml", "--engine", "exact", "--attitude", "1deg", "--budget", "0.1"),
    "report": ("record",),
    "score": SCORE,
    "findings": ("record", "--folder", "findings"),
    "fit": ("trace.csv", "--no-bias", "--no-damping"),
    "compare": ("record", "record"),
    "versions": (*VERSIONS, "--scenario", "quick.toml", "--integrator", "nowhere"),
}
# Arguments without a name, by the place that they have in BASE.
PLACES = {"engine": 0, "trace": 0, "first": 0, "second": 1, "scenarios": 0, "runs": 0}
PLACES |= {"records": 0}
PLACES |= {"releases": 1}


@dataclass(frozen=True)
class AdverseCase:
    """A command line, and what is adverse about it. wrong: whether no such path can be used."""

    name: str
    arguments: tuple[str, ...]
    wrong: bool = False


def adverse_cases() -> list[AdverseCase]:
    """One case for each option or argument and each value that its kind may meet."""
    commands: dict[str, Any] = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    return [
        AdverseCase(
            f"{command}:{parameter.opts[0]}:{name}", (command, *arguments), _wrong(parameter, value)
        )
        for command, parsed in commands.items()
        for parameter in parsed.params
        if not getattr(parameter, "is_flag", False)
        for name, value in _values(parameter)
        for arguments in [_with(command, parameter, value)]
    ]


def _wrong(parameter: Any, value: tuple[str, ...]) -> bool:
    """Whether the file or folder can be none, for whatever command."""
    kind = parameter.metavar or "NAME"
    paths = values.FILES | values.FOLDERS
    return kind in paths and (
        value[0] == values.TOO_LONG or (kind in values.FILES and value[0] in values.NO_FILES)
    )


def _with(command: str, parameter: Any, value: tuple[str, ...]) -> tuple[str, ...]:
    base = list(BASE[command])
    option = parameter.opts[0]
    if option.startswith("-"):
        while option in base and not parameter.multiple:
            at = base.index(option)
            del base[at : at + 2]
        return (*base, option, *value)
    if (place := PLACES[parameter.name]) < len(base):
        base[place] = value[0]
    # A name that begins like an option is one, until two dashes end the options.
    return (*base[:place], "--", *value) if value[0].startswith("-") else tuple(base)


def _values(parameter: Any) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Names and values that a parameter of this kind may meet."""
    kind = parameter.metavar or "NAME"
    if kind in values.ROWS:
        count = values.ROWS[kind]
        for name, text in values.NUMBER_VALUES.items():
            yield name, (text,) * count
    elif kind in values.FOLDERS:
        for text in values.FOLDER_VALUES:
            yield text[:20].replace("\0", "null"), (text,)
    else:
        for name, text in _table(kind).items():
            yield name, (text,)


def _table(kind: str) -> dict[str, str]:
    if kind in values.NUMBERS | values.QUANTITIES:
        return values.NUMBER_VALUES
    if kind in values.VECTORS:
        return values.VECTOR_VALUES
    if kind in values.PAIRS:
        return values.PAIR_VALUES
    if kind in values.CODE:
        return values.CODE_VALUES
    if kind in values.FILES:
        return {text[:20]: text for text in values.FILE_VALUES}
    return values.NAME_VALUES
