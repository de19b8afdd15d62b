"""Fitted numbers that are fractions, and formulas that are written with them."""

from __future__ import annotations

from collections.abc import Sequence

from omegadot.diagnosis.wording.digits import number

DENOMINATORS = (1, 2, 3, 4, 5, 6, 8, 12, 24)  # of the formulas in use


def plain(value: float, known_to: float) -> float:
    """The fraction of the least denominator that is as near as the number is known; or itself."""
    for one in DENOMINATORS:
        near = round(value * one) / one
        if abs(value - near) <= known_to:
            return near
    return value


def is_fraction(value: float) -> bool:
    """Whether it is one of these, to rounding."""
    return any(abs(value * one - round(value * one)) <= 1e-12 * one for one in DENOMINATORS)


def fraction(value: float) -> str:
    """``3/2``, or six digits of what is no fraction."""
    for one in DENOMINATORS:
        if abs(value * one - round(value * one)) <= 1e-12 * one:
            return f"{round(value * one)}" + f"/{one}" * (one > 1)
    return number(value)


def summed(factors: Sequence[float], names: Sequence[str]) -> str:
    """``3/2 f_n - 1/2 f_(n-1)``, of those that are not zero."""
    text = ""
    for k, name in zip(factors, names, strict=True):
        if k:
            sign = (" - " if k < 0 else " + ") if text else "-" * (k < 0)
            text += f"{sign}{fraction(abs(k))} {name}" if abs(k) != 1.0 else f"{sign}{name}"
    return text
