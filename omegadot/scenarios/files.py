"""Files from anybody: the bytes of a regular one, the tables of a TOML one, or one sentence."""

from __future__ import annotations

import re
import stat
import tomllib
from pathlib import Path
from typing import Any

from omegadot.scenarios.errors import ScenarioError, printable

LARGEST_FILE = 1_000_000  # bytes; a scenario is a page of text
MOST_DOTS = 32  # in one key; tomllib's memory grows with the square of their number
_PART = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_DEEP_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MOST_DOTS}}}")


def read_bytes(path: Path, file: str, kind: str, largest: int) -> bytes:
    """The content of a file of at most so many bytes.

    file: its name in errors.  kind: what it should be, such as ``TOML``. Raises ScenarioError.
    """
    advice = f"give the path of a {kind} file"
    try:
        status = path.stat()
        # a pipe would be waited for, a device never ends
        regular, content = stat.S_ISREG(status.st_mode), b""
        if regular:
            with path.open("rb") as stream:
                content = stream.read(largest + 1)
    except FileNotFoundError:
        raise ScenarioError(file, None, "missing", advice) from None
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise ScenarioError(file, None, f"not readable ({reason})", advice) from None
    except ValueError:  # a NUL, or a character that no file name can hold
        raise ScenarioError(file, None, "not a path", advice) from None
    if not regular:
        found = "a directory" if stat.S_ISDIR(status.st_mode) else "not a regular file"
        raise ScenarioError(file, None, found, advice)
    if len(content) > largest:
        found = f"a file of {max(status.st_size, len(content)):,} bytes"
        raise ScenarioError(file, None, found, f"give one of at most {largest:,} bytes")
    return content


def read_toml(path: Path, file: str) -> dict[str, Any]:
    """The tables of a TOML file, a BOM dropped. file: its name in errors. Raises ScenarioError."""
    content = read_bytes(path, file, "TOML", LARGEST_FILE)
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise ScenarioError(file, None, "UTF-16 text", "save it in UTF-8")
    try:
        return parse_toml(content.decode("utf-8-sig"), file)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        found = f"not UTF-8 text (byte 0x{content[error.start]:02x} in line {line})"
        raise ScenarioError(file, None, found, "save it in UTF-8") from None


# What tomllib reports where a key has a value, and is a table further down.
_TWICE = re.compile(r"Cannot mutate immutable namespace \((.*?)\)")


def _given_twice(found: re.Match[str]) -> str:
    key = ".".join(re.findall(r"'([^']*)'", found[1]))
    return f"{key} is given as a value and again as a table"


def parse_toml(text: str, file: str) -> dict[str, Any]:
    """The tables of a TOML text. file: its name in errors. Raises ScenarioError."""
    try:
        if deep := _DEEP_KEY.search(text):
            line = text.count("\n", 0, deep.start()) + 1
            raise ValueError(f"a key of more than {MOST_DOTS} parts in line {line}")
        return tomllib.loads(text)
    except RecursionError:
        reason = "brackets nested too deep"
    except ValueError as error:  # TOMLDecodeError, or an integer of thousands of digits
        reason = _TWICE.sub(_given_twice, re.split(r"[\n;]", str(error))[0].rstrip("."))
    advice = "correct it there, as toml.io describes the format"
    raise ScenarioError(file, None, f"not valid TOML ({printable(reason)})", advice) from None
