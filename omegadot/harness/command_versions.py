"""``omegadot versions``: what changed between releases of one engine."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import typer

from omegadot.harness.usage_error import UsageError
from omegadot.harness.versions.aims import Aims, aims_of, check_integrators
from omegadot.harness.versions.bisected import bisect_metric
from omegadot.harness.versions.environments import Environments, default_cache
from omegadot.harness.versions.gallery import Gallery
from omegadot.harness.versions.installer import Installer, InstallError, installer_named
from omegadot.harness.versions.measure import Portrait
from omegadot.harness.versions.product import Product, product_of
from omegadot.harness.versions.record import Record, record_of
from omegadot.harness.versions.words import Asked, versions_asked
from omegadot.reports.versions_files import check_folder, write_versions
from omegadot.reports.versions_sheet import sheet_of
from omegadot.reports.versions_text import markdown_of, print_sheet

FEWEST = 2


@dataclass(frozen=True)
class Words:
    """The command line. installer: None where nothing may be fetched.  jobs: side by side."""

    engine: str
    releases: Sequence[str]
    scenarios: Sequence[str] = ()
    integrators: Sequence[str] = ()
    timestep: float | None = None
    bisect: str | None = None
    cache: Path | None = None
    installer: str | None = "auto"
    setup: str = "physics"
    adapter: str = ""
    package: str = ""
    speed: bool = True
    timeout: float = 60.0
    jobs: int = 1


def tell_versions(words: Words, form: str, out: Path | None) -> int:
    """Look at the versions, print and write what was found, return the exit code.

    Raises UsageError, ScenarioError and RecordError.
    """
    product = product_of(words.engine, words.adapter, words.package)
    if words.package and not words.adapter:
        raise UsageError("--package: only an engine of your own has one; give --adapter too.")
    aims = aims_of(words.scenarios, words.integrators, words.timestep)
    if out is not None:
        check_folder(out)
    environments = Environments(words.cache or default_cache(), product, _installer(words))
    asked = versions_asked(words.releases, environments.releases)
    gallery = Gallery(product, aims, environments.place, asked.pythons, words.setup, words.timeout)
    record = looked_at(words, product, aims, gallery, asked)
    if out is not None:
        write_versions(record, out)
    if form == "json":
        typer.echo(json.dumps(record, indent=2))
    elif form == "markdown":
        typer.echo(markdown_of(sheet_of(record)), nl=False)
    else:
        print_sheet(sheet_of(record))
    return exit_code(record)


def _installer(words: Words) -> Installer | None:
    if words.installer is None:
        return None
    try:
        return installer_named(words.installer)
    except InstallError as error:
        raise UsageError(f"--installer {words.installer}: {error}.") from error


def looked_at(words: Words, product: Product, aims: Aims, gallery: Gallery, asked: Asked) -> Record:
    """The record of what the words ask for. Raises UsageError."""
    with _progress(len(asked.versions)) as seen:
        if words.bisect is not None:
            portraits, told = bisect_metric(words.bisect, product, gallery, asked.versions, seen)
            return record_of(product, aims, words.setup, portraits, told)
        portraits = gallery.look_at_all(asked.versions, words.jobs, seen)
        there = dict.fromkeys(name for portrait in portraits for name in portrait.has)
        check_integrators(aims, list(there), product.engine)
        if words.speed:
            gallery.time_all(portraits)
    return record_of(product, aims, words.setup, portraits, None)


def exit_code(record: Record) -> int:
    """0 done, 1 something is not as declared or nothing was found, 3 nothing to compare."""
    known = [version for version in record["versions"] if version["outcome"] == "ok"]
    if len(known) < FEWEST:
        return 3
    unlike = record["bisect"] is None or record["bisect"]["found"]
    return 1 if any(version["faults"] for version in known) or not unlike else 0


@contextmanager
def _progress(count: int) -> Iterator[Callable[[Portrait], object]]:
    """Say on a terminal how far it is, nothing where standard error is piped."""
    if not sys.stderr.isatty():
        yield lambda portrait: None
        return
    from rich.console import Console

    done = 0
    with Console(stderr=True).status("making environments and asking engines") as status:

        def seen(portrait: Portrait) -> None:
            nonlocal done
            done += 1
            status.update(f"{done} of {count}: {portrait.version} {portrait.outcome}")

        yield seen
