"""Errors of long steps that follow no order: whether they are those of an engine's coordinates.

Three numbers for an attitude are singular somewhere: three angles where the middle one is a quarter
of a turn. Of two such charts one is always an eighth of a turn away from that at least. A longer
step may pass near it, and errs there by more than an order lets it. The motion does not depend on
where the axes of the world point, and neither do limits of omega or of a turn; such an error does.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.gates.bounds.scales import norm
from omegadot.gates.errors.findings import Declared, MeasuredSweep, evidence_of
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.errors.verdicts import Finding, judge
from omegadot.gates.truth import Truth

SURE = np.pi / 4  # rad, by which any step may turn a body in one of two charts
NOTE = (
    "not judged: so long a step errs by where the axes of the world point, as coordinates do near "
    "a singularity"
)


def may_decide(truth: Truth, measured: MeasuredRun, findings: dict[str, Finding]) -> bool:
    """Whether an unknown scheme errs by more than its order explains, at steps of more than SURE.

    Known schemes are stepped in quaternions.
    """
    if measured.against_scheme or all(one.kind != "outlying" for one in findings.values()):
        return False
    rate = float(np.max(norm(truth.at(measured.sweep).angular_velocity)))
    return measured.sweep.timestep * rate > SURE


def in_other_worlds(
    measured: MeasuredRun,
    findings: dict[str, Finding],
    turned: Sequence[MeasuredRun],
    declared: Declared,
    sweep: MeasuredSweep,
) -> dict[str, Finding]:
    """The findings, of which those are not judged that do not hold in a world of other axes.

    turned: the same run in such worlds, turned back.  sweep: all its runs.
    """
    outlying = [channel for channel, one in findings.items() if one.kind == "outlying"]
    for other in turned:
        runs = MeasuredSweep(tuple(other if one is measured else one for one in sweep.runs))
        again = []
        for channel in outlying:
            order = declared.orders[channel]
            evidence = evidence_of(other, runs, channel, order)
            again.append(judge(evidence, declared.scheme, order))
        if all(one.verdict != "fail" for one in again):
            return findings | dict.fromkeys(outlying, Finding("beyond", NOTE))
    return findings
