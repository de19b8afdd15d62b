"""Runs of whose last sample single fields are those of another step; the others are right."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

from omegadot.diagnosis.stepping.ends.last_samples import RunEnd, scenarios_that_show
from omegadot.diagnosis.stepping.kept_run import CHANNELS, SchemeOf

OF_FIELD = "the {} of the last sample of every run {} of the step {} its time"
FIELDS: Mapping[tuple[str, ...], tuple[str, str]] = {
    ("attitude",): ("attitude", "is that"),
    ("omega",): ("omega", "is that"),
    ("position",): ("position", "is that"),
    ("velocity",): ("linear velocity", "is that"),
    ("attitude", "position"): ("attitude and position", "are those"),
    ("omega", "velocity"): ("omega and linear velocity", "are those"),
    ("position", "velocity"): ("position and linear velocity", "are those"),
    ("omega", "attitude"): ("omega and attitude", "are those"),
}
SHIFTS = ((-1, "before"), (1, "after"))
ROTATION = ("omega", "attitude")


def other_fields(ends: Sequence[RunEnd], by: SchemeOf) -> tuple[str, set[str]]:
    """Which fields of every last sample are of another step, and the scenarios that show it."""
    for fields, (what, are) in FIELDS.items():
        for shift, where in SHIFTS:
            shown = scenarios_that_show(ends, by, partial(_are_moved, by, fields, shift))
            if shown:
                return OF_FIELD.format(what, are, where), shown
    return "", set()


def _are_moved(by: SchemeOf, fields: Sequence[str], shift: int, end: RunEnd) -> bool:
    """Whether these fields are of the step so many further, and the others of the run's own."""
    rest = [channel for channel in CHANNELS if channel not in fields]
    if end.system.load.pivot is not None:  # attitude and omega make the others
        fields, rest = ([c for c in some if c in ROTATION] for some in (fields, rest))
    return end.is_after(by, end.steps + shift, fields) and (
        not rest or end.is_after(by, end.steps, rest)
    )
