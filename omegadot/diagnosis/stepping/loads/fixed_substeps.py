"""Steps that are taken as whole substeps of one length, the rest of them dropped or made up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.wording.digits import number
from omegadot.reference_impl.schemes import Motion, Scheme
from omegadot.reference_impl.system import Array

# s, as loops of games and controllers have them.
LENGTHS = tuple(
    sorted({1.0 / n for n in (10, 20, 25, 30, 50, 60, 100, 120, 200, 240, 480, 500, 1000, 2000)})
)
WAYS: dict[str, Callable[[float], float]] = {
    "what is left of it is dropped": np.floor,
    "one more makes up for what is left of it": np.ceil,
    "their number is the nearest whole one": np.round,
}
WHOLE = 1e-9  # relative: a step that is so many substeps
MOST = 200  # substeps between two samples, of runs that are looked at
LEAST, SCENARIOS, MOST_SOUND = 3, 2, 6  # runs that show it, of so many scenarios


def fixed_substeps(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """Of runs of a scheme that is known: those that fail are made so, and no sound one is not.

    Runs of longer steps than any that fails may be sound: there no substeps are taken.
    """
    short = sorted((run.short for run in runs), key=lambda run: run.sweep.every)
    failing = [run for run in short if run.fails and not run.sound(by).all()]
    if len(failing) < LEAST:
        return []
    longest = max(run.timestep for run in failing)
    sound = [run for run in short if not run.fails and run.timestep <= longest]
    found = [
        (text, length)
        for length in LENGTHS
        for text, way in WAYS.items()
        if _makes(by, length, way, failing, sound)
    ]
    if len(found) != 1:
        return []
    text, length = found[0]
    rest = [run for run in short if not run.fails and run.timestep > longest]
    rest = [run for run in rest if abs(run.timestep / length % 1.0 - 0.5) < 0.5 - WHOLE]
    beyond = [run.timestep for run in rest if run.sound(by).all()]
    each = f"{number(length)} s"
    whole = f"; steps of {number(min(beyond))} s and longer are taken whole" if beyond else ""
    return [f"a step longer than {each} is taken in substeps of {each}, and {text}{whole}"]


def _makes(
    by: SchemeOf,
    length: float,
    way: Callable[[float], float],
    failing: Sequence[KeptRun],
    sound: Sequence[KeptRun],
) -> bool:
    counts = {id(run): _count(run.timestep, length, way) for run in (*failing, *sound)}
    tried = [run for run in failing if counts[id(run)] * run.sweep.every <= MOST]
    names = {run.name for run in tried}
    if len(tried) < LEAST or len(names) < SCENARIOS:
        return False
    if not all(counts[id(run)] for run in tried):
        return False  # steps that are taken whole do not make it: it is known to fail by them
    # of the sound ones those that substeps would change say most
    apart = [run for run in sound if abs(counts[id(run)] * length - run.timestep) > WHOLE * length]
    apart = [run for run in apart if 0 < counts[id(run)] <= MOST]
    return all(
        bool(np.all(run.sound(_substepped(by, length, counts[id(run)]))))
        for run in (*tried, *apart[:MOST_SOUND])
    )


def _count(step: float, length: float, way: Callable[[float], float]) -> int:
    """How many substeps; none of a step that is no longer than one, which is taken whole."""
    parts = step / length
    near = round(parts)
    if parts <= 1.0 + WHOLE:
        return 0
    return near if abs(parts - near) <= WHOLE * parts else int(way(parts))


def _substepped(by: SchemeOf, length: float, count: int) -> SchemeOf:
    """The scheme whose steps are so many of this length, whatever is requested."""
    scheme = by.scheme

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        for _ in range(count):
            q, v = scheme.step(motion, q, v, length)
        return q, v

    own: Scheme = replace(scheme, step=step)
    return replace(by, scheme=own)
