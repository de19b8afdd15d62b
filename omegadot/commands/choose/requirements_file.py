"""Requirements in a small TOML file, its keys named as the options are."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from omegadot.commands.choose.requirements import known_key
from omegadot.harness.usage import UsageError

LARGEST_FILE = 100_000  # bytes


def read_requirements(path: Path) -> dict[str, Any]:
    """Keys and values of the file, values as written. Raises UsageError, one sentence."""
    if not path.is_file():
        raise UsageError(f"{path}: no such file; give a TOML file of requirements.")
    try:
        with path.open("rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
        if len(content) > LARGEST_FILE:
            raise UsageError(
                f"{path}: larger than {LARGEST_FILE:,} bytes; give requirements alone."
            )
        data = tomllib.loads(content.decode("utf-8-sig"))
    except OSError as error:
        raise UsageError(
            f"{path}: not readable ({error.strerror}); give a readable file."
        ) from None
    except (ValueError, RecursionError) as error:
        if isinstance(error, UsageError):
            raise
        reason = str(error).splitlines()[0].rstrip(".")
        raise UsageError(f"{path}: not valid TOML ({reason}); correct it there.") from None
    found: dict[str, Any] = {}
    for name, value in data.items():
        key = known_key(name, str(path))
        if key in found:
            raise UsageError(f"{path}: {key} is given twice; give it once.")
        found[key] = value
    return found
