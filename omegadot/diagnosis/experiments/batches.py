"""In which batches, and at which of their places, states are answered wrongly.

States that show a fault are requested together in other numbers: what the engine answers is then
decided by the size of the batch and the place in it alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import (
    BEYOND_ROUNDING,
    INVERSE,
    Evidence,
    of_forward_dynamics,
    of_inverse_dynamics,
)
from omegadot.diagnosis.experiments.batch_patterns import patterns_of
from omegadot.diagnosis.experiments.observed import Flags
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.gates.case import Case
from omegadot.reference_impl.system import Acceleration

SCREEN = (1, 2, 3, 7, 12)  # sizes by which a fault that every batch has is known
SIZES = (*range(1, 14), 15, 16, 17, 23, 24, 25, 31, 32, 33, 63, 64, 65, 100, 128, 150)
Places = NDArray[np.intp]  # numbers of the states of an evidence
DISTINCT = 12  # states that show the fault, of which batches are made


@dataclass
class Batches:
    """Of a fault in the answers of one scenario. shows: the numbers of the states that show it."""

    requests: Requests
    case: Case
    evidence: Evidence
    shows: Places
    seen: dict[int, Flags] = field(default_factory=dict, init=False)

    def condition(self) -> str:
        """In which batches the states are answered wrongly; "" where in all, or in no known way."""
        whole = len(self.evidence.sound)
        if not len(self.shows) or not all(self._try(n) for n in (*SCREEN, whole)):
            return ""
        if all(np.all(flags) for flags in self.seen.values()):
            return ""
        if not all(self._try(n) for n in SIZES if n < whole) or not self._halved():
            return ""
        found = patterns_of(self.seen)
        return found[0].text if len(found) == 1 else ""

    def _try(self, size: int) -> bool:
        """Whether so many states are answered; which of them wrongly is kept."""
        if size not in self.seen:
            made = together(self.requests, self.case, self.evidence, self._places(size))
            if made is None or not made.finite:
                return False
            shares = made.shares(made.true)
            if np.any((shares > 1.0) & (shares <= BEYOND_ROUNDING)):
                return False
            self.seen[size] = shares > BEYOND_ROUNDING
        return True

    def _places(self, size: int) -> Places:
        few = self.shows[np.unique(np.linspace(0, len(self.shows) - 1, DISTINCT).astype(int))]
        return np.resize(few, size)

    def _halved(self) -> bool:
        """Up to two sizes that follow one another, wherever those between two differ."""
        for low, high in list(_changes(self.seen)):
            while high - low > 1:
                middle = (low + high) // 2
                if not self._try(middle):
                    return False
                same = _kind(self.seen[middle]) == _kind(self.seen[low])
                low, high = (middle, high) if same else (low, middle)
        return True


def together(requests: Requests, case: Case, evidence: Evidence, places: Places) -> Evidence | None:
    """What the engine answers for these states of an evidence alone; None without an answer."""
    states, true = evidence.states[places], evidence.true
    system, eps = evidence.system, evidence.eps
    if evidence.source == INVERSE:
        requested = Acceleration(true.angular[places], true.linear[places])
        answer = requests.request(case, "inverse", states=states, acceleration=requested)
        if not answer.ok or not np.all(np.isfinite(answer.result["torque"])):
            return None
        return of_inverse_dynamics(system, states, requested, answer.result["torque"], eps)
    answer = requests.request(case, "forward", states=states)
    return (
        of_forward_dynamics(system, states, Acceleration(**answer.result), eps)
        if answer.ok
        else None
    )


def _kind(flags: Flags) -> str:
    """Whether all are wrong, none or some: what changes at a size."""
    return "all" if np.all(flags) else "some" if np.any(flags) else "none"


def _changes(seen: Mapping[int, Flags]) -> Iterator[tuple[int, int]]:
    """Neighbouring sizes of which one has a wrong answer more, or less."""
    sizes = sorted(seen)
    for low, high in pairwise(sizes):
        if _kind(seen[low]) != _kind(seen[high]):
            yield low, high
