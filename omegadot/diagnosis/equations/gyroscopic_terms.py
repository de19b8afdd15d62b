"""The gyroscopic term written out by components, with one of its products wrong.

``(omega x I omega)_k = sum of e_kij omega_i I_jm omega_m``: in each component every number of the
inertia stands before one or two products of omega.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.operators.operands import pushed
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Acceleration, Array

AXES = "xyz"
WRONG = {"is missing": -1.0, "has the wrong sign": -2.0, "counts twice": 1.0}
Term = tuple[int, int, int, int, float]  # k, i, j, m and the sign


def _terms() -> Iterator[Term]:
    for k in range(3):
        for i, j, sign in (((k + 1) % 3, (k + 2) % 3, 1.0), ((k + 2) % 3, (k + 1) % 3, -1.0)):
            yield from ((k, i, j, m, sign) for m in range(3))


def wrong_products() -> Iterator[tuple[str, Callable[[Evidence], Acceleration]]]:
    """Each as a cause and the accelerations it makes: of one number, then of a single product."""
    terms = list(_terms())
    for k, axis in enumerate(AXES):
        here = [one for one in terms if one[0] == k]
        of = f"in the {axis} component of the gyroscopic term what has"
        for number in dict.fromkeys(_number(one) for one in here):
            group = [one for one in here if _number(one) == number]
            for way, more in WRONG.items():
                yield f"{of} I_{number} {way}", partial(_made, group, more)
            for one in group if len(group) > 1 else ():
                product = f"omega_{AXES[one[1]]} I_{number} omega_{AXES[one[3]]}"
                for way, more in WRONG.items():
                    yield f"{of} {product} {way}", partial(_made, [one], more)


def _number(term: Term) -> str:
    return "".join(sorted(AXES[term[2]] + AXES[term[3]]))


def _made(terms: Sequence[Term], more: float, e: Evidence) -> Acceleration:
    inertia, w = np.asarray(moving_inertia(e.system), dtype=float), e.states.angular_velocity
    torque: Array = np.zeros_like(w)
    for k, i, j, m, sign in terms:
        torque[:, k] -= more * sign * w[:, i] * inertia[j, m] * w[:, m]
    return pushed(e, torque)
