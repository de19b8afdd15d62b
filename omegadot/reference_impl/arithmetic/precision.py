"""The extended type, whose spare digits truth carries: which it is here, into it and out of it.

Long double where it has a 64-bit mantissa at least (Linux and macOS on x86-64, Linux on ARM), and
double-double where it is a double (macOS on ARM, Windows). The environment's ``OMEGADOT_EXTENDED``
set to ``double-double`` forces the second anywhere, so that it can be tried on any machine.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass, replace
from decimal import Decimal
from typing import Any, TypeVar, cast

import numpy as np

from omegadot.reference_impl.arithmetic.double_double import DoubleDouble
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

VARIABLE = "OMEGADOT_EXTENDED"
LONG_DOUBLE, DOUBLE_DOUBLE = "long double", "double-double"
LEAST_EPS = 2.0**-63
"""Of either type at most: what truth is computed to."""
LONG_EPS = float(np.finfo(np.longdouble).eps)

Arrays = TypeVar("Arrays", State, Acceleration, Body, Load, System)


class ExtendedTypeError(ValueError):
    """The environment forces a type that there is not."""


def extended_type() -> str:
    """``"long double"`` or ``"double-double"``.

    Raises ExtendedTypeError where the environment forces another.
    """
    forced = os.environ.get(VARIABLE, "")
    if forced not in ("", DOUBLE_DOUBLE):
        raise ExtendedTypeError(
            f"{VARIABLE} is {forced!r}; set it to {DOUBLE_DOUBLE!r}, or unset it."
        )
    return DOUBLE_DOUBLE if forced or LONG_EPS > LEAST_EPS else LONG_DOUBLE


def to_extended(values: Any) -> Array:
    """Numbers in the extended type. A double-double array stands in for an array."""
    if isinstance(values, DoubleDouble) or extended_type() == DOUBLE_DOUBLE:
        return cast(Array, DoubleDouble.of(values))
    return np.asarray(values, np.longdouble)


def to_double(values: Array) -> Array:
    """Numbers of either extended type, or doubles, rounded once to double."""
    return values.astype(float)


def like(given: Array, values: Array) -> Array:
    """Numbers in the extended type, rounded to the type of the array `given`."""
    return values if isinstance(given, DoubleDouble) else values.astype(np.asarray(given).dtype)


def from_decimals(values: Sequence[Decimal]) -> Array:
    """Decimal numbers in the extended type: exact to a double-double's digits."""
    high = [float(value) for value in values]
    low = [float(value - Decimal(part)) for value, part in zip(values, high, strict=True)]
    return to_extended(high) + to_extended(low)


def extended(value: Arrays) -> Arrays:
    """A system, state or acceleration with its arrays in the extended type."""
    found: Arrays = _converted(value, to_extended)
    return found


def in_doubles(value: Arrays) -> Arrays:
    """A system, state or acceleration with its arrays rounded to double."""
    found: Arrays = _converted(value, to_double)
    return found


def _converted(value: Any, convert: Callable[[Any], Array]) -> Any:
    """The same with each array converted; a missing one stays None."""
    if is_dataclass(value) and not isinstance(value, type):
        arrays = {f.name: _converted(getattr(value, f.name), convert) for f in fields(value)}
        return replace(value, **arrays)
    if isinstance(value, tuple):
        return tuple(_converted(item, convert) for item in value)
    return None if value is None else convert(value)
