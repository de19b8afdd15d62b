"""The exact motion of a system: in closed form where one is known, else by its Taylor series."""

from __future__ import annotations

from omegadot.reference_impl.series import solve_series
from omegadot.reference_impl.system import Array, State, System


def exact_solution(system: System, initial: State, times: Array) -> tuple[str, State]:
    """How it was found ("closed-form" or "series"), and the states at `times`, (n,) s."""
    return "series", solve_series(system, initial, times)
