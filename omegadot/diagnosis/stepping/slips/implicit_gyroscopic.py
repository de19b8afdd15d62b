"""A step of Euler's in which the gyroscopic term alone is implicit, as in engines for games.

With ``g(w) = -w x I w`` and ``J = I^-1 dg/dw = I^-1 ([I w]x - [w]x I)``, one Newton step from w is
``dw = (1 - h J)^-1 h I^-1 g(w)``; what else turns the body is added with its value at the start.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.slips.jacobians import Jacobian
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.jacobian import solve_one_minus
from omegadot.reference_impl.schemes.motion import per_matrix
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

Change = Callable[[System, Array, Array, float | Array], Array]  # of omega, by its rate
OF = ("semi-implicit-euler", "linearly-implicit-euler")
GYROSCOPIC = Jacobian((1.0, 1.0, 0.0))
MOST_ROUNDS, SETTLED = 30, 2.0**-50


def _rate(system: System, w: Array) -> Array:
    inertia = moving_inertia(system)
    return -apply(inverse(inertia), cross(w, apply(inertia, w)))


def _solved(system: System, w: Array, right: Array, h: float | Array) -> Array:
    matrix = GYROSCOPIC.terms(system, w) @ np.array(GYROSCOPIC.factors)
    return solve_one_minus(per_matrix(h) * matrix, right)


def _one_newton_step(system: System, w: Array, rate: Array, h: float | Array) -> Array:
    own = _rate(system, w)
    return h * (rate - own) + _solved(system, w, h * own, h)


def _after_torque(system: System, w: Array, rate: Array, h: float | Array) -> Array:
    pushed = h * (rate - _rate(system, w))
    return pushed + _solved(system, w + pushed, h * _rate(system, w + pushed), h)


def _solved_for(system: System, w: Array, rate: Array, h: float | Array) -> Array:
    """Newton's method on ``dw = h I^-1 g(w + dw)``."""
    change = np.zeros_like(w)
    for _ in range(MOST_ROUNDS):
        more = _solved(system, w + change, h * _rate(system, w + change) - change, h)
        change = change + more
        if not np.any(np.abs(more) > SETTLED * np.max(np.abs(w), axis=-1, keepdims=True)):
            break
    return h * (rate - _rate(system, w)) + change


def _in_all(system: System, w: Array, rate: Array, h: float | Array) -> Array:
    return _solved(system, w, h * rate, h)


CHANGES: dict[str, Change] = {
    "by one Newton step from the omega of its start, and all torque is added explicitly": (
        _one_newton_step
    ),
    "by one Newton step from the omega that the torques have pushed": _after_torque,
    "solved for to the end, and all torque is added explicitly": _solved_for,
    "by one Newton step, in whose matrix there is no damping": _in_all,
}


def implicit_gyroscopic(integrator: Integrator, runs: Sequence[KeptRun]) -> list[str]:
    """How the gyroscopic term is implicit in every step of every run; none where it is not so."""
    name, way = integrator.scheme or "", integrator.coordinates
    runs = [run.short for run in runs if canonical(run.system, way) == "com-world"]
    failing = [run for run in runs if run.fails]
    if name not in OF or not failing:
        return []
    by = SchemeOf(SCHEMES[name], "com-world")
    if not GYROSCOPIC.shows(by, failing):
        return []
    every = [*failing, *(run for run in runs if not run.fails)]
    good = [how for how, change in CHANGES.items() if all(_makes(change, run) for run in every)]
    texts = [
        f"it is stepped by {name}, but the gyroscopic term is taken implicitly, {how}"
        for how in good
    ]
    return either(texts) if len(texts) <= MOST_NAMED else []


def _makes(change: Change, run: KeptRun) -> bool:
    """Whether these steps lead from every sample to the next, where rounding does not hide it."""

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        a = motion.acceleration(q, v)
        angular = change(run.system, v[..., -3:], a[..., -3:], h)
        v = v + np.concatenate((h * a[..., :-3], angular), axis=-1)
        return motion.retract(q, h * v), v

    own = SchemeOf(replace(SCHEMES["semi-implicit-euler"], step=step), "com-world")
    good = run.sound(own) | ~GYROSCOPIC.judged(run)
    return bool(np.all(good) or np.all(good | run.sound_but_for_rounding(own)))
