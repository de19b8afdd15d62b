"""What the words of a command ask for: releases, ranges of them, interpreters of one's own."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from omegadot.harness.usage_error import UsageError
from omegadot.harness.versions.release import Span, key_of, rising

FEWEST = 2


@dataclass(frozen=True)
class Asked:
    """The releases to look at, rising, and the interpreters that some of them have already."""

    versions: list[str]
    pythons: dict[str, str]


def versions_asked(words: Sequence[str], releases: Callable[[Span], Sequence[str]]) -> Asked:
    """The releases of ``VERSION``, ``LOW..HIGH`` and ``VERSION=PYTHON`` words.

    releases: asked for those that there are, where a range needs them. Raises UsageError.
    """
    versions: list[str] = []
    pythons: dict[str, str] = {}
    for word in words:
        version, own, path = word.partition("=")
        low, dots, high = version.partition("..")
        for number in filter(None, (low, high) if dots else (version,)):
            if key_of(number) is None:
                raise UsageError(f"{word}: {number!r} is no version; write 1.2.3 or 1.2.0..1.4.0.")
        if own:
            versions.append(_with_python(word, version, dots, path))
            pythons[version] = path
        elif dots:
            versions += _within(word, Span(low, high), releases)
        elif version:
            versions.append(version)
        else:
            raise UsageError("an empty version; write 1.2.3 or 1.2.0..1.4.0.")
    found = rising(versions)
    if len(found) < FEWEST:
        named = f"only {found[0]}" if found else "none"
        raise UsageError(
            f"at least two versions are needed to see a change, and {named} is named; "
            "write two or more, or a range such as 1.2.0..1.4.0."
        )
    return Asked(found, pythons)


def _with_python(word: str, version: str, dots: str, path: str) -> str:
    if dots:
        raise UsageError(f"{word}: a range has no single interpreter; give VERSION=PYTHON.")
    if shutil.which(path) is None:
        raise UsageError(f"{word}: {path or 'nothing'} is no program; give a Python interpreter.")
    return version


def _within(word: str, span: Span, releases: Callable[[Span], Sequence[str]]) -> list[str]:
    low, high = key_of(span.low), key_of(span.high)
    if low is not None and high is not None and low > high:
        raise UsageError(f"{word}: it ends before it starts; write {span.high}..{span.low}.")
    found = rising(releases(span))
    if not found:
        known = rising(releases(Span("", "")))
        there = f"they go from {known[0]} to {known[-1]}" if known else "there are none"
        raise UsageError(f"{word}: no release for this Python lies there; {there}.")
    return found
