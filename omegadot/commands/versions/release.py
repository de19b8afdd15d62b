"""Version numbers of releases: their order, and ranges of them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

_NUMBER = re.compile(r"(\d+(?:\.\d+)*)(?:[._-]?(a|b|rc|dev|post)(\d*))?")
_RANKS = {"dev": -4, "a": -3, "b": -2, "rc": -1, "": 0, "post": 1}
Key = tuple[tuple[int, ...], int, int]


def key_of(version: str) -> Key | None:
    """What versions are ordered by; None of what is no version. Zeros at the end do not count."""
    match = _NUMBER.fullmatch(version)
    if match is None:
        return None
    numbers = [int(part) for part in match[1].split(".")]
    while len(numbers) > 1 and numbers[-1] == 0:
        numbers.pop()
    return tuple(numbers), _RANKS[match[2] or ""], int(match[3] or 0)


def rising(versions: Iterable[str]) -> list[str]:
    """Versions in rising order, each once; what is no version is left out."""
    known = {key: version for version in versions if (key := key_of(version)) is not None}
    return [known[key] for key in sorted(known)]


@dataclass(frozen=True)
class Span:
    """Both ends belong to it; an end that is empty is open."""

    low: str
    high: str

    def of(self, versions: Iterable[str]) -> list[str]:
        """Those of the versions that lie in it, without releases made for trial, rising."""
        low, high = key_of(self.low), key_of(self.high)
        found = []
        for version in rising(versions):
            key = key_of(version)
            assert key is not None  # `rising` lets no other pass
            above, below = low is None or key >= low, high is None or key <= high
            if above and below and key[1] >= 0:
                found.append(version)
        return found

    def __str__(self) -> str:
        return f"{self.low}..{self.high}"
