"""A vector turned by the parts of a quaternion, ``v + 2 s (u x v) + 2 u x (u x v)``, mistyped.

Three formulas are in use. What is off is said of the one in which the fewest factors are off.
"""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.mistyped.few import Few
from omegadot.diagnosis.equations.mistyped.products import sum_text
from omegadot.diagnosis.wording.digits import factor, listed, number
from omegadot.reference_impl.system import Array

MOST_OFF = 2  # factors of a formula, above which it is another
SAME = 1e-9
OUTER = "u x (u x v)"
SIDE = "s (u x v)"
ALONG = "u (u . v)"


def vector_form(q: Array) -> Array:
    """``1``, ``s [u x]``, ``u u^T`` and ``u . u``, as matrices (4, n, 3, 3)."""
    s, u = q[:, :1, None], q[:, 1:]
    one = np.broadcast_to(np.eye(3), (len(q), 3, 3))
    side = s * np.cross(u[:, None, :], -np.eye(3))
    return np.stack(
        [one, side, u[:, :, None] * u[:, None, :], one * np.sum(u * u, -1)[:, None, None]]
    )


def form_text(what: str, more: Few, into_body: bool) -> str:
    """The formula as it is typed and as it is right; "" where no known one has so few factors off.

    more: what the factors of `vector_form` are off by.  into_body: u is then taken negative.
    """
    forms = [_factors(more, into_body)[k] for k in range(3)]
    off = [[p for p in typed if abs(typed[p] - due[p]) > SAME] for typed, due in forms]
    best = min(range(3), key=lambda k: len(off[k]))
    typed, due = forms[best]
    if not 0 < len(off[best]) <= MOST_OFF:
        return ""
    wrong = [f"the factor of {p} is {_against(typed[p], due[p])}" for p in off[best]]
    where = f"where {sum_text(due)} is right, q = (s, u)"
    return f"{what} by {sum_text(typed)}, {where}: {listed(wrong)}"


def _against(typed: float, due: float) -> str:
    return f"scaled by {factor(typed / due)}" if due else f"{number(typed)}, not zero"


def _factors(more: Few, into_body: bool) -> list[tuple[dict[str, float], dict[str, float]]]:
    """Of each formula, as it is typed and as it is right."""
    d0, d1, d2, d3 = (c for _, c in more)
    sign = -1.0 if into_body else 1.0
    side, due = sign * (2.0 + d1), sign * 2.0
    rest = d2 + d3 if abs(d2 + d3) > SAME else 0.0  # of |u|^2 v, which the first does not have
    return [
        (
            {"v": 1.0 + d0, SIDE: side, OUTER: 2.0 + d2, "|u|^2 v": rest},
            {"v": 1.0, SIDE: due, OUTER: 2.0, "|u|^2 v": 0.0},
        ),
        (
            {"s^2 v": 1.0 + d0, "|u|^2 v": d0 + d3 - 1.0, SIDE: side, ALONG: 2.0 + d2},
            {"s^2 v": 1.0, "|u|^2 v": -1.0, SIDE: due, ALONG: 2.0},
        ),
        (
            {"s^2 v": 2.0 - d3, "v": d0 + d3 - 1.0, SIDE: side, ALONG: 2.0 + d2},
            {"s^2 v": 2.0, "v": -1.0, SIDE: due, ALONG: 2.0},
        ),
    ]
