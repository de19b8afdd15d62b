"""A run's record: three files and the page, written whole or not at all."""

from __future__ import annotations

import contextlib
import ctypes
import glob
import json
import os
import re
import secrets
import shutil
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import polars as pl
import psutil

from omegadot.reports.record import schema
from omegadot.reports.record.agreement import check_agreement
from omegadot.reports.record.run_json import dump_json, read_run
from omegadot.reports.record.run_model import check_run
from omegadot.reports.record.schema import Field, RecordError
from omegadot.reports.record.whole_file import as_record_error

RUN, PAGE = "run.json", "report.html"
METRICS, TRAJECTORIES = "metrics.parquet", "trajectories.parquet"
SECONDS_TO_WRITE = 60.0
_LEFT = re.compile(r"\.(\d+)-[0-9a-f]{12}\.(new|old)")
_HERE, _RENAME_EXCHANGE = -100, 2  # AT_FDCWD and the flag, of linux/fcntl.h and linux/fs.h
_REPEATING = ("timestep", "accuracy", "time")
FILES = (RUN, METRICS, TRAJECTORIES, PAGE)


@dataclass(frozen=True)
class Record:
    """run: what ``run.json`` holds.  metrics and trajectories: the contract's two tables."""

    run: dict[str, Any]
    metrics: pl.DataFrame
    trajectories: pl.DataFrame


def check_folder(folder: Path) -> None:
    """Raise RecordError unless a record may be written to `folder`.

    It may be absent, empty, or hold an earlier record and nothing else; no other file is ever
    replaced. Call it before a long run, not after it.
    """
    try:
        here, folder = Path.cwd(), _followed(folder)
    except FileNotFoundError as error:
        raise RecordError(
            "the current folder does not exist any more; change to another."
        ) from error
    if here.is_relative_to(folder):
        raise RecordError(f"{folder}: is the current directory or holds it; name a new folder.")
    with as_record_error(folder):
        _check_place(folder)


def _check_place(folder: Path) -> None:
    """That a record may be written there. Raises RecordError."""
    if outer := next(filter(_is_record, folder.parents), None):
        raise RecordError(
            f"{folder}: lies in the record {outer}, which no run could then replace; "
            "name a folder outside it."
        )
    _try_to_write(folder)
    _recover(folder)
    if not folder.exists():
        return
    if not folder.is_dir():
        raise RecordError(f"{folder}: is a file; name a new folder for the record.")
    if folder.is_mount():
        raise RecordError(f"{folder}: is a mount point; name a new folder in it.")
    names = sorted(entry.name for entry in folder.iterdir())
    foreign = [name for name in names if name not in FILES]
    if foreign:
        what = "another record" if _is_record(folder / foreign[0]) else "no part of a record"
        raise RecordError(f"{folder}: holds {foreign[0]!r}, which is {what}; name a new folder.")
    if names and RUN not in names:
        raise RecordError(f"{folder}: is not empty and holds no {RUN}; name a new folder.")


def check_no_record(folder: Path, what: str) -> None:
    """Raise RecordError where `folder` is a record's, or lies in one: `what` cannot go there."""
    with as_record_error(folder):
        real = Path(os.path.realpath(folder))
        inside = next(filter(_is_record, (real, *real.parents)), None)
    if inside is not None:
        where = "is a record's folder" if inside == real else f"lies in the record {inside}"
        raise RecordError(
            f"{folder}: {where}, which no run could replace with {what} in it; name another folder."
        )


def _followed(folder: Path) -> Path:
    """The folder that it stands for. Raises RecordError for a link that leads to itself."""
    followed = Path(os.path.realpath(folder))
    if os.path.islink(followed):  # False of a name that is too long, which is met as it is written
        raise RecordError(f"{folder}: is a symbolic link to itself; name a new folder.")
    for link in filter(os.path.islink, (folder, *folder.parents)):
        if not os.path.exists(link):  # its folders would be made, wherever it leads
            raise RecordError(f"{link}: is a symbolic link to nothing; name a new folder.")
    return followed


def _is_record(folder: Path) -> bool:
    return all(os.path.isfile(folder / name) for name in (RUN, METRICS))


def _try_to_write(folder: Path) -> None:
    """Make and remove a folder beside this one, as `write_record` will do at the end."""
    trial = _beside(folder)
    try:
        trial.mkdir(parents=True)
        trial.rmdir()
    except OSError as error:
        reason = error.strerror or str(error)
        raise RecordError(f"{folder}: cannot be written ({reason}); name another.") from error


def _beside(folder: Path) -> Path:
    """A hidden folder that no one else has: `_recover` knows by its name whose it was."""
    return folder.with_name(f".{folder.name}.{os.getpid()}-{secrets.token_hex(6)}.new")


def _recover(folder: Path) -> None:
    """Finish what a process left that was killed as it wrote: the earlier record is put back."""
    with contextlib.suppress(OSError):
        for left in folder.parent.glob(f".{glob.escape(folder.name)}.*"):
            found = _LEFT.fullmatch(left.name[len(folder.name) + 1 :])
            # Another machine may share the disk; no record takes so long to write.
            if found is None or psutil.pid_exists(int(found[1])) or _age(left) < SECONDS_TO_WRITE:
                continue
            if found[2] == "old" and not folder.exists():
                os.replace(left, folder)
            else:
                shutil.rmtree(left, ignore_errors=True)


def _age(path: Path) -> float:
    return time.time() - path.stat().st_ctime


def write_record(record: Record, folder: Path, page: str) -> None:
    """Write the record and its page to `folder`, whole or not at all.

    The files go to a hidden folder next to it, which then takes its name; an earlier record is
    replaced only at that moment. Raises RecordError as `check_folder` does, when the tables break
    the contract, and when the disk refuses.
    """
    check_folder(folder)
    folder = _followed(folder)
    text = dump_json(record.run)
    check_run(json.loads(text), RUN)
    metrics = schema.conform(record.metrics, schema.METRICS, METRICS)
    trajectories = schema.conform(record.trajectories, schema.TRAJECTORIES, TRAJECTORIES)
    fresh = _beside(folder)
    try:
        fresh.mkdir(parents=True)
        (fresh / RUN).write_text(text, encoding="utf-8")
        _write_parquet(metrics, schema.METRICS, fresh / METRICS)
        _write_parquet(trajectories, schema.TRAJECTORIES, fresh / TRAJECTORIES)
        (fresh / PAGE).write_text(page, encoding="utf-8", errors="replace", newline="\n")
        _take_the_place_of(folder, fresh)
    except OSError as error:
        reason = error.strerror or str(error)
        raise RecordError(f"{folder}: the record cannot be written ({reason}).") from error
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


def _take_the_place_of(folder: Path, fresh: Path) -> None:
    aside = fresh.with_suffix(".old")
    had_earlier = folder.exists()
    if had_earlier and _exchange(folder, fresh):
        return  # the earlier record is removed under the other name
    # A folder that is not empty cannot be renamed over, so the earlier record is moved away first.
    if had_earlier:
        os.replace(folder, aside)
    try:
        os.replace(fresh, folder)
    except BaseException:
        if had_earlier:
            os.replace(aside, folder)
        raise
    shutil.rmtree(aside, ignore_errors=True)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange two folders at once, so that at no moment there is none; whether it can be done."""
    if sys.platform != "linux":
        return False
    rename = getattr(ctypes.CDLL(None), "renameat2", None)  # glibc has it since 2.28
    names = os.fsencode(one), os.fsencode(other)
    return rename is not None and not rename(_HERE, names[0], _HERE, names[1], _RENAME_EXCHANGE)


def _write_parquet(frame: pl.DataFrame, fields: Mapping[str, Field], path: Path) -> None:
    import pyarrow.parquet as pq  # imported by writers only

    table = frame.to_arrow(compat_level=pl.CompatLevel.oldest()).cast(schema.arrow_schema(fields))
    # Texts and steps repeat and pack well; measured numbers do not, and trying costs time.
    repeating = [n for n, f in fields.items() if f.dtype is pl.String or n in _REPEATING]
    with path.open("wb") as file:  # opened here, as its name may be no UTF-8
        pq.write_table(
            table, file, compression="zstd", compression_level=1, use_dictionary=repeating
        )


def read_record(folder: Path) -> Record:
    """Read a record back. Raises RecordError, one sentence, for whatever is wrong with it."""
    with as_record_error(folder):
        is_folder = folder.is_dir()
    if not is_folder:
        raise RecordError(f"{folder}: no such folder; give the folder of a run.")
    for name in (RUN, METRICS, TRAJECTORIES):
        if not (folder / name).is_file():
            raise RecordError(f"{folder / name}: missing; give the folder of a whole run.")
    run, metrics = read_run(folder / RUN), _read_parquet(folder / METRICS, schema.METRICS)
    check_agreement(run, metrics, str(folder))
    return Record(run, metrics, _read_parquet(folder / TRAJECTORIES, schema.TRAJECTORIES))


def _read_parquet(path: Path, fields: Mapping[str, Field]) -> pl.DataFrame:
    try:
        # Opened here, so that the name is not taken for a pattern of many files.
        with path.open("rb") as file:
            frame = pl.read_parquet(file)
    except (OSError, pl.exceptions.PolarsError, pl.exceptions.PanicException) as error:
        raise RecordError(
            f"{path}: not a readable Parquet file (truncated or damaged); run again."
        ) from error
    return schema.conform(frame, fields, str(path))
