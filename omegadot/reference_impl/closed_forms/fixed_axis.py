"""Rotation about an axis that stays: damped and driven spin of a sphere or about a principal axis."""

from __future__ import annotations

from omegadot.reference_impl.closed_forms.problem import Problem
from omegadot.reference_impl.system import State, System


def fixed_axis_of(system: System, initial: State) -> Problem | None:
    return None
