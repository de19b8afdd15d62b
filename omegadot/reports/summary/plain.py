"""Which measures say something by themselves."""

from __future__ import annotations

RESIDUAL = "residual"
# Of the states as they are given, at random and along the exact motion.
PLAIN = (RESIDUAL, "residual_on_path")


def is_plain(metric: str) -> bool:
    """Whether a measure says something by itself.

    A residual after another system was loaded, or at one state by itself, does so only where the
    plain one passes.
    """
    return metric in PLAIN or not metric.startswith(RESIDUAL)
