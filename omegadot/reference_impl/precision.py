"""Systems and states in another floating-point type, so that truth carries spare digits."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import DTypeLike

from omegadot.reference_impl.system import Acceleration, Body, Load, State, System

Arrays = TypeVar("Arrays", State, Acceleration, Body, Load)


def cast(value: Arrays, dtype: DTypeLike) -> Arrays:
    """The same arrays in `dtype`; a missing one stays None."""
    arrays: dict[str, Any] = {f.name: getattr(value, f.name) for f in fields(value)}
    for name, array in arrays.items():
        arrays[name] = None if array is None else np.asarray(array, dtype=dtype)
    return type(value)(**arrays)


def extended(system: System) -> System:
    """The system in long double (64-bit mantissa on x86, double where there is no longer type)."""
    bodies = tuple(cast(body, np.longdouble) for body in system.bodies)
    return System(bodies=bodies, load=cast(system.load, np.longdouble))


def extended_state(state: State) -> State:
    """The state in long double."""
    return cast(state, np.longdouble)
