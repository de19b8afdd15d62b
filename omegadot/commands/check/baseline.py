"""Figures of an engine now, against those that were stored: what left its band.

A band is rounding and nothing else. Two runs of one scheme each lie within the round-off bound R of
its exact trajectory, so that no distance from the truth differs by more than 2 R between them; to
that comes half a unit of the last digit that is stored. Timings are no part of a baseline.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from omegadot.commands.check.baseline_file import (
    DIGITS,
    Baseline,
    Figure,
    Figures,
    RunKey,
    ScenarioFigures,
)
from omegadot.commands.check.result import Subject
from omegadot.gates.case import knobs_of
from omegadot.gates.rows import Row
from omegadot.harness.outcome import EngineCase
from omegadot.reports.text.numbers import short

# Those whose bound is one of rounding. One horizon states what the three do.
OF_A_SCENARIO = {"model", "equation"}
OF_A_RUN = {"error_max", "drift_full"}
SMALL = 1.1  # a factor below it is written as a difference: "1 times less" says nothing


@dataclass(frozen=True)
class Change:
    """A figure that left its band."""

    name: str
    was: Figure
    value: float

    @property
    def factor(self) -> float:
        """How many times as large it is now; NaN where it was, or is, not finite."""
        if not math.isfinite(self.was.value) or not math.isfinite(self.value):
            return math.nan
        return self.value / self.was.value if self.was.value else math.inf

    @property
    def sentence(self) -> str:
        """Which metric, by how much, and what rounding would have allowed."""
        was, now = short(self.was.value, 3), short(self.value, 3)
        allowed = f"rounding allows {short(self.was.band)}"
        return f"{self.name} went from {was} to {now} ({_described(self.factor)}; {allowed})"


def _described(factor: float) -> str:
    if math.isnan(factor):
        return "no number any more, or one now"
    if math.isinf(factor):
        return "it was zero"
    if factor == 0.0:
        return "it vanished"
    if 1.0 / SMALL < factor < SMALL:
        return f"{short(100.0 * abs(factor - 1.0))} % {'more' if factor > 1.0 else 'less'}"
    return f"{short(factor, 3)} times" if factor >= 1.0 else f"{short(1.0 / factor, 3)} times less"


def _figures(rows: Iterable[Row], scheme: str = "") -> Figures:
    """The rows that have a bound of rounding, by name."""
    named = {}
    for row in rows:
        shared = row.gate in OF_A_SCENARIO
        if row.bound is not None and (shared or row.metric in OF_A_RUN):
            gate = f"{row.gate} " if shared else ""
            named[f"{gate}{row.channel} {row.metric}"] = Figure(row.value, 2.0 * row.bound)
    return Figures(named, scheme)


def answered(found: EngineCase) -> bool:
    """Whether an engine answered every request, if only by a refusal."""
    outcomes = {run.outcome for run in found.runs} - {"ok", "diverged", "unsupported"}
    return not outcomes and found.result.first_failure() is None


def figures_of(found: EngineCase) -> ScenarioFigures:
    """The figures of one engine on one scenario: its equations, and its finest runs."""
    runs = {RunKey(): _figures(found.shared)} if found.shared else {}
    finest: dict[str, float] = {}
    for run in found.runs:
        name, knob = run.integrator.name, run.sweep.knob
        finest[name] = min(knob, finest.get(name, knob))
    for run in found.runs:
        if run.sweep.knob == finest[run.integrator.name] and run.outcome in ("ok", "diverged"):
            key = RunKey(run.integrator.name, **knobs_of(run.sweep))
            runs[key] = _figures(run.rows, run.integrator.scheme or "")
    return ScenarioFigures(found.engine.description.version, runs)


def updated(stored: Baseline | None, now: Baseline, subject: Subject) -> Baseline:
    """The stored figures with those of now in their place.

    Other scenarios keep theirs, and so do integrators that were left out of this run, unless they
    are of another version: one scenario's figures are of one version.
    """
    whole = dict(stored or {})
    left_out = set(subject.declared) - set(subject.integrators)
    for scenario, figures in now.items():
        was = whole.pop(scenario, None)
        kept = {}
        if was is not None and was.version == figures.version:
            kept = {key: run for key, run in was.runs.items() if key.integrator in left_out}
        if runs := {**kept, **figures.runs}:
            whole[scenario] = ScenarioFigures(figures.version, runs)
    return whole


def last_digit(value: float) -> float:
    """Half a unit of the last digit that a stored figure keeps."""
    if value == 0.0 or not math.isfinite(value):
        return 0.0
    exponent = int(f"{value:.{DIGITS - 1}e}".partition("e")[2])
    return 0.5 * 10.0 ** (exponent - (DIGITS - 1))


def _left_band(was: Figure, value: float) -> bool:
    if math.isfinite(was.value) and math.isfinite(value):
        return abs(value - was.value) > was.band + last_digit(was.value)
    return was.value != value and not (math.isnan(was.value) and math.isnan(value))


def _size(change: Change) -> float:
    factor = change.factor
    return abs(math.log(factor)) if 0.0 < factor < math.inf else math.inf


def changes(was: Figures, now: Figures) -> list[Change]:
    """Every figure that left its band or is measured no more, the largest change first."""
    missing = Figure(math.nan, math.inf)
    values = {name: now.named.get(name, missing).value for name in was.named}
    found = [
        Change(name, figure, values[name])
        for name, figure in was.named.items()
        if _left_band(figure, values[name])
    ]
    return sorted(found, key=_size, reverse=True)
