"""From a file, a built-in's name or a plain dict to a Scenario, or to one sentence."""

from __future__ import annotations

import os
import re
import stat
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from omegadot.scenarios.errors import ScenarioError, describe, printable
from omegadot.scenarios.model import Scenario
from omegadot.scenarios.refusals import nearest, scenario_error

LARGEST_FILE = 1_000_000  # bytes; a scenario is a page of text
MOST_DOTS = 32  # in one key; tomllib's memory grows with the square of their number
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DEEP_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MOST_DOTS}}}")
BUILTIN = Path(__file__).with_name("builtin")


def load_scenario(path: str | os.PathLike[str]) -> Scenario:
    """The scenario in a TOML file.

    Raises ScenarioError when the file cannot be read, is not TOML or is no valid scenario.
    """
    file = printable(os.fspath(path))
    return scenario_of(_parse(_read(Path(path), file), file), file)


def builtin_names() -> tuple[str, ...]:
    """The names of the built-in scenarios, in alphabetical order."""
    return tuple(sorted(file.stem for file in BUILTIN.glob("*.toml")))


def load_builtin(name: str) -> Scenario:
    """A built-in scenario by its name.

    Raises ScenarioError, with the nearest name, when there is none of this name.
    """
    names = builtin_names()
    if name not in names:
        raise ScenarioError(describe(name), None, "not a built-in scenario", _other_name(name))
    return load_scenario(BUILTIN / f"{name}.toml")


def find_scenario(name_or_path: str) -> Scenario:
    """The built-in of this name; failing that, the scenario in the file of this path.

    A word without a slash, a dot or a file of its name is taken for a mistyped built-in.
    Raises ScenarioError.
    """
    if name_or_path in builtin_names():
        return load_builtin(name_or_path)
    if re.search(r"[/\\.]", name_or_path) or os.path.lexists(name_or_path):
        return load_scenario(name_or_path)
    found = "neither a built-in scenario nor a file"
    raise ScenarioError(describe(name_or_path), None, found, _other_name(name_or_path))


def scenario_of(data: Mapping[str, Any], file: str) -> Scenario:
    """The scenario in a dict as `Scenario.to_dict` or a TOML parser gives it.

    `file` is the name to use in errors. Raises ScenarioError.
    """
    try:
        return Scenario.model_validate(data)
    except ValidationError as error:
        raise scenario_error(file, error) from None


def _other_name(name: str) -> str:
    near = nearest(name, list(builtin_names()))
    if near:
        return f"write {near} if that is what you mean"
    return "give one of the built-in names or the path of a TOML file"


def _read(path: Path, file: str) -> str:
    """The text of a regular file of at most LARGEST_FILE bytes; a BOM is dropped."""
    toml = "give the path of a TOML file"
    try:
        status = path.stat()
        mode = status.st_mode
        # a pipe would be waited for, a device never ends
        content = _first_bytes(path) if stat.S_ISREG(mode) else b""
    except FileNotFoundError:
        raise ScenarioError(file, None, "missing", toml) from None
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise ScenarioError(file, None, f"not readable ({reason})", toml) from None
    except ValueError:  # a NUL, or a character that no file name can hold
        raise ScenarioError(file, None, "not a path", toml) from None
    if not stat.S_ISREG(mode):
        found = "a directory" if stat.S_ISDIR(mode) else "not a regular file"
        raise ScenarioError(file, None, found, toml)
    if len(content) > LARGEST_FILE:
        found = f"a file of {max(status.st_size, len(content)):,} bytes"
        advice = f"give a scenario of at most {LARGEST_FILE:,} bytes"
        raise ScenarioError(file, None, found, advice)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        found = f"not UTF-8 text (byte 0x{content[error.start]:02x} in line {line})"
        raise ScenarioError(file, None, found, "save it in UTF-8") from None


def _first_bytes(path: Path) -> bytes:
    with path.open("rb") as stream:
        return stream.read(LARGEST_FILE + 1)


def _parse(text: str, file: str) -> dict[str, Any]:
    try:
        if deep := _DEEP_KEY.search(text):
            line = text.count("\n", 0, deep.start()) + 1
            raise ValueError(f"a key of more than {MOST_DOTS} parts in line {line}")
        return tomllib.loads(text)
    except RecursionError:
        reason = "brackets nested too deep"
    except ValueError as error:  # TOMLDecodeError, or an integer of thousands of digits
        reason = re.split(r"[\n;]", str(error))[0].rstrip(".")
    advice = "mend it there, as toml.io describes the format"
    raise ScenarioError(file, None, f"not valid TOML ({printable(reason)})", advice) from None
