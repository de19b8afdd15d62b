"""Numbers, vectors and texts as a scenario file holds them, each checked on its own.

Magnitudes lie between 1e-50 and 1e50 in SI units. That spans the inertia of a hydrogen molecule
(5e-48 kg m^2) and of the Sun (6e46 kg m^2), and keeps every product that the equations form
(``omega x I omega``, its square, the parallel axis) inside a double.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable
from typing import Annotated

from pydantic import BaseModel, ConfigDict, PlainValidator
from pydantic_core import PydanticCustomError

from omegadot.written import written

LARGEST = 1e50
SMALLEST = 1e-50

_MISSING = object()


class Table(BaseModel):
    """A table of a scenario file: frozen, and without keys that it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def refuse(advice: str, *, key: str = "", found: object = _MISSING) -> PydanticCustomError:
    """The error to raise; `key` goes on from the place that is being validated."""
    context: dict[str, object] = {"advice": advice, "key": key}
    if found is not _MISSING:
        context["found"] = found
    return PydanticCustomError("refused", "{advice}", context)


def read_number(value: object, *, key: str = "") -> float:
    """A finite number of at most 1e50; an integer will do, a boolean or a string will not."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise refuse("give a number", key=key, found=value)
    if isinstance(value, float) and not math.isfinite(value):
        raise refuse("give a finite number", key=key, found=value)
    if abs(value) > LARGEST:
        raise refuse(
            f"give a number of at most {written(LARGEST)} in SI units", key=key, found=value
        )
    return float(value)


def read_positive(value: object, *, key: str = "") -> float:
    """A number from 1e-50 to 1e50."""
    number = read_number(value, key=key)
    if number <= 0.0:
        raise refuse("give a number greater than zero", key=key, found=value)
    if number < SMALLEST:
        raise refuse(
            f"give a number of at least {written(SMALLEST)} in SI units", key=key, found=value
        )
    return number


def read_not_negative(value: object, *, key: str = "") -> float:
    """A number from 0 to 1e50."""
    number = read_number(value, key=key)
    if number < 0.0:
        raise refuse("give zero or a number greater than zero", key=key, found=value)
    return number


def _read_each(
    value: object, length: int, what: str, read: Callable[..., float] = read_number
) -> list[float]:
    """A list of so many values; `what` names them in the advice."""
    if not isinstance(value, list | tuple) or len(value) != length:
        raise refuse(f"give {what}", found=value)
    return [read(item, key=f"[{i}]") for i, item in enumerate(value)]


def read_vector(value: object) -> tuple[float, float, float]:
    """Three numbers, x y z."""
    x, y, z = _read_each(value, 3, "a list of three numbers")
    return x, y, z


def read_lengths(value: object) -> tuple[float, float, float]:
    """Three positive numbers, along x y z."""
    x, y, z = _read_each(value, 3, "a list of three lengths in m", read_positive)
    return x, y, z


def read_quaternion(value: object) -> tuple[float, float, float, float]:
    """Any quaternion but zero, w x y z; it is divided by its norm.

    One that is unit to rounding is left as it is, so that reading twice changes nothing.
    """
    w, x, y, z = _read_each(value, 4, "a quaternion as four numbers w, x, y, z")
    if not any((w, x, y, z)):
        raise refuse("give a quaternion other than zero, such as [1, 0, 0, 0]", found=value)
    # the norm of a quotient by its own norm: half an ulp a component, one each for the two norms
    if abs(math.hypot(w, x, y, z) - 1.0) <= 4.0 * sys.float_info.epsilon:
        return w, x, y, z
    _, exponent = math.frexp(max(abs(w), abs(x), abs(y), abs(z)))
    # by a power of two, so without rounding: the smallest doubles have too few digits for a norm
    w, x, y, z = (math.ldexp(component, -exponent) for component in (w, x, y, z))
    norm = math.hypot(w, x, y, z)
    return w / norm, x / norm, y / norm, z / norm


def read_text(value: object) -> str:
    """A text of one line, at most 1000 characters, without control characters.

    White space, line ends of a multi-line string included, becomes single spaces. A text is shown
    in terminals and pages, so characters that steer a terminal are refused; markup is plain text.
    """
    if not isinstance(value, str):
        raise refuse("give a text in quotes", found=value)
    text = " ".join(value.split())
    if not text or len(text) > 1000 or not text.isprintable():
        raise refuse("give a text of 1 to 1000 printable characters", found=value)
    return text


def read_name(value: object) -> str:
    """A kebab-case name of at most 64 characters."""
    if not isinstance(value, str) or not re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", value):
        raise refuse(
            "give a name of lower-case letters, digits and single hyphens, such as 't-handle'",
            found=value,
        )
    if len(value) > 64:
        raise refuse("give a name of at most 64 characters", found=value)
    return value


Positive = Annotated[float, PlainValidator(read_positive)]
NotNegative = Annotated[float, PlainValidator(read_not_negative)]
Vector = Annotated[tuple[float, float, float], PlainValidator(read_vector)]
Lengths = Annotated[tuple[float, float, float], PlainValidator(read_lengths)]
Quaternion = Annotated[tuple[float, float, float, float], PlainValidator(read_quaternion)]
Text = Annotated[str, PlainValidator(read_text)]
Name = Annotated[str, PlainValidator(read_name)]
