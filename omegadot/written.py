"""How a number is written for people, everywhere: 0.005, 12, 2.8e6, 3.1e-15; never 3e+06, 1e-07."""

from __future__ import annotations

import math
from typing import SupportsFloat

# Powers of ten from which on, and below which, an exponent is written.
_LARGE, _SMALL = 5, -4


def written(value: SupportsFloat | None, digits: int = 6) -> str:
    """A number to so many significant digits, without zeros at its end; – where there is none.

    In plain decimals from 1e-4 on and below 1e5, or as long as no digit is lost, so that 0.21
    stands beside 0.005; else in scientific form.
    """
    if value is None:
        return "–"
    try:
        number = float(value)
    except OverflowError:  # a whole number that no float holds, as a damaged record may have
        return "beyond 1e308"
    if not math.isfinite(number):
        return str(number)
    mantissa, power = f"{number:.{digits - 1}e}".split("e")
    exponent = int(power)
    if float(mantissa) == 0.0:
        return "0"
    if _SMALL <= exponent < max(_LARGE, digits):
        return _trimmed(f"{float(f'{mantissa}e{power}'):.{max(0, digits - 1 - exponent)}f}")
    return f"{_trimmed(mantissa)}e{exponent}"


def exactly(value: float) -> str:
    """A number with as many digits as it takes to read it back."""
    texts = (written(value, digits) for digits in range(1, 18))
    return next((text for text in texts if float(text) == value), str(value))


def _trimmed(decimals: str) -> str:
    return decimals.rstrip("0").rstrip(".") if "." in decimals else decimals
