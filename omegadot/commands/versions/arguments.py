"""The releases that the arguments name: versions, ranges, and interpreters of one's own."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from omegadot.commands.versions.release import Span, rising, version_of
from omegadot.harness.usage import UsageError

FEWEST = 2


@dataclass(frozen=True)
class RequestedReleases:
    """The releases to look at, rising, and the interpreters that some of them have already."""

    versions: list[str]
    pythons: dict[str, str]


def requested_releases(
    arguments: Sequence[str], releases: Callable[[Span], Sequence[str]]
) -> RequestedReleases:
    """The releases of ``VERSION``, ``LOW..HIGH`` and ``VERSION=PYTHON`` arguments.

    releases: the published ones, looked up where a range needs them. Raises UsageError.
    """
    versions: list[str] = []
    pythons: dict[str, str] = {}
    for argument in arguments:
        version, own, path = argument.partition("=")
        low, dots, high = version.partition("..")
        for number in filter(None, (low, high) if dots else (version,)):
            if version_of(number) is None:
                raise UsageError(
                    f"{argument}: {number!r} is no version; write 1.2.3 or 1.2.0..1.4.0."
                )
        if own:
            versions.append(_with_python(argument, version, dots, path))
            pythons[version] = path
        elif dots:
            versions += _within(argument, Span(low, high), releases)
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
    return RequestedReleases(found, pythons)


def _with_python(argument: str, version: str, dots: str, path: str) -> str:
    if dots:
        raise UsageError(f"{argument}: a range has no single interpreter; give VERSION=PYTHON.")
    if shutil.which(path) is None:
        raise UsageError(
            f"{argument}: {path or 'nothing'} is no program; give a Python interpreter."
        )
    return version


def _within(argument: str, span: Span, releases: Callable[[Span], Sequence[str]]) -> list[str]:
    low, high = version_of(span.low), version_of(span.high)
    if low is not None and high is not None and low > high:
        raise UsageError(f"{argument}: it ends before it starts; write {span.high}..{span.low}.")
    found = rising(releases(span))
    if not found:
        known = rising(releases(Span("", "")))
        there = f"they go from {known[0]} to {known[-1]}" if known else "there are none"
        raise UsageError(f"{argument}: no release for this Python lies there; {there}.")
    return found
