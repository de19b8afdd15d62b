"""Version numbers of releases: their order, and ranges of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from packaging.version import InvalidVersion, Version


def version_of(text: str) -> Version | None:
    """What releases are ordered by; None of a text that is no version (PEP 440)."""
    try:
        return Version(text)
    except InvalidVersion:
        return None


def rising(versions: Iterable[str]) -> list[str]:
    """Versions in rising order, each once; what is no version is left out."""
    known = {version: text for text in versions if (version := version_of(text)) is not None}
    return [known[version] for version in sorted(known)]


@dataclass(frozen=True)
class Span:
    """Both ends belong to it; an end that is empty is open."""

    low: str
    high: str

    def of(self, versions: Iterable[str]) -> list[str]:
        """Those of the versions that lie in it, without pre-releases, rising."""
        low, high = version_of(self.low), version_of(self.high)
        return [
            text
            for text in rising(versions)
            if not (version := Version(text)).is_prerelease
            and (low is None or version >= low)
            and (high is None or version <= high)
        ]

    def __str__(self) -> str:
        return f"{self.low}..{self.high}"
