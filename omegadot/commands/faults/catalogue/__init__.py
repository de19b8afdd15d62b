"""The faults, a file a kind, and all of them in one place."""

from __future__ import annotations

from omegadot.commands.faults.catalogue import (  # noqa: F401  (importing them enters their faults)
    branches,
    coarse,
    convention,
    equation,
    extremes,
    frames,
    intermittent,
    kept,
    limits,
    load,
    logging,
    model,
    occasional,
    pivots,
    precision,
    reporting,
    samples,
    shortcuts,
    solving,
    start,
    stepping,
    thresholds,
)
from omegadot.commands.faults.fault import FAULTS

KINDS = ("model", "convention", "equation", "stepping", "logging", "state")
ORDERED = sorted(FAULTS.values(), key=lambda one: KINDS.index(one.kind))
"""Every fault, kind by kind."""
