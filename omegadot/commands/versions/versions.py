"""``omegadot versions``: what changed between releases of one engine."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import typer

from omegadot.commands.versions.aims import Aims, aims_of, check_integrators
from omegadot.commands.versions.arguments import RequestedReleases, requested_releases
from omegadot.commands.versions.bisected import bisect_metric
from omegadot.commands.versions.environments import Environments, default_cache
from omegadot.commands.versions.gallery import Gallery
from omegadot.commands.versions.installer import Installer, InstallError, installer_named
from omegadot.commands.versions.measure import Portrait
from omegadot.commands.versions.product import Product, product_of
from omegadot.commands.versions.record import Record, record_of
from omegadot.harness.usage import UsageError
from omegadot.reports.versions.files import check_folder, write_versions
from omegadot.reports.versions.sheet import sheet_of
from omegadot.reports.versions.text import markdown_of, print_sheet

FEWEST = 2


@dataclass(frozen=True)
class Arguments:
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


def compare_versions(names: Arguments, form: str, out: Path | None) -> int:
    """Look at the versions, print and write what was found, return the exit code.

    Raises UsageError, ScenarioError and RecordError.
    """
    product = product_of(names.engine, names.adapter, names.package)
    if names.package and not names.adapter:
        raise UsageError("--package: only an engine of your own has one; give --adapter too.")
    aims = aims_of(names.scenarios, names.integrators, names.timestep)
    if out is not None:
        check_folder(out)
    environments = Environments(names.cache or default_cache(), product, _installer(names))
    requested = requested_releases(names.releases, environments.releases)
    gallery = Gallery(
        product, aims, environments.place, requested.pythons, names.setup, names.timeout
    )
    record = looked_at(names, product, aims, gallery, requested)
    if out is not None:
        write_versions(record, out)
    if form == "json":
        typer.echo(json.dumps(record, indent=2))
    elif form == "markdown":
        typer.echo(markdown_of(sheet_of(record)), nl=False)
    else:
        print_sheet(sheet_of(record))
    return exit_code(record)


def _installer(names: Arguments) -> Installer | None:
    if names.installer is None:
        return None
    try:
        return installer_named(names.installer)
    except InstallError as error:
        raise UsageError(f"--installer {names.installer}: {error}.") from error


def looked_at(
    names: Arguments, product: Product, aims: Aims, gallery: Gallery, requested: RequestedReleases
) -> Record:
    """The record of what the words request. Raises UsageError."""
    with _progress(len(requested.versions)) as seen:
        if names.bisect is not None:
            portraits, reported = bisect_metric(
                names.bisect, product, gallery, requested.versions, seen
            )
            return record_of(product, aims, names.setup, portraits, reported)
        portraits = gallery.measure_all(requested.versions, names.jobs, seen)
        there = dict.fromkeys(name for portrait in portraits for name in portrait.has)
        check_integrators(aims, list(there), product.engine)
        if names.speed:
            gallery.time_all(portraits)
    return record_of(product, aims, names.setup, portraits, None)


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
    with Console(stderr=True).status("making environments and querying engines") as status:

        def seen(portrait: Portrait) -> None:
            nonlocal done
            done += 1
            status.update(f"{done} of {count}: {portrait.version} {portrait.outcome}")

        yield seen
