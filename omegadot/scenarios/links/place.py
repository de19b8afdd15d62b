"""Where in a file a value stands, its numbers read, and the sentence when it cannot be read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn
from xml.etree.ElementTree import Element

from omegadot.scenarios.errors import ScenarioError, describe, printable


@dataclass(frozen=True)
class Place:
    """file: as given.  path: such as ``link 'arm' inertial``."""

    file: str
    path: str

    def inner(self, name: str) -> Place:
        """A place within this one."""
        return Place(self.file, f"{self.path} {name}".strip())

    def refuse(self, found: str, advice: str) -> NoReturn:
        """Raise the ScenarioError of this place."""
        raise ScenarioError(self.file, printable(self.path), found, advice)

    def numbers(self, text: str | None, count: int | Sequence[int], what: str) -> list[float]:
        """So many finite numbers, separated by white space; what: their names, for the error."""
        counts = (count,) if isinstance(count, int) else tuple(count)
        if text is None:
            self.refuse("missing", f"give {what}")
        if "${" in text or "$(" in text:
            self.refuse(describe(text.strip()), "expand the file with xacro first")
        try:
            values = [float(term) for term in text.split()]
        except ValueError:
            values = []
        if len(values) not in counts or not all(math.isfinite(v) for v in values):
            self.refuse(describe(text.strip()), f"give {what}")
        return values

    def number(self, text: str | None, what: str) -> float:
        """One finite number."""
        return self.numbers(text, 1, what)[0]

    def attribute(self, element: Element, name: str) -> float:
        """The number in an attribute that must be there."""
        return self.inner(name).number(element.get(name), "a number")

    def only(self, element: Element, name: str) -> Element | None:
        """The one child of this name, or None. Two are refused."""
        found = element.findall(name)
        if len(found) > 1:
            self.inner(name).refuse(f"given {len(found)} times", "give it once")
        return found[0] if found else None
