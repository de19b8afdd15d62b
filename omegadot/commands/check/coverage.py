"""What a check covers, in the line above its results: so many gates on scenarios and in runs."""

from __future__ import annotations

from collections.abc import Sequence

from omegadot.commands.check.result import Check, Subject
from omegadot.reports.text.numbers import listed, times

# Scenario, integrator, step and accuracy.
_Place = tuple[str, str | None, float | None, float | None]


def coverage(subjects: Sequence[Subject], checks: Sequence[Check]) -> list[str]:
    """Engine, version, and how many checks: so many gates on each scenario, and in each run, which
    is an integrator at a step; a line an engine.
    """
    lines = []
    for subject in subjects:
        own = [check for check in checks if check.engine == subject.name]
        parts = [
            _covered([c for c in own if c.scenario and bool(c.integrator) is of_runs])
            for of_runs in (False, True)
        ]
        chosen = set(subject.integrators) != set(subject.declared)
        name = f"{subject.name} {subject.version}" + (
            f" ({', '.join(subject.integrators)})" if chosen else ""
        )
        covered = ", and ".join(filter(None, parts))
        lines.append(f"{name}: {times(len(own), 'check')}" + f", {covered}" * bool(covered))
    return lines


def _covered(checks: Sequence[Check]) -> str:
    """``model and equation on each of 45 scenarios``, or ``scheme in each of 145 runs``.

    A gate that is not everywhere, as a baseline, follows: ``and baseline in 29 of these, at the
    finest step``.
    """
    if not checks:
        return ""
    where, kind = ("in", "run") if checks[0].integrator else ("on", "scenario")
    of_gates: dict[str, list[_Place]] = {}
    for check in checks:
        place = (check.scenario, check.integrator, check.timestep, check.accuracy)
        of_gates.setdefault(check.gate, []).append(place)
    gates_at: dict[frozenset[_Place], list[str]] = {}
    for gate, own in of_gates.items():
        gates_at.setdefault(frozenset(own), []).append(gate)
    whole = next(iter(gates_at))
    parts = []
    for places, gates in gates_at.items():
        if places < whole:
            among = f"{len(places)} of these{_at_finest(places, whole)}"
        else:
            among = "each of " * (len(places) > 1) + times(len(places), kind)
        parts.append(f"{listed(gates)} {where} {among}")
    return ", and ".join(parts)


def _at_finest(places: frozenset[_Place], whole: frozenset[_Place]) -> str:
    """``, at the finest step`` where some runs are the finest of all; else ""."""
    finest: dict[tuple[str, str | None], float] = {}
    for scenario, integrator, timestep, accuracy in whole:
        if (knob := timestep or accuracy) is None:
            return ""
        own = (scenario, integrator)
        finest[own] = min(knob, finest.get(own, knob))
    if any((p[2] or p[3]) != finest[p[:2]] for p in places):
        return ""
    kinds = [name for name, at in (("step", 2), ("accuracy", 3)) if any(p[at] for p in places)]
    return f", at the finest {' or '.join(kinds)}"
