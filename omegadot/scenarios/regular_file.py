"""The bytes of a regular file, or one sentence: whatever the path turns out to be."""

from __future__ import annotations

import stat
from pathlib import Path

from omegadot.scenarios.errors import ScenarioError


def read_bytes(path: Path, file: str, kind: str, largest: int) -> bytes:
    """The content of a file of at most so many bytes.

    file: its name in errors.  kind: what it should be, such as ``TOML``. Raises ScenarioError.
    """
    advice = f"give the path of a {kind} file"
    try:
        status = path.stat()
        # a pipe would be waited for, a device never ends
        regular = stat.S_ISREG(status.st_mode)
        content = _first(path, largest + 1) if regular else b""
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


def _first(path: Path, count: int) -> bytes:
    with path.open("rb") as stream:
        return stream.read(count)
