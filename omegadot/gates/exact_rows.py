"""The exact solution through the gates: what must be constant in it is constant."""

from __future__ import annotations

import numpy as np

from omegadot.gates import invariants
from omegadot.gates.case import Case, Sweep
from omegadot.gates.measured_run import MeasuredRun
from omegadot.gates.measures import INVARIANT_CHANNELS
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.gates.verdicts import Finding
from omegadot.reference_impl.system import State


def conserved_channels(case: Case) -> tuple[str, ...]:
    """The invariants that this load leaves constant."""
    load = case.system.load
    turned = np.any(load.torque_body) or np.any(load.torque_world) or float(load.damping) != 0.0
    falls = bool(np.any(load.gravity))
    if turned:
        return () if falls or load.pivot is not None else ("linear_momentum",)
    if load.pivot is not None:
        return ("energy",) if falls else ("energy", "angular_momentum")
    return ("energy", "angular_momentum") if falls else INVARIANT_CHANNELS


def exact_rows(case: Case, truth: Truth) -> list[Row]:
    """Drift of what the load leaves constant, within the rounding of the answer itself."""
    channels = conserved_channels(case)
    times, count = truth.times, len(truth.times)
    still = State(*(np.broadcast_to(v[:1], v.shape) for v in vars(truth.state).values()))
    rounding = truth.yardstick.round_off(0.0, np.zeros(count), np.ones(count))
    drift = {c: truth.yardstick.distance(c, truth.state, still) for c in channels}
    whole = Sweep(float(times[-1]), 1, 1)
    measured = MeasuredRun(whole, drift, rounding)
    findings = {c: Finding("unexplained", "it should be constant") for c in channels}
    return invariants.rows(measured, findings, times, channels)
