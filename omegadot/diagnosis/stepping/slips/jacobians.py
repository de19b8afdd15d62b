"""A linearly implicit step with a wrong Jacobian: its terms with other factors, or transposed.

The step is ``(1 - h J) dw = h wdot`` with ``J = I^-1 ([I w]x - [w]x I - d)``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.simple_numbers import fraction, is_fraction
from omegadot.diagnosis.wording.digits import listed
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.jacobian import solve_one_minus
from omegadot.reference_impl.schemes.motion import per_matrix
from omegadot.reference_impl.symmetric import inverse
from omegadot.reference_impl.system import Array, System

TERMS = ("I^-1 [I omega]x", "-I^-1 [omega]x I", "-I^-1 d")
OWN = {"linearly-implicit-euler": (1.0, 1.0, 1.0), "implicit-damping-euler": (0.0, 0.0, 1.0)}
FORMS = {
    "": "",
    "T": "is transposed",
    "I": "lacks I^-1",
    "S": "has I^-1 on the other side",
    "O": "has I on the other side",
}
PLACES = {
    0.0: "",
    0.5: "the omega of half an explicit step on",
    1.0: "the omega of an explicit step on",
}
LEAST = 3  # intervals that show it


@dataclass(frozen=True)
class Jacobian:
    """factors: of TERMS.  forms: of the gyroscopic ones, keys of FORMS.  place: of PLACES."""

    factors: tuple[float, ...]
    forms: tuple[str, str] = ("", "")
    place: float = 0.0

    def terms(self, system: System, w: Array) -> Array:
        """(..., 3, 3, terms), without the factors."""
        inertia = moving_inertia(system)
        back = inverse(inertia)
        spun = skew((inertia @ w[..., None])[..., 0])
        gyroscopic = (spun, inertia @ -skew(w) if self.forms[1] == "O" else -skew(w) @ inertia)
        made = [_formed(one, back, how) for one, how in zip(gyroscopic, self.forms, strict=True)]
        damped = -float(system.load.damping) * back
        return np.stack([*made, np.broadcast_to(damped, made[0].shape)], axis=-1)

    def step(
        self, system: System, motion: Motion, q: Array, v: Array, h: float | Array
    ) -> tuple[Array, Array]:
        """``(1 - h J) dv = h vdot`` and ``q exp(h v)``, in which J does not move translation."""
        a = motion.acceleration(q, v)
        angular = self.terms(system, (v + self.place * h * a)[..., -3:]) @ np.array(self.factors)
        still = np.zeros((*angular.shape[:-2], v.shape[-1] - 3, 3))
        jacobian = np.concatenate((still, angular), axis=-2)
        v = v + solve_one_minus(per_matrix(h) * jacobian, h * a)
        return motion.retract(q, h * v), v

    @property
    def is_plain(self) -> bool:
        """Whether all factors are fractions, as they are written by mistake."""
        return all(is_fraction(k) for k in self.factors)

    def judged(self, run: KeptRun) -> NDArray[np.bool_]:
        """(n - 1,): intervals in which rounding does not hide by which Jacobian they are stepped.

        The change of omega is known to its size times the conditions of the inertia, by which the
        matrix is rounded, and of that matrix.
        """
        w, h = run.state.angular_velocity, run.sweep.timestep
        matrix = np.eye(3) - h * (self.terms(run.system, w[:-1]) @ np.array(self.factors))
        condition = np.linalg.cond(moving_inertia(run.system)) * np.linalg.cond(matrix)
        return np.asarray(EPS * condition * norm(w[1:] - w[:-1]) <= run.bounds["omega"])

    def makes(self, name: str, run: KeptRun) -> bool:
        """Whether its steps lead from every sample to the next, where this can be judged."""

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            return self.step(run.system, motion, q, v, h)

        own = SchemeOf(replace(SCHEMES[name], step=step), "com-world")
        good = run.sound(own) | ~self.judged(run)
        return bool(np.all(good) or np.all(good | run.sound_but_for_rounding(own)))

    def shows(self, by: SchemeOf, runs: Sequence[KeptRun]) -> bool:
        """Whether there are intervals that are judged and not the scheme's."""
        found = (np.count_nonzero(self.judged(run) & ~run.sound(by)) for run in runs)
        return int(sum(found)) >= LEAST

    def text(self, own: Sequence[float]) -> str:
        """What is wrong in it, beside the factors of a scheme."""
        if self.place:
            return f"its Jacobian is taken at {PLACES[self.place]}"
        if self.forms == ("T", "T"):
            return "its Jacobian is transposed"
        pairs = zip(self.factors, own, strict=True)
        if len({k for k, due in pairs if due}) == 1 and len(set(own)) == 1 and self.factors != own:
            return f"its Jacobian is {fraction(self.factors[0])} times what it should be"
        if self.factors[0] == self.factors[1] != own[0] == own[1] and self.factors[2] == own[2]:
            what = "the derivative of the gyroscopic term"
            return f"in its Jacobian {what} {_factor(self.factors[0])}"
        found = [
            f"{term} {FORMS[how]}" for term, how in zip(TERMS, self.forms, strict=False) if how
        ]
        for term, k, due in zip(TERMS, self.factors, own, strict=True):
            found += [f"{term} {_factor(k)}"] if k != due else []
        return f"in its Jacobian {listed(found)}"


def _factor(k: float) -> str:
    known = {0.0: "is missing", -1.0: "has the wrong sign", 2.0: "is doubled"}
    return known.get(k, f"has the factor {fraction(k)}")


def _formed(term: Array, back: Array, how: str) -> Array:
    """A term of the torque's Jacobian by I^-1, in one of FORMS."""
    whole = term if how == "I" else term @ back if how == "S" else back @ term
    return np.swapaxes(whole, -1, -2) if how == "T" else whole
