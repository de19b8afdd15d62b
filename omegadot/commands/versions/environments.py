"""The environments of releases: made once, kept in a cache, never those of the user.

An environment is a folder of its own, made under a name that no one else uses. It counts from the
moment that a small file that names it is renamed into place: what was broken off is never taken
for whole, and two that make the same one at the same time both get one.
"""

from __future__ import annotations

import json
import platform
import secrets
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from platformdirs import user_cache_path

from omegadot.commands.other_python import worker_command
from omegadot.commands.versions.installer import Installer, InstallError, python_of
from omegadot.commands.versions.release import Product, Span, version_of
from omegadot.harness.usage import UsageError
from omegadot.reports.record.whole_file import write_whole

# What an environment depends on besides its release: this Python and this machine's kind.
_SUFFIX = f"-{sys.implementation.cache_tag}-{sys.platform}-{platform.machine()}.json"


@dataclass(frozen=True)
class Place:
    """Where a release is served: the worker's command, and where its interpreter came from."""

    command: Sequence[str]
    origin: str


@dataclass(frozen=True)
class Absent:
    """Why there is no such place."""

    reason: str


@dataclass(frozen=True)
class Space:
    """What environments will take. first: one that was made.  more: how many more.  size: bytes."""

    first: str
    more: int
    size: int


def default_cache() -> Path:
    """The user's folder for what can be made again, as the platform has it."""
    return user_cache_path("omegadot", appauthor=False, opinion=False) / "versions"


class Environments:
    """The cache, and the installer that fills it; none where nothing may be fetched."""

    def __init__(self, cache: Path, product: Product, installer: Installer | None) -> None:
        self._cache, self._product, self._installer = cache, product, installer

    def cached(self) -> list[str]:
        """The releases of the product whose environments are whole."""
        return [version for version in self._noted() if self._known(version) is not None]

    def _noted(self) -> list[str]:
        start = f"{self._product.package}-"
        names = [file.name for file in self._cache.glob(f"{start}*{_SUFFIX}")]
        return [name.removeprefix(start).removesuffix(_SUFFIX) for name in names]

    def releases(self, span: Span) -> list[str]:
        """Those that there are in a span; without an installer those in the cache.

        Raises UsageError.
        """
        if self._installer is None:
            return span.of(self.cached())
        try:
            return self._installer.releases(self._product.package, span)
        except InstallError as error:
            raise UsageError(
                f"the releases of {self._product.package} cannot be listed "
                f"({self._installer.name}: {error}); name versions instead of a range, "
                "or work from the cache with --offline."
            ) from error

    def space_for(self, versions: Sequence[str], most: int) -> Space:
        """What the environments take that are missing, and at most `most` of them are made.

        The first that can be had is made now, and kept: its size is taken for each of the others.
        """
        missing = [] if self._installer is None else [v for v in versions if not self._known(v)]
        for number, version in enumerate(missing if len(missing) > 1 else []):
            if isinstance(self.place(version), Place):
                left = min(len(missing) - number, most) - 1
                return Space(version, left, left * self._size(version))
        return Space("", 0, 0)

    def _size(self, version: str) -> int:
        python = self._known(version)
        folder = python.parent.parent if python else self._cache
        return sum(file.lstat().st_size for file in folder.rglob("*"))

    def place(self, version: str) -> Place | Absent:
        """A whole environment with this release, made now where there is none yet."""
        python, installer = self._known(version), self._installer
        if python is not None:
            return Place(worker_command(str(python)), "the cache")
        if installer is None:
            return Absent("not in the cache, and nothing may be fetched while offline")
        try:
            return Place(worker_command(str(self._made(version, installer))), installer.name)
        except InstallError as error:
            ours = ".".join(map(str, sys.version_info[:2]))
            return Absent(f"{installer.name}, for Python {ours}: {error}")
        except OSError as error:
            raise UsageError(
                f"--cache {self._cache}: an environment cannot be made there ({error.strerror})."
            ) from error

    def _marker(self, version: str) -> Path:
        """Where it is noted that an environment is whole."""
        return self._cache / f"{self._product.package}-{version}{_SUFFIX}"

    def _known(self, version: str) -> Path | None:
        """The interpreter of a whole environment; None where the Python it leads to is gone.

        That of 4.0 is the one of 4.0.0.
        """
        if not self._marker(version).exists():
            alike = (v for v in self._noted() if version_of(v) == version_of(version))
            version = next(alike, version)
        try:
            reported = json.loads(self._marker(version).read_text(encoding="utf-8"))
            same = reported["requirements"] == self._product.requirements(version)
            python = python_of(self._cache / str(reported["folder"]))
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return python if same and python.exists() else None

    def _made(self, version: str, installer: Installer) -> Path:
        requirements = self._product.requirements(version)
        marker = self._marker(version)
        folder = self._cache / f"{marker.stem}-{secrets.token_hex(4)}"
        self._cache.mkdir(parents=True, exist_ok=True)
        try:
            installer.create(folder)
            installer.install(folder, requirements)
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        text = json.dumps({"folder": folder.name, "requirements": requirements})
        write_whole(marker, text, mark="")  # the cache holds nothing but omegadot's own
        return python_of(folder)
