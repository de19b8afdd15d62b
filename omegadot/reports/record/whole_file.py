"""A text file written whole or not at all, and the folder that it goes to."""

from __future__ import annotations

import contextlib
import os
import secrets
from collections.abc import Iterator
from pathlib import Path

PAGE_MARK = "<title>omegadot"
_BYTES_OF_A_MARK = 4096


def path_of(given: str | os.PathLike[str]) -> Path:
    """The path that a script gives. Raises RecordError for what is none, such as a number."""
    from omegadot.reports.record.schema import RecordError

    if isinstance(given, str | os.PathLike) and "\0" not in os.fspath(given):
        return Path(given)
    shown = repr(given) if isinstance(given, str | float) else f"a {type(given).__name__}"
    raise RecordError(f"{shown}: is no path; give a text or a pathlib.Path.")


@contextlib.contextmanager
def as_record_error(path: Path) -> Iterator[None]:
    """An OSError inside, as of a name that is too long, is a RecordError of one sentence."""
    from omegadot.reports.record.schema import RecordError

    try:
        yield
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise RecordError(f"{path}: cannot be used ({reason}); name another.") from error


def make_folder(folder: Path) -> None:
    """Make the folder before the work begins. Raises RecordError where that cannot be done."""
    from omegadot.reports.record.schema import RecordError

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise RecordError(f"{folder}: cannot be written to ({reason}); give another.") from error
    if not os.access(folder, os.W_OK):
        raise RecordError(f"{folder}: cannot be written to; give another.")


def check_target(target: Path, mark: str) -> None:
    """Raise RecordError unless `target` is absent, or a file that begins with this mark.

    A link, a device or a FIFO is never replaced, nor a file that omegadot did not write: such a
    file has no mark in its first 4 kB.
    """
    from omegadot.reports.record.schema import RecordError

    with as_record_error(target):
        is_folder = target.is_dir()
    if is_folder:
        raise RecordError(f"{target}: is a folder; name a file.")
    if not os.path.lexists(target):
        return
    if target.is_symlink() or not target.is_file():
        raise RecordError(f"{target}: is a link or a device, and is not replaced; name a file.")
    try:
        with target.open("rb") as file:
            start = file.read(_BYTES_OF_A_MARK)
    except OSError as error:
        raise RecordError(f"{target}: cannot be read ({error.strerror}); name another.") from error
    if mark.encode() not in start:
        raise RecordError(
            f"{target}: is no file of this kind that omegadot wrote, and is not replaced; "
            "name another, or remove it."
        )


def write_whole(target: Path, text: str, mark: str) -> Path:
    """Write a text under another name, then give it its own. Raises RecordError, one sentence.

    mark: what files of this kind, and no others, have in their first 4 kB.
    """
    from omegadot.reports.record.schema import RecordError

    check_target(target, mark)
    fresh = target.with_name(f".{target.name}.{secrets.token_hex(6)}")
    try:
        fresh.write_text(text, encoding="utf-8", errors="replace", newline="\n")
        os.replace(fresh, target)
    except OSError as error:
        raise RecordError(f"{target}: cannot be written ({error.strerror}).") from error
    finally:
        with contextlib.suppress(OSError):
            fresh.unlink(missing_ok=True)
    return target
