"""Which part of a load acts in the steps of a run, where it is the same in all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.loads.acting import PARTS, TERMS, with_factors
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array, State

LOADS = tuple(n for n, (parts, _) in TERMS.items() if not {"turn", "move"} & {*parts})
MOST_FAILING, MOST_SOUND = 12, 12  # runs in which the loads are looked at
SCENARIOS = 2  # at least, that show it
DELTA, MOST_TRIES = 1e-3, 8
FAINT = 10.0 * SLACK  # of bounds, below which a load does not show in a run
TINY = 1e-300


@dataclass(frozen=True)
class LoadPart:
    """The part of a load that acts, known to within known_to; infinite where none shows.

    fits: whether that leads from each sample to the next.
    """

    part: float
    known_to: float
    fits: bool

    @property
    def shows(self) -> bool:
        """Whether the run shows what part of the load acts."""
        return self.known_to < np.inf


def load_factors(names: Sequence[str], part: Array) -> dict[str, Array]:
    """(lanes, 1, 1) by part of the equation, where lane k has the load names[k] scaled."""
    holds = np.array([[part in TERMS[name][0] for part in PARTS] for name in names], dtype=float)
    factors = 1.0 + holds * (part[:, None] - 1.0)
    return dict(zip(PARTS, factors.T[..., None, None], strict=True))


def own_scheme(run: KeptRun, by: SchemeOf) -> SchemeOf | None:
    """The scheme in the coordinates that the run's body has; None where it is not known in them."""
    own = SchemeOf(by.scheme, canonical(run.system, by.coordinates))
    return own if own.coordinates in own.scheme.coordinates else None


def leads(run: KeptRun, own: SchemeOf, motion: Motion, lanes: int) -> NDArray[np.bool_]:
    """(lanes, m): whether each lane of the motion leads from each sample to the next."""
    return run.reached(run.ends(own, motion, lanes))


def looked_at(runs: Sequence[KeptRun]) -> tuple[list[KeptRun], list[KeptRun]]:
    """Of the failing runs and of the sound ones some of few steps a sample; none of one scenario.

    The sound ones are of the same scenarios first, whose loads they have.
    """
    names = {run.name for run in runs if run.fails}
    order = sorted(runs, key=lambda run: (run.name not in names, run.sweep.every))
    failing, sound = ([run for run in order if run.fails is fails] for fails in (True, False))
    every = failing[:: max(1, len(failing) // MOST_FAILING)]
    return (every, sound[:MOST_SOUND]) if len(names) >= SCENARIOS else ([], [])


def least_stated(made: Mapping[str, str]) -> list[str]:
    """What is said of the load that is a part of all others of which it could be said as well."""
    for name, text in made.items():
        if all({*TERMS[name][0]} <= {*TERMS[other][0]} for other in made):
            return [text]
    return []


def load_parts(run: KeptRun, by: SchemeOf, names: Sequence[str] = LOADS) -> dict[str, LoadPart]:
    """Of each load the part with which the scheme makes the run, by Gauss-Newton in lanes."""
    own = own_scheme(run, by)
    if own is None or not names:
        return {}
    shows = np.array([[c in TERMS[name][1] for c in CHANNELS] for name in names], dtype=float)

    def off(part: Array) -> tuple[Array, Array]:
        motion = with_factors(run.system, own, load_factors(names, part))
        return missed(run, run.ends(own, motion, len(names)), shows)

    with np.errstate(all="ignore"):
        return dict(zip(names, fitted_parts(len(names), off), strict=True))


def missed(run: KeptRun, ends: State, shows: Array) -> tuple[Array, Array]:
    """By how much ends (lanes, m, ...) miss the samples, in bounds; (lanes,): by how much at most.

    shows: (lanes, channels), one where a channel counts to the first; to the second each does.
    """
    apart = run.apart(ends)
    lines = [apart[c] / np.maximum(run.bounds[c], TINY)[:, None] for c in CHANNELS]
    most = np.max([norm(line) for line in lines], axis=(0, 2))
    shown = [shows[:, k, None, None] * line for k, line in enumerate(lines)]
    return np.concatenate(shown, axis=-1), np.asarray(most)


def fitted_parts(lanes: int, off: Callable[[Array], tuple[Array, Array]]) -> list[LoadPart]:
    """In each lane the number, from one on, with which nothing is missed. off: as `missed`."""
    part = np.ones(lanes)
    here, most = off(part)
    for _ in range(MOST_TRIES):
        slope = (off(part + DELTA)[0] - here) / DELTA
        steepest = np.max(norm(slope), axis=-1)
        moved = -np.sum(slope * here, axis=(1, 2)) / np.sum(slope * slope, axis=(1, 2))
        moved = np.where(np.isfinite(moved) & (most > SLACK) & (steepest > FAINT), moved, 0.0)
        if not np.any(moved):
            break
        part = part + moved
        here, most = off(part)
    known_to = np.where(steepest > FAINT, SLACK / steepest, np.inf)
    rows = zip(part.tolist(), known_to.tolist(), (most <= SLACK).tolist(), strict=True)
    return [LoadPart(*row) for row in rows]
