"""Formulas as text: a factor with its unit, sizes, a vector or matrix, and a divisor."""

from __future__ import annotations

from omegadot.diagnosis.wording.digits import number
from omegadot.reference_impl.system import Array
from omegadot.written import written

WHOLE = 1e-6  # relative: a fitted number is the plain one that is meant


def with_factor(k: float, law: str, what: str, left: Array) -> tuple[str, list[str]]:
    """``-0.3 d omega``, or ``k d omega`` and what k is, where the factor has a unit and is not one.

    left: (3,), the powers of kg, m and s that the factor has.
    """
    unit = unit_text(left)
    above, _, below = law.partition(" / ")
    own = number(float(f"{k:.6g}"))
    plain = abs(abs(k) - 1.0) < WHOLE  # as where a size is left out, or is another
    lead = ("-" if k < 0.0 else "") if plain else "k " if unit else f"{own} "
    above = f"{above} " if above.strip() else ""
    inner = f"({what})" if below and " x " in what else what
    shown = f"{lead}{above}{inner}{f' / {below}' if below else ''}"
    return shown, [f"k = {own} {unit}"] if unit and not plain else []


def unit_text(left: Array) -> str:
    """``kg m^2/s``; "" of a plain number."""
    pairs = [(n, float(p)) for n, p in zip(("kg", "m", "s"), left, strict=True) if p]
    above = " ".join(n if p == 1 else f"{n}^{written(p)}" for n, p in pairs if p > 0)
    below = " ".join(n if p == -1 else f"{n}^{written(-p)}" for n, p in pairs if p < 0)
    if not below:
        return above
    return f"{above or '1'}/{f'({below})' if ' ' in below else below}"
