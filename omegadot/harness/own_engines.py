"""The engines that a name may stand for: those registered, and those of ``omegadot.toml``.

The file stands in the current folder. Its table ``adapters`` names engines of one's own by what
``--adapter`` takes::

    [adapters]
    toy = "toy_engine.py:ToyAdapter"
    rapier = "node rapier_worker.js"
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from omegadot.adapters.command_line import NAME, NAME_RULE
from omegadot.adapters.registry import OURS, PROGRAM, AdapterError, registered
from omegadot.harness.engine_target import GIVE, target_of
from omegadot.harness.usage import UsageError, nearest
from omegadot.scenarios.files import read_toml

FILE = "omegadot.toml"
ADAPTERS = "adapters"
_SHOWN = 60


def nearest_engine(term: str, known: Iterable[str]) -> str:
    """Advice: the nearest engine, and where the name of one's own is looked for."""
    none = "" if os.path.lexists(FILE) else ", which has none"
    return f"{nearest(term, known)}; names of your own stand in {FILE} of the current folder{none}"


def check_own_name(name: str, target: str) -> None:
    """Raise UsageError where an engine of one's own would pass for a built-in one, and where a
    program's name is none.
    """
    command = target.removeprefix(PROGRAM)
    if command != target and not NAME.fullmatch(name):
        raise UsageError(
            f"{command}: its name, {name}, is none; write another before it, as NAME=PROGRAM, of "
            f"{NAME_RULE}."
        )
    same = {own for other, own in OURS.items() if other.casefold() == name.casefold()}
    if not same or target in same:
        return
    program = target.startswith(PROGRAM)
    advice = "write another before it, as NAME=PROGRAM" if program else "rename the class"
    raise UsageError(
        f"{target.removeprefix(PROGRAM)}: its name, {name}, is that of a built-in engine; {advice}."
    )


def known_engines() -> dict[str, str]:
    """Targets by name; no name may stand for two.

    Raises UsageError and ScenarioError where the file is not as it must be, UsageError where an
    entry point has the name of another engine.
    """
    try:
        known = registered()
    except AdapterError as error:
        raise UsageError(str(error)) from None
    if not os.path.lexists(FILE):
        return known
    tables = read_toml(Path(FILE), FILE)
    for key in tables:
        if key != ADAPTERS:
            raise UsageError(f"{FILE}: key {key!r} is unknown; write {ADAPTERS}.")
    found = tables.get(ADAPTERS, {})
    if not isinstance(found, dict):
        raise UsageError(f'{FILE}: {ADAPTERS} is no table; write lines such as toy = "toy.py:Toy".')
    for name, target in found.items():
        where = f"{FILE}: {ADAPTERS}.{name}"
        if not NAME.fullmatch(name):
            raise UsageError(
                f"{FILE}: {ADAPTERS} names an engine {name[:_SHOWN]!r}; give a name of {NAME_RULE}."
            )
        if not isinstance(target, str) or not target.strip():
            shown = "empty" if isinstance(target, str) else f"{target!r}, which is no text"
            raise UsageError(f"{where} is {shown}; {GIVE}.")
        if name.casefold() in {other.casefold() for other in known}:
            raise UsageError(f"{where}: there is an engine of this name; give another.")
        try:
            known[name] = target_of(target)
        except UsageError as error:
            raise UsageError(f"{where}: {error}") from None
    return known
