"""``omegadot.versions``: what changed between releases of one engine."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Literal

from omegadot.adapters.protocol import Setup
from omegadot.commands.progress import Count, Progress, Reporting, reporting
from omegadot.commands.typed import typed
from omegadot.commands.versions.aims import aims_of, check_integrators
from omegadot.commands.versions.bisection import bisect_metric
from omegadot.commands.versions.changes import Portrait
from omegadot.commands.versions.environments import Environments, Space, default_cache
from omegadot.commands.versions.gallery import Gallery
from omegadot.commands.versions.installer import InstallError, installer_named
from omegadot.commands.versions.record import record_of
from omegadot.commands.versions.release import Product, product_of, requested_releases
from omegadot.commands.versions.result import VersionsResult
from omegadot.harness.arguments import Via, check_way, several
from omegadot.harness.engine_target import EngineLike, target_of
from omegadot.harness.usage import UsageError, check_count, check_number, check_setup
from omegadot.reports.record.record import check_no_record
from omegadot.reports.record.whole_file import as_record_error, make_folder, path_of
from omegadot.scenarios import ScenarioLike

MOST_UNASKED = 1e9  # bytes


@typed
def versions(
    engine: str,
    releases: str | Sequence[str],
    *,
    scenarios: ScenarioLike | Sequence[ScenarioLike] | None = None,
    integrators: str | Sequence[str] | None = None,
    timestep: float | None = None,
    bisect: str | None = None,
    cache: str | os.PathLike[str] | None = None,
    offline: bool = False,
    yes: bool = False,
    ask: Callable[[str], bool] | None = None,
    installer: Literal["auto", "uv", "pip"] = "auto",
    setup: Setup = "physics",
    via: Via = "api",
    adapter: EngineLike | None = None,
    package: str | None = None,
    speed: bool = True,
    timeout: float = 60.0,
    jobs: int | None = None,
    out: str | os.PathLike[str] | None = None,
    progress: Reporting = False,
) -> VersionsResult:
    """Find what changed between releases of an engine, each in an environment of its own.

    engine: mujoco, dart (dartpy) or pinocchio (pin).  releases: ``1.2.3``, a range
    ``1.2.0..1.4.0`` of the releases that there are, or ``1.2.3=PYTHON``, an interpreter that has it
    already.  timestep: s, instead of each scenario's middle one.  bisect: the terms of a metric's
    name; the release in which it changed is then found.  cache: where environments are kept.
    offline: use the cache alone.  yes: install more than 1 GB; without it, `ask` is called with the
    question, and nothing more is installed unless it returns True.
    via: how bodies go in, as of `omegadot.run`.
    adapter, package: of an engine of your own.  speed: time the steps too.
    jobs: versions at the same time.  out: a folder for record and page.
    Raises UsageError, ScenarioError and RecordError.
    """
    own = "" if adapter is None else target_of(adapter)
    product = product_of(engine, own, package or "")
    if package and not own:
        raise UsageError("--package: only an engine of your own has one; give --adapter too.")
    check_setup(setup)
    check_way(via)
    check_number("--timeout", timeout, 0.0)
    if jobs is not None:
        check_count("--jobs", jobs, 1)
    _refuse_ignored(offline, installer, bisect, jobs)
    aims = aims_of(several(scenarios, "scenarios"), several(integrators, "integrators"), timestep)
    if out is not None:
        check_no_record(path_of(out), "a page of versions")
        make_folder(path_of(out))
    try:
        fetching = None if offline else installer_named(installer)
    except InstallError as error:
        raise UsageError(f"--installer {installer}: {error}.") from error
    folder = path_of(cache or default_cache())
    with as_record_error(folder):
        folder.is_dir()
    environments = Environments(folder, product, fetching)
    wanted, pythons = requested_releases(
        several(releases),
        environments.releases,
        environments.cached() if offline else None,
    )
    gallery = Gallery(product, aims, environments.place, pythons, setup, timeout, via)
    with reporting(progress) as report:
        named = [version for version in wanted if version not in pythons]
        report(Progress("making the first environment"))
        # The two ends, and one for each halving.
        most = len(named) if bisect is None else 2 + len(named).bit_length()
        space = environments.space_for(named, most)
    if space.size > MOST_UNASKED and not yes:
        _ask(space, product, ask)
    with reporting(progress) as report:
        total = len(wanted) if bisect is None else None
        count = Count(report, "making environments and starting engines", total)

        def seen(portrait: Portrait) -> None:
            count.advance(1, f"{portrait.version} {portrait.outcome}")

        if bisect is not None:
            found = bisect_metric(bisect, gallery, wanted, seen)
            portraits = found.portraits
        else:
            found, cores = None, (os.cpu_count() or 1) if jobs is None else jobs
            portraits = gallery.measure_all(wanted, cores, seen)
            there = dict.fromkeys(name for portrait in portraits for name in portrait.has)
            check_integrators(aims, list(there), product.engine)
            if speed:
                report(Progress("timing, release by release"))
                gallery.time_all(portraits)
    result = VersionsResult(record_of(gallery, portraits, found))
    if out is not None:
        result.save(out)
    return result


def _refuse_ignored(offline: bool, installer: str, bisect: str | None, jobs: int | None) -> None:
    """Raise UsageError for an argument that would be ignored beside another."""
    if offline and installer != "auto":
        raise UsageError(
            f"--installer {installer}: nothing is installed with --offline; leave one of them out."
        )
    if bisect is not None and jobs is not None:
        raise UsageError(
            f"--jobs {jobs}: --bisect measures one version after another; leave one of them out."
        )


def _ask(space: Space, product: Product, ask: Callable[[str], bool] | None) -> None:
    """Raise UsageError unless the installation of so much is allowed."""
    found = (
        f"{space.more} more environments of {product.package} take about {space.size / 1e9:.1f} GB "
        f"({space.first} took {space.size / space.more / 1e6:.0f} MB)"
    )
    if ask is None or not ask(f"{found}. Install them?"):
        raise UsageError(f"{found}; give --yes to install them, or fewer versions.")
