"""To what change an implicit scheme's equation is solved, where samples are several steps apart.

Each step is iterated until the mean omega of the step changes by less than a limit. With the right
limit every interval of every run is made, those that pass as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.turns.iterates import NEAR, means_of
from omegadot.diagnosis.stepping.turns.solved import KINDS, MIDPOINT
from omegadot.diagnosis.wording.digits import limits, number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.scheme import Step
from omegadot.reference_impl.system import Array, State

LONGEST = 16  # steps between samples
FAILING, SOUND = 6, 3  # runs
SCENARIOS, LEAST = 2, 6  # that fail, and intervals that are not the solved equation's
TRIED = 10.0 ** -np.arange(1.0, 13.0, 0.5)
HALVINGS = 4
SIZES = {True: "of itself", False: "rad/s"}


def tolerance_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The limit at which iterations end; none where no limit makes all intervals of these runs."""
    if by.scheme.name != MIDPOINT:
        return []
    with np.errstate(all="ignore"):
        chosen = _chosen(runs)
        exact = {id(run): run.ends(_own(by, run)) for run in chosen}
        off = {id(run): ~_sound(run, exact[id(run)]) for run in chosen}
        shown = {run.name for run in chosen if np.any(off[id(run)])}
        if len(shown) < SCENARIOS or sum(map(np.count_nonzero, off.values())) < LEAST:
            return []
        chosen.sort(key=lambda run: (not np.any(off[id(run)]), run.sweep.every))

        def makes(kind: str, relative: bool, limit: float) -> bool:
            return all(_makes(run, by, kind, relative, limit, exact[id(run)]) for run in chosen)

        for kind, guess in KINDS.items():
            for relative, unit in SIZES.items():
                fits = [float(one) for one in TRIED if makes(kind, relative, one)]
                if not fits or TRIED[0] in fits or TRIED[-1] in fits:
                    continue  # of a limit that may be any nothing is seen

                def edge(
                    inside: float, way: float, how: tuple[str, bool] = (kind, relative)
                ) -> float:
                    return _edge(lambda x: makes(*how, x), inside, inside * 10.0 ** (0.5 * way))

                how = f"the scheme's equation is solved by {{}}{kind.strip()} iterations {guess}"
                counts = _counts(chosen, by, kind, relative, fits[0])
                if len(counts) == 1:
                    return [f"{how.format(f'{counts.pop()} ')}, in every step that was looked at"]
                between = edge(min(fits), -1.0), edge(max(fits), 1.0)
                end = (
                    f"once the mean omega of a step changes by less than {_limit(*between)} {unit}"
                )
                return [f"{how.format('')}, which end {end}"]
    return []


def _limit(low: float, high: float) -> str:
    """A power of ten, where one lies between."""
    plain = float(10.0 ** np.round(np.log10((low * high) ** 0.5)))
    return number(plain) if low < plain < high else f"a limit between {limits(low, high, '')}"


def _counts(
    runs: Sequence[KeptRun], by: SchemeOf, kind: str, relative: bool, limit: float
) -> set[int]:
    """How many iterations steps take: where all take as many, that may be what ends them."""
    counts = list[Array]()
    for run in runs:
        if run.fails:
            run.ends(_own(by, run, _until(kind, relative, limit, counts)))
    return {int(one) for one in np.unique(np.concatenate(counts))}


def _edge(makes: Callable[[float], bool], inside: float, outside: float) -> float:
    """A limit just outside of those that make all runs, by halves."""
    for _ in range(HALVINGS):
        middle = (inside * outside) ** 0.5
        inside, outside = (middle, outside) if makes(middle) else (inside, middle)
    return outside


def _chosen(runs: Sequence[KeptRun]) -> list[KeptRun]:
    """Those of fewest steps between samples, one a scenario."""
    found = list[KeptRun]()
    for fails, most in ((True, FAILING), (False, SOUND)):
        kept = dict[str, KeptRun]()
        for run in sorted(runs, key=lambda run: (run.sweep.every, -run.sweep.timestep)):
            if run.fails is fails and run.sweep.every <= LONGEST:
                kept.setdefault(run.name, run.short)
        found += [*kept.values()][:most]
    return found


def _own(by: SchemeOf, run: KeptRun, step: Step | None = None) -> SchemeOf:
    scheme = by.scheme if step is None else replace(by.scheme, step=step)
    return SchemeOf(scheme, canonical(run.system, by.coordinates))


def _sound(run: KeptRun, ends: State) -> NDArray[np.bool_]:
    apart = run.apart(ends)
    return np.asarray(np.all([norm(apart[x]) <= SLACK * run.bounds[x] for x in CHANNELS], axis=0))


def _makes(
    run: KeptRun, by: SchemeOf, kind: str, relative: bool, limit: float, exact: State
) -> bool:
    """Whether every interval is led on so; a Jacobian by differences may change an iterate."""
    made, solved = (
        run.apart(run.ends(_own(by, run, _until(kind, relative, limit)))),
        run.apart(exact),
    )
    near = 0.0 if kind.startswith("fixed") else NEAR
    return all(
        bool(np.all(norm(made[c]) <= SLACK * run.bounds[c] + near * norm(solved[c] - made[c])))
        for c in CHANNELS
    )


def _until(kind: str, relative: bool, limit: float, counts: list[Array] | None = None) -> Step:
    """The step whose iterations end at this change. counts: where their number is added."""

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        kept = last = np.full_like(v, np.nan)
        ended, count = np.zeros(v.shape[:-1], dtype=bool), np.full(v.shape[:-1], -1)
        for mean in means_of(motion, q, v, h, kind):
            kept, count = np.where(ended[..., None], kept, mean), count + ~ended
            size = norm(mean[..., motion.spin]) if relative else 1.0
            ended = ended | (norm((mean - last)[..., motion.spin]) <= limit * size)
            if np.all(ended):
                break
            last = mean
        if counts is not None:
            counts.append(np.ravel(count))
        return motion.retract(q, motion.cayley(h * kept)), 2.0 * kept - v

    return step
