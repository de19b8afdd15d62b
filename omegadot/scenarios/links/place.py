"""Where in a file a value stands, its numbers read, and the sentence when it cannot be read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn
from xml.etree.ElementTree import Element

from omegadot.scenarios.errors import ScenarioError, describe, printable
from omegadot.scenarios.quantities import LARGEST, SMALLEST
from omegadot.written import written

# decimal ASCII, as XML Schema and C++ streams have it: no underscores, no infinity, no nan
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_TERM = re.compile(r"[^ \t\r\n]+")


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

    def numbers(self, text: str | None, count: int, what: str) -> list[float]:
        """So many numbers, separated by white space; what: their names, for the error."""
        if text is None:
            self.refuse("missing", f"give {what}")
        values = numbers_in(text)
        if len(values) != count:
            self.refuse(describe(text.strip()), f"give {what}")
        if max(map(abs, values)) > LARGEST:
            self.refuse(describe(text.strip()), f"give at most {written(LARGEST)} in SI units")
        return values

    def number(self, text: str | None, what: str) -> float:
        """One number."""
        return self.numbers(text, 1, what)[0]

    def positive(self, text: str | None, count: int, what: str) -> list[float]:
        """So many numbers of at least 1e-50."""
        values = self.numbers(text, count, what)
        if min(values) < SMALLEST:
            self.refuse(describe((text or "").strip()), f"give {what}, greater than zero")
        return values

    def attribute(self, element: Element, name: str) -> float:
        """The number in an attribute that must be there."""
        return self.inner(name).number(element.get(name), "a number")

    def only(self, element: Element, name: str) -> Element | None:
        """The one child of this name, or None. Two are refused."""
        found = element.findall(name)
        if len(found) > 1:
            self.inner(name).refuse(f"given {len(found)} times", "give it once")
        return found[0] if found else None

    def text(self, element: Element, name: str) -> str | None:
        """What stands in the one child of this name."""
        child = self.only(element, name)
        return None if child is None else child.text or ""


def numbers_in(text: str) -> list[float]:
    """The numbers in a text; none where a term of it is no number."""
    terms: Sequence[str] = _TERM.findall(text)
    return [float(term) for term in terms] if all(map(_NUMBER.fullmatch, terms)) else []
