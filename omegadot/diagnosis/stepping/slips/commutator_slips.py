"""Which wrong commutator, or turn of a stage, makes every step of all runs of a Lie-group method.

The factors of the commutators are fitted to the steps of the largest turns; then each interval of
each run must be led on by them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.simple_numbers import plain
from omegadot.diagnosis.stepping.slips.commutators import CLOSED, OWN, SERIES, WAYS, Turning
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array

FITTED, TRIES, DELTA = 4, 6, 1e-3  # runs, corrections, and a change of a factor
SETTLED, KNOWN_TO = 1e-10, 1e-5
KNOWN = (OWN, (0.0, 0.0))  # each is a scheme of its own
LEAST, SCENARIOS = 3, 2  # intervals that show it, and scenarios whose number may be anything


def commutator_slips(integrator: Integrator, runs: Sequence[KeptRun]) -> list[str]:
    """What is wrong in the turns that make all runs; none where nothing does.

    Of a scheme that is not declared both are tried, where the order is theirs.
    """
    own, due = integrator.scheme, integrator.orders.get("attitude")
    names = [one for one in (SERIES, CLOSED) if own == one or (own is None and due in (None, 4))]
    way = integrator.coordinates
    runs = [run.short for run in runs if canonical(run.system, way) == "com-world"]
    if not names or not any(run.fails for run in runs):
        return []
    good = [(name, one) for name in names for one in _of_scheme(name, runs)]
    # without its second commutator the closed form is the series without it
    same = [(CLOSED, one) for name, one in good if name == SERIES and not one.factors[1]]
    found = [
        f"it is stepped by {name}, but {one.text(name)}"
        for name, one in good
        if (name, one) not in same
    ]
    return either(found) if len(found) <= MOST_NAMED else []


def _of_scheme(name: str, runs: Sequence[KeptRun]) -> list[Turning]:
    by = SchemeOf(SCHEMES[name], "com-world")
    failing = sorted((run for run in runs if run.fails), key=_turn, reverse=True)
    shown = [run for run in failing if np.count_nonzero(~run.sound(by)) >= LEAST]
    every = [*failing, *(run for run in runs if not run.fails)]
    several = len({run.name for run in failing}) >= SCENARIOS
    for tried in _tried(name, shown[:FITTED]):
        good = [
            one
            for one in tried
            if (one.is_plain or several) and all(one.makes(name, run) for run in every)
        ]
        if good:
            return good
    return []


def _turn(run: KeptRun) -> tuple[int, float]:
    """Few steps between samples, and rad, the largest turn of a step."""
    turn = float(np.max(norm(run.state.angular_velocity))) * run.sweep.timestep
    return -run.sweep.every, turn


def _tried(name: str, shown: Sequence[KeptRun]) -> Iterator[list[Turning]]:
    """Those of one mistake, then two wrong factors."""
    if not shown:
        return
    fits = (_fitted(name, shown, which) for which in ((0,), (1,)))
    yield [*(Turning(way=way) for way in WAYS), *(one for one in fits if one is not None)]
    both = _fitted(name, shown, (0, 1))
    yield [both] if both is not None else []


def _fitted(name: str, shown: Sequence[KeptRun], which: tuple[int, ...]) -> Turning | None:
    """The factors that leave least of the attitudes, by Gauss-Newton; None without such."""

    def off(factors: Array) -> Array:
        by = Turning((float(factors[0]), float(factors[1]))).by(name)
        apart = [
            run.apart(run.ends(by))["attitude"] / run.bounds["attitude"][:, None] for run in shown
        ]
        return np.concatenate([np.ravel(one) for one in apart])

    found = np.array(OWN)
    for _ in range(TRIES):
        here = off(found)
        moves = [DELTA * np.eye(2)[k] for k in which]
        slopes = np.stack([(off(found + move) - here) / DELTA for move in moves], axis=-1)
        good = np.isfinite(here) & np.isfinite(slopes).all(axis=-1)
        if not good.any() or np.linalg.matrix_rank(slopes[good]) < len(which):
            return None
        moved = np.linalg.lstsq(slopes[good], -here[good])[0]
        found[list(which)] += moved
        if float(np.max(np.abs(moved))) < SETTLED:
            break
    once, twice = (plain(float(k), KNOWN_TO) for k in found)
    return None if (once, twice) in KNOWN else Turning((once, twice))
