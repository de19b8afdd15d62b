"""Which wrong Jacobian makes every step of all runs of a linearly implicit method.

In its terms the Jacobian is linear, so that least squares of the steps of all runs give a factor
for each; then each interval of each run must be led on by them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, product

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.simple_numbers import plain
from omegadot.diagnosis.stepping.slips.jacobians import FORMS, OWN, PLACES, Jacobian
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State

KNOWN = ((1.0, 1.0, 1.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0))  # each is a scheme of its own
MISTYPED = (-1.0, 0.0, 0.5, 2.0)  # factors of one term
SCENARIOS = 2  # on which a number that is no fraction must be the same
KNOWN_TO = 1e-5  # what least squares leave of a factor, at most, in the few steps that are kept


def jacobian_slips(integrator: Integrator, runs: Sequence[KeptRun]) -> list[str]:
    """The wrong Jacobian that makes every step of every run; none where none does.

    What is wrong in fewer terms comes first. A number that is no fraction takes two scenarios.
    """
    name, way = integrator.scheme or "", integrator.coordinates
    runs = [run.short for run in runs if canonical(run.system, way) == "com-world"]
    failing = sorted((run for run in runs if run.fails), key=lambda run: run.sweep.every)
    if name not in OWN or not failing:
        return []
    own, by = OWN[name], SchemeOf(SCHEMES[name], "com-world")
    every = [*failing, *(run for run in runs if not run.fails)]
    for tried in _tried(own, [run for run in failing if run.sweep.every == 1]):
        good = [one for one in tried if all(one.makes(name, run) for run in every)]
        good = [one for one in good if one.shows(by, failing)]
        if len({run.name for run in failing}) < SCENARIOS:
            good = [one for one in good if one.is_plain]
        if good:
            texts = [f"it is stepped by {name}, but {one.text(own)}" for one in good]
            return either(texts) if len(texts) <= MOST_NAMED else []
    return []


def _tried(own: tuple[float, ...], single: Sequence[KeptRun]) -> Iterator[list[Jacobian]]:
    """Those of one mistake, then of two wrong factors, and of three."""
    there = [k for k, due in enumerate(own) if due]
    whole = [fitted for fitted in [_fitted(own, single, [there])] if fitted]
    one = [Jacobian(own, place=place) for place in PLACES if place]
    if len(there) > 1:
        # on the other side of the inertia its inverse leaves as little as that on the other side
        formed = [(p, q) for p, q in product(FORMS, repeat=2) if (p or q) and p != "O" and q != "S"]
        one += [Jacobian(own, pair) for pair in formed]
    one += whole + [f for k in there if (f := _fitted(own, single, [[k]])) is not None]
    # where no run keeps every step, nothing is fitted
    plain_ones = [(*own[:k], other, *own[k + 1 :]) for k in there for other in MISTYPED]
    if own[:2] == (1.0, 1.0):
        plain_ones += [(other, other, *own[2:]) for other in MISTYPED]  # the gyroscopic ones
    one += [Jacobian(factors) for factors in plain_ones if factors not in KNOWN]
    yield [*dict.fromkeys(one)]
    for count in range(2, len(there) + 1):
        sets = combinations(there, count)
        fits = (_fitted(own, single, [[k] for k in chosen]) for chosen in sets)
        yield [found for found in fits if found is not None]


def _fitted(
    own: tuple[float, ...], single: Sequence[KeptRun], alike: Sequence[Sequence[int]]
) -> Jacobian | None:
    """With other factors on these terms, one on those that are alike; None where none shows."""
    lines, rights = list[Array](), list[Array]()
    for run in single:
        w, h = run.state.angular_velocity, run.sweep.timestep
        change = w[1:] - w[:-1]
        start = State(*(f[:-1] for f in vars(run.state).values()))
        terms = np.einsum("nijk,nj->nik", Jacobian(own).terms(run.system, w[:-1]), change)
        left = change - h * forward_dynamics(run.system, start).angular - h * (terms @ own)
        columns = [h * np.sum(terms[..., ks], axis=-1) for ks in alike]
        weight = 1.0 / run.bounds["omega"][:, None]
        rights.append(np.ravel(left * weight))
        lines.append(np.stack([np.ravel(column * weight) for column in columns], axis=-1))
    if not lines:
        return None
    line, right = np.concatenate(lines), np.concatenate(rights)
    good = np.isfinite(right) & np.isfinite(line).all(axis=-1)
    line, right = line[good], right[good]
    if np.linalg.matrix_rank(line) < line.shape[1]:
        return None
    off = np.linalg.lstsq(line, right)[0]
    factors = np.array(own)
    for ks, more in zip(alike, off, strict=True):
        factors[list(ks)] += more
    found = tuple(plain(float(k), KNOWN_TO) for k in factors)
    return None if found in KNOWN else Jacobian(found)
