"""The verdict on each channel of a trace: within its resolution, explained, or measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.score.measured import Measured
from omegadot.commands.score.steps import Comparison, Declared
from omegadot.gates.measured_run import CHANNELS
from omegadot.gates.measures import INVARIANT_CHANNELS
from omegadot.gates.verdicts import Finding
from omegadot.reference_impl.system import Array

GATES = {c: "invariants" if c in INVARIANT_CHANNELS else "trajectory" for c in CHANNELS}


@dataclass(frozen=True)
class Judgement:
    """A channel judged. verdict: pass, fail or info. kind: as in `Finding`, or ``measured``."""

    kind: str
    verdict: str
    note: str


def _finding(error: Array, bound: Array, own: Comparison | None, channel: str) -> Finding:
    if np.all(error <= bound):
        return Finding("round-off", "within digits and rounding")
    if own is not None:
        left, allowed = own.left[channel], own.bound[channel]
        if np.all(left <= allowed):
            return Finding("explained", f"explained by {own.scheme}, to {np.max(left):.1e}")
        return Finding("unexplained", f"not explained by {own.scheme}: {np.max(left):.1e} is left")
    return Finding("beyond", "measured, not judged: no scheme is declared")


def judgement_of(
    measured: Measured, declared: Declared | None, schemes: list[Comparison]
) -> dict[str, Judgement]:
    """Every given channel judged.

    Nothing is green by halves: without a declared scheme a gate passes only where all of its
    channels are within what digits and rounding leave open.
    """
    own = schemes[0] if declared and declared.scheme is not None else None
    agreeing = next((one for one in schemes if one.found.agree), None)
    findings = {
        channel: _finding(error, measured.bound[channel], own or agreeing, channel)
        for channel, error in measured.error.items()
    }
    found = {}
    for channel, finding in findings.items():
        verdict, note = finding.verdict, finding.note
        if own is not None and own.own_start and finding.kind == "explained":
            verdict, note = "info", f"{note}, from its own start"
        elif own is None and verdict != "info":
            alike = [f for c, f in findings.items() if GATES[c] == GATES[channel]]
            whole = all(f.kind == "round-off" for f in alike)
            verdict = "pass" if whole else "info"
            if agreeing is not None and finding.kind == "explained":
                note += " (not declared)"
        remark = measured.remarks.get(channel)
        found[channel] = Judgement(finding.kind, verdict, f"{note}; {remark}" if remark else note)
    return found
