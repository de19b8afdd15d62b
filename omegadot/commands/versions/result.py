"""What comes of looking at several releases, for a script: versions, and changes one by one."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from omegadot.commands.versions.release import FEWEST
from omegadot.reports.notebook import framed
from omegadot.reports.record.whole_file import path_of
from omegadot.reports.versions.page import draw_versions, write_versions

Value = float | str | None


@dataclass(frozen=True)
class VersionChange:
    """A metric that changed from one release to another.

    kind: the first part of the metric's name.  integrator: "" where it is about none.
    before, after: a number, a text, or None where a release does not have it.
    """

    from_version: str
    to_version: str
    metric: str
    kind: str
    integrator: str
    before: Value
    after: Value


@dataclass(frozen=True, repr=False)
class VersionsResult:
    """Releases of an engine compared. record: all that was found, as in ``versions.json``."""

    record: dict[str, Any]

    @property
    def known(self) -> tuple[str, ...]:
        """The releases that ran, in rising order."""
        return tuple(v["version"] for v in self.record["versions"] if v["outcome"] == "ok")

    @property
    def missing(self) -> Mapping[str, str]:
        """Why each of the other releases did not run."""
        versions = self.record["versions"]
        return {
            v["version"]: f"{v['outcome']}: {v['reason']}" for v in versions if v["outcome"] != "ok"
        }

    @property
    def changes(self) -> tuple[VersionChange, ...]:
        """What changed from each release to the next; of a bisection, where its metric changed."""
        bisected = self.record["bisect"]
        steps = self.record["steps"] if bisected is None else bisected["found"]
        return tuple(
            VersionChange(
                from_version=step["from"],
                to_version=step["to"],
                metric=change["metric"],
                kind=change["kind"],
                integrator=change["integrator"],
                before=_value(change["before"]),
                after=_value(change["after"]),
            )
            for step in steps
            for change in step["changes"]
        )

    @property
    def faults(self) -> Mapping[str, list[str]]:
        """Where a release is not as its adapter declares."""
        return {v["version"]: v["faults"] for v in self.record["versions"] if v["faults"]}

    @property
    def comparable(self) -> bool:
        """Whether at least two releases ran."""
        return len(self.known) >= FEWEST

    @property
    def passed(self) -> bool:
        """Whether there was something to compare, all is as declared, and a bisection found.

        A release that ran and did not answer some request is not as declared.
        """
        bisected = self.record["bisect"]
        found = bisected is None or bool(bisected["found"])
        ran = [v for v in self.record["versions"] if v["outcome"] == "ok"]
        return self.comparable and found and not any(v["faults"] or v["unanswered"] for v in ran)

    def page(self) -> str:
        """The page: one HTML text that needs no other file."""
        return draw_versions(self.record)

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Write ``versions.json`` and ``versions.html``. Raises RecordError."""
        write_versions(self.record, path_of(folder))
        return Path(folder)

    def __repr__(self) -> str:
        named = f"{len(self.known)} releases of {self.record['engine']}"
        return f"<omegadot versions: {named}, {len(self.changes)} changes>"

    def _repr_html_(self) -> str:
        return framed(self.page(), repr(self).strip("<>"))


def _value(figure: Mapping[str, Any] | None) -> Value:
    if figure is None:
        return None
    value: Value = figure["value"]
    return figure["text"] if value is None else value
