"""Gate 4, invariants: energy and momenta against their exact trajectory, over three horizons."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.gates.bounds.measures import INVARIANT_CHANNELS
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.reference_impl.system import Array

GATE = "invariants"
HORIZONS = {"drift_quarter": 0.25, "drift_half": 0.5, "drift_full": 1.0}


def rows(
    measured: MeasuredRun,
    findings: dict[str, Finding],
    times: Array,
    channels: Sequence[str] = INVARIANT_CHANNELS,
) -> list[Row]:
    """The largest error up to a quarter, half and the whole of the run, relative, per channel.

    For a free body without load that is the drift of a constant; under load it is the distance
    from the exact trajectory.
    """
    found = []
    for channel in channels:
        finding = findings[channel]
        for metric, part in HORIZONS.items():
            until = times <= part * times[-1]
            value = float(np.max(measured.error[channel][until]))
            bound = float(np.max(measured.round_off[channel][until]))
            # A horizon may stand on its own, within rounding, before a later fault shows.
            alone = value <= bound < np.inf
            verdict = "pass" if alone else finding.verdict
            note = "within round-off" if alone else finding.note
            found.append(Row(GATE, channel, metric, value, "1", bound, verdict, note))
    return found
