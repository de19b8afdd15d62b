"""Runs at steps beyond a length are by another scheme: longer ones alone, or shorter ones."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf, plain_names
from omegadot.diagnosis.wording.conditions import ODDS
from omegadot.diagnosis.wording.digits import limits
from omegadot.reference_impl.schemes import COMMON

SCENARIOS = 2  # at least, whose runs show either scheme alone


def scheme_by_length(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """Which scheme, and from which length of a step on; none where a run is by neither."""
    short = [run.short for run in runs]
    own = [bool(np.all(run.sound(by))) for run in short]
    if len({run.name for run, sound in zip(short, own, strict=True) if not sound}) < SCENARIOS:
        return []
    texts = dict[str, list[str]]()
    for name, scheme in COMMON.items():
        if name != by.scheme.name and by.coordinates in scheme.coordinates:
            text = _beyond(short, own, SchemeOf(scheme, by.coordinates))
            if text:
                texts.setdefault(text, []).append(name)
    if len(texts) != 1:
        return []
    ((text, names),) = texts.items()
    return [f"{text} are by {' or '.join(plain_names(names))}, not by {by.scheme.name}"]


def _beyond(runs: Sequence[KeptRun], own: Sequence[bool], other: SchemeOf) -> str:
    """``steps longer than a limit between ..``; "" where no length sorts the runs."""
    wrong, right = list[KeptRun](), list[KeptRun]()
    for run, sound in sorted(zip(runs, own, strict=True), key=lambda one: one[1]):
        made = bool(np.all(run.sound_but_for_rounding(other)))
        if not made and not sound:
            return ""
        if made != sound:
            (right if sound else wrong).append(run)
    if min(len({run.name for run in part}) for part in (wrong, right)) < SCENARIOS:
        return ""
    if comb(len(wrong) + len(right), len(right)) < ODDS:
        return ""  # so few are sorted by chance
    lengths = [[run.timestep for run in part] for part in (wrong, right)]
    if max(lengths[1]) < min(lengths[0]):
        return f"steps longer than a limit between {limits(max(lengths[1]), min(lengths[0]), 's')}"
    if max(lengths[0]) < min(lengths[1]):
        return f"steps shorter than a limit between {limits(max(lengths[0]), min(lengths[1]), 's')}"
    return ""
