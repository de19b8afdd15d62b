"""A Runge-Kutta-Munthe-Kaas step with wrong commutators, or with stages that turn wrongly.

The step of ``q = q0 exp(u)`` has ``u' = v + 1/2 [u, v] + 1/12 [u, [u, v]]``, or the closed form of
the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.simple_numbers import is_fraction, summed
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import (
    conjugate,
    exp_quaternion,
    normalize,
    quaternion_product,
)
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.motion import Velocity
from omegadot.reference_impl.schemes.runge_kutta import step_in_exponential
from omegadot.reference_impl.system import Array

SERIES, CLOSED = "lie-rk4", "munthe-kaas-rk4"
OWN = (0.5, 1 / 12)
DEXP = (-0.5, 1 / 6)  # of which the right series is the inverse
NAMES = ("v", "[u, v]", "[u, [u, v]]")
FROM_LEFT, STAGES_LEFT, STRAIGHT = "from the left", "stages from the left", "straight"
WAYS = {
    FROM_LEFT: "the turns of its stages and of the step are multiplied from the left",
    STAGES_LEFT: "the turns of its stages are multiplied from the left",
    STRAIGHT: "its stages turn by the quaternion (1, u/2), made unit, not by the exponential",
}


@dataclass(frozen=True)
class Turning:
    """factors: of [u, v] and [u, [u, v]].  way: "" or of WAYS."""

    factors: tuple[float, float] = OWN
    way: str = ""

    @property
    def is_plain(self) -> bool:
        """Whether both factors are fractions, as they are written by mistake."""
        return all(map(is_fraction, self.factors))

    def by(self, name: str) -> SchemeOf:
        """The step with them; a closed form has the second one's ratio to its own."""
        rate = _rate(*self.factors, closed=name == CLOSED)

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            if not self.way:
                return step_in_exponential(motion, rate, q, v, h)

            def stage(q: Array, u: Array) -> Array:
                turned = _straight(u) if self.way == STRAIGHT else exp_quaternion(u[..., -3:])
                pair = (q[..., -4:], turned) if self.way == STRAIGHT else (turned, q[..., -4:])
                return np.concatenate(
                    (motion.retract(q, u)[..., :-4], quaternion_product(*pair)), axis=-1
                )

            staged = replace(motion, retract=stage)
            found, v = step_in_exponential(staged, rate, q, v, h)
            if self.way == STAGES_LEFT:
                change = quaternion_product(found[..., -4:], conjugate(q[..., -4:]))
                turned = quaternion_product(q[..., -4:], change)
                found = np.concatenate((found[..., :-4], turned), axis=-1)
            return found, v

        return SchemeOf(replace(SCHEMES[name], step=step), "com-world")

    def makes(self, name: str, run: KeptRun) -> bool:
        """Whether its steps lead from every sample to the next."""
        return bool(np.all(run.sound(self.by(name))))

    def text(self, name: str) -> str:
        """What is wrong in it."""
        if self.way:
            return WAYS[self.way]
        once, twice = self.factors
        if once == OWN[0]:
            what = f"its second commutator {_what(twice / OWN[1])}"
        elif twice == OWN[1]:
            what = f"its first commutator {_what(once / OWN[0])}"
        elif self.factors == DEXP:
            what = "it has the differential of the exponential where its inverse is due"
        else:
            what = "its commutators have other factors"
        more = ", to second order in u" if name == CLOSED else ""
        return f"{what}: u' = {summed((1.0, *self.factors), NAMES)}{more}"


def _what(ratio: float) -> str:
    known = {0.0: "is missing", -1.0: "has the wrong sign", 2.0: "is doubled", 0.5: "is halved"}
    near = next((text for k, text in known.items() if abs(ratio - k) <= 1e-9), "")
    return near or "has another factor"


def _rate(once: float, twice: float, closed: bool) -> Velocity:
    def rate(u: Array, v: Array) -> Array:
        r, w = u[..., -3:], v[..., -3:]
        more = cross(r, w)
        of_second = 12.0 * twice * _closed(r) if closed else twice
        turned = w + once * more + of_second * cross(r, more)
        return np.concatenate((v[..., :-3], turned), axis=-1)

    return rate


def _closed(r: Array) -> Array:
    """``(1 - x/2 cot(x/2)) / x^2`` of x = |r|, (..., 1), 1/12 at zero."""
    square = np.sum(r * r, axis=-1, keepdims=True)
    small = square < EPS**0.25  # so that what the series leaves out is rounding
    x = np.sqrt(np.where(small, 1.0, square))
    series = 1 / 12 + square / 720 + square**2 / 30240 + square**3 / 1209600
    return np.asarray(np.where(small, series, (1.0 - 0.5 * x / np.tan(0.5 * x)) / (x * x)))


def _straight(u: Array) -> Array:
    quaternion = np.concatenate((np.ones_like(u[..., :1]), 0.5 * u[..., -3:]), axis=-1)
    return normalize(quaternion)
