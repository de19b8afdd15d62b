"""Sums of products as text, as they are typed: ``2 (q_x q_z - q_w q_y)``."""

from __future__ import annotations

from collections.abc import Mapping

from omegadot.diagnosis.wording.digits import number

Sum = Mapping[str, float]  # factors by product, in the order in which they are written


def sum_text(factors: Sum) -> str:
    """A factor that all share stands in front; "zero" where nothing is left."""
    kept = {product: k for product, k in factors.items() if k != 0.0}
    if not kept:
        return "zero"
    sizes = {abs(k) for k in kept.values()}
    shared = sizes.pop() if len(sizes) == 1 and len(kept) > 1 else 1.0
    if shared == 1.0:
        return _summed(kept)
    return f"{number(shared)} ({_summed({p: k / shared for p, k in kept.items()})})"


def _summed(factors: Sum) -> str:
    text = ""
    for product, k in factors.items():
        sign = "-" if k < 0.0 else "+"
        size = "" if abs(k) == 1.0 and product else number(abs(k))
        one = f"{size} {product}".strip()
        text += f" {sign} {one}" if text else f"{'-' if k < 0.0 else ''}{one}"
    return text
