"""What a loop over an engine's own API is to `overhead.py`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from omegadot.reference_impl.system import Array


@dataclass(frozen=True)
class Bare:
    """A loop as a user of the engine would write it.

    start: puts the engine in the initial state.  run: steps and logs; alone it is timed.
    omega: the last angular velocity in body axes, (3,) rad/s, so that two loops can be compared.
    """

    name: str
    start: Callable[[], object]
    run: Callable[[], object]
    omega: Callable[[], Array]
