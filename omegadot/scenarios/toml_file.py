"""A TOML file to a plain dict, or to one sentence: whatever the path turns out to be."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

from omegadot.scenarios.errors import ScenarioError, printable
from omegadot.scenarios.regular_file import read_bytes

LARGEST_FILE = 1_000_000  # bytes; a scenario is a page of text
MOST_DOTS = 32  # in one key; tomllib's memory grows with the square of their number
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DEEP_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MOST_DOTS}}}")


def read_toml(path: Path, file: str) -> dict[str, Any]:
    """The tables of a TOML file. file: its name in errors. Raises ScenarioError."""
    return _parse(_read(path, file), file)


def _read(path: Path, file: str) -> str:
    """The text of a regular file of at most LARGEST_FILE bytes; a BOM is dropped."""
    content = read_bytes(path, file, "TOML", LARGEST_FILE)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        found = f"not UTF-8 text (byte 0x{content[error.start]:02x} in line {line})"
        raise ScenarioError(file, None, found, "save it in UTF-8") from None


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
    advice = "correct it there, as toml.io describes the format"
    raise ScenarioError(file, None, f"not valid TOML ({printable(reason)})", advice) from None
