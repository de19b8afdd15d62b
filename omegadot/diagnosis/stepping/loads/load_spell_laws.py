"""When a load stops or begins to act: after some steps or samples, a time, or a share of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.loads.acting import TERMS
from omegadot.diagnosis.stepping.loads.load_parts import least_stated
from omegadot.diagnosis.stepping.loads.load_spells import Spell, Turn, spells_of, turn_of
from omegadot.diagnosis.wording.digits import factor, number
from omegadot.diagnosis.wording.kinds import MOST_NAMED
from omegadot.reference_impl.system import System
from omegadot.written import written

SCENARIOS = 2  # at least, in which a load is seen to change
MOST_TRIED = 12  # runs, in which a load is looked for that changes
PLACES = (0.0, 0.5, 1.0)  # of a step, whose time decides whether the load acts in it
OF_SHARE = "% of a run"  # in the text of what depends on how many steps are requested
ALIKE = 3  # digits in which two times are one
Units = Callable[[Turn], float]


def spell_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The load that stops or begins to act in every run, and when; none where none does.

    It must make every run that fails, and those that do not: where it is not seen to change, what
    acts before, or after, makes the whole of it.
    """
    failing = sorted((run for run in runs if run.fails), key=lambda run: run.sweep.every)
    with np.errstate(all="ignore"):
        spells = next(filter(None, (spells_of(run, by) for run in failing[:MOST_TRIED])), [])
        made = {one.name: text for one in spells if (text := _law(one, by, runs, failing))}
        return least_stated(made)


def _law(spell: Spell, by: SchemeOf, runs: Sequence[KeptRun], failing: Sequence[KeptRun]) -> str:
    """When the load changes in all runs, as text; "" where by no law, or by many."""
    turns = list[Turn]()
    for run in (*failing, *(run for run in runs if not run.fails)):
        if run.fails or _is_requested(run.system, spell.name):
            turn = turn_of(run, by, spell)
            if turn is None:
                return ""
            turns.append(turn)
    seen = {turn.run.name for turn in turns if turn.run.fails and np.isfinite(turn.high)}
    if len(seen) < SCENARIOS:
        return ""
    counted = _by_steps(spell, turns) or _by_samples(spell, turns)
    laws = [text for text in (counted, *_by_times(spell, turns)) if text]
    text = laws[0] if len(laws) == 1 else f"either {', or '.join(laws)}"
    return f"in the steps, {text}" if 0 < len(laws) <= MOST_NAMED else ""


def _is_requested(system: System, name: str) -> bool:
    """Whether a load acts at all on this body."""
    load, parts = system.load, TERMS[name][0]
    acts = {
        "body": np.any(load.torque_body),
        "world": np.any(load.torque_world),
        "damping": np.any(load.damping),
        "moment": load.pivot is not None and np.any(load.gravity),
        "force": load.pivot is None and np.any(load.gravity),
    }
    return any(bool(acts.get(part, True)) for part in parts)


def _by_steps(spell: Spell, turns: Sequence[Turn]) -> str:
    low, high = max(one.low for one in turns), min(one.high for one in turns)
    if not 0 < low <= high or any(one.within for one in turns):
        return ""
    count = number(low) if low == high else f"{number(low)} to {number(high)}"
    steps = "step" if high == 1 else f"{count} steps"
    if spell.part == 0.0 and spell.stops:
        return f"{spell.name} acts in the first {steps} of a run alone"
    return _worded(spell, f"after the first {steps} of a run", f"in the first {steps} of a run")


def _by_samples(spell: Spell, turns: Sequence[Turn]) -> str:
    """By how many samples after the start a run has given."""
    every = np.array([one.run.sweep.every for one in turns])
    low, high = (np.array([getattr(one, end) for one in turns]) / every for end in ("low", "high"))
    first, last = np.max(np.ceil(low)), np.min(np.floor(high))
    if not 0 < first <= last < np.inf or any(one.within for one in turns):
        return ""
    count = number(first) if first == last else f"{number(first)} to {number(last)}"
    samples = "sample" if last == 1 else f"{count} samples"
    after = f"after the first {samples} of a run, however many steps lead there"
    return _worded(
        spell, after, f"up to the first {samples} of a run, however many steps lead there"
    )


def _by_times(spell: Spell, turns: Sequence[Turn]) -> Iterator[str]:
    """By the time, and by the share of a run."""
    for scale, unit, where in (
        (lambda one: 1.0, "s", ("from t = {} on", "until t = {}")),
        (
            lambda one: 0.01 * one.run.sweep.times[-1],
            "%",
            ("after the first {} of a run", "in the first {} of a run"),
        ),
    ):
        found = [_between(turns, place, scale) for place in PLACES]
        known = [ends for ends in found if ends is not None]
        if known:
            value = _shown(min(low for low, _ in known), max(high for _, high in known), unit)
            yield _worded(spell, *(text.format(value) for text in where))


def _between(turns: Sequence[Turn], place: float, scale: Units) -> tuple[float, float] | None:
    """Between which two the load changes in all runs; None where between none.

    place: of a step, whose time decides whether the load acts in it; where it changes within one,
    anywhere in it.
    """
    ends = [
        (one.low - (not one.within) * (1.0 - place), one.high + (one.within or place))
        for one in turns
    ]
    pairs = zip(turns, ends, strict=True)
    low, high = np.array(
        [[x * one.run.timestep / scale(one) for x in pair] for one, pair in pairs]
    ).T
    least, most = float(np.max(low)), float(np.min(high))
    return (least, most) if 0.0 < least < most < np.inf else None


def _shown(low: float, high: float, unit: str) -> str:
    """A number, or between which two."""
    one, other = written(low, ALIKE), written(high, ALIKE)
    if one == other:
        return f"{one} {unit}"
    return f"{written(low, ALIKE + 1)} to {written(high, ALIKE + 1)} {unit}"


def _worded(spell: Spell, later: str, at_first: str) -> str:
    acts = "does not act" if spell.part == 0.0 else f"is scaled by {factor(spell.part)}"
    return f"{spell.name} {acts} {later if spell.stops else at_first}"
