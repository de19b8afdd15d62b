"""Which systems an engine's process has been loaded with: something of one before may be kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from omegadot.reference_impl.system import System


@dataclass(frozen=True)
class LoadedBefore:
    """The systems loaded before one, the first of them first: so many of a list that may grow."""

    systems: Sequence[System] = ()
    count: int = 0

    @property
    def last(self) -> System | None:
        """The one before it; None where nothing was loaded."""
        return self.systems[self.count - 1] if self.count else None

    def latest_first(self) -> Iterator[System]:
        """All of them, the last one first."""
        return (self.systems[k] for k in range(self.count - 1, -1, -1))


class Loads:
    """What one process has been loaded with so far."""

    def __init__(self) -> None:
        self._systems = list[System]()
        self.before = LoadedBefore()  # the system that is loaded now

    def add(self, system: System) -> None:
        """One more system was loaded."""
        self.before = LoadedBefore(self._systems, len(self._systems))
        self._systems.append(system)
