"""A finding as it is declared: a table at the head of the script that reproduces it.

The script is the one file of a finding, ``NAME.py`` or ``NAME.js``. Its first lines are TOML in
comments, between ``/// finding`` and ``///``, as packaging metadata stands in Python scripts (PEP
723). All that is measured is in a record, and in what the script prints.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from omegadot.harness.usage import UsageError, nearest
from omegadot.reports.record.schema import SETUPS
from omegadot.scenarios import ScenarioError
from omegadot.scenarios.files import parse_toml, read_bytes

COMMENTS = {".py": "#", ".js": "//"}
LARGEST = 100_000  # bytes of a script; one is a page
KINDS = ("default", "missing term", "frame", "order", "wrong field", "precision limit")
REACHES = {
    "ordinary": "Bodies of ordinary size and speed",
    "extreme": "Bodies that are slow, fast, small or large",
}
_OPENS, _CLOSES = "/// finding", "///"
_OPTIONAL: dict[str, Any] = {"mends": "", "expected": None}


@dataclass(frozen=True)
class Entry:
    """What a finding declares.

    engine, integrator, scenario, setup, timestep: the run that shows it. scenario: a built-in
    name, or the path of a file.  metric: gate, channel and metric of the row that has the figure.
    kind: of `KINDS`.  reach: of `REACHES`, the bodies that it meets.  title, what, why: to read.
    mends: the setting in the engine's own words, "" where there is none.  expected: the order that
    the method should have, of a finding of an order alone.
    """

    script: Path
    engine: str
    integrator: str
    scenario: str
    setup: str
    timestep: float
    metric: str
    kind: str
    reach: str
    title: str
    what: str
    why: str
    link: str
    mends: str
    expected: float | None

    @property
    def name(self) -> str:
        """That of its script."""
        return self.script.stem

    @property
    def scenario_name(self) -> str:
        """As records have it; a file is named after its scenario."""
        return Path(self.scenario).stem

    @property
    def row(self) -> tuple[str, ...]:
        """Gate, channel and metric."""
        return tuple(self.metric.split("/"))


def entries_of(folder: Path) -> tuple[Entry, ...]:
    """Every finding of a folder, by name. Raises UsageError."""
    try:
        scripts = sorted(path for path in folder.iterdir() if path.suffix in COMMENTS)
    except (OSError, ValueError):
        raise UsageError(
            f"--folder {folder}: no such folder; give the one with the scripts of the findings."
        ) from None
    found = [entry for script in scripts if (entry := read_entry(script))]
    if not found:
        raise UsageError(f"--folder {folder}: no script in it declares a finding; name another.")
    return tuple(found)


def read_entry(script: Path) -> Entry | None:
    """The finding that a script declares; None where it begins without one. Raises UsageError."""
    try:
        text = read_bytes(script, str(script), "script", LARGEST).decode()
        head = _head(text, COMMENTS[script.suffix], script)
        return None if head is None else _checked(script, parse_toml(head, str(script)))
    except UnicodeDecodeError:
        raise UsageError(f"{script}: not UTF-8 text; save it in UTF-8.") from None
    except ScenarioError as error:
        raise UsageError(str(error)) from None


def _head(text: str, comment: str, script: Path) -> str | None:
    """The TOML of the first lines."""
    lines = [line.removeprefix(comment).strip() for line in text.splitlines()]
    if not lines or lines[0] != _OPENS:
        return None
    if _CLOSES not in lines:
        raise UsageError(f"{script}: the finding at its head does not end; close it with ///.")
    return "\n".join(lines[1 : lines.index(_CLOSES)])


def _checked(script: Path, table: Mapping[str, Any]) -> Entry:
    """The entry of a table, each key there and of its type."""
    known = [field.name for field in fields(Entry) if field.name != "script"]
    for key in table:
        if key not in known:
            raise UsageError(f"{script}: unknown key {key!r}; {nearest(key, known)}.")
    for key in known:
        number = key in ("timestep", "expected")
        value = {**_OPTIONAL, **table}.get(key)
        absent = key in _OPTIONAL and value in ("", None)
        fits = isinstance(value, float) if number else isinstance(value, str) and value.strip()
        if not absent and not fits:
            kind = "a number with a point" if number else "a text"
            raise UsageError(f"{script}: {key} is {value!r}; give {kind}.")
    for key, choices in (("setup", SETUPS), ("kind", KINDS), ("reach", tuple(REACHES))):
        if table[key] not in choices:
            raise UsageError(f"{script}: {key} is {table[key]!r}; {nearest(table[key], choices)}.")
    if table["metric"].count("/") != 2:
        raise UsageError(f"{script}: metric is {table['metric']!r}; give GATE/CHANNEL/METRIC.")
    return Entry(script=script, **{**_OPTIONAL, **table})
