"""One torque that is solved for by another matrix than the rest: ``I^-1 (tau - t) + A t``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.evidence import INVERSE, INVERTED, SLACK, Evidence
from omegadot.diagnosis.equations.operators.operands import gyroscopic, loads, turned
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia, parallel_axis
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

NONE = np.zeros(0)
OFTEN = 3  # states at which it must show
GYROSCOPIC, LOADS = "the gyroscopic term", "the torque of all loads"

TORQUES: dict[str, Callable[[System, State], Array]] = {
    GYROSCOPIC: gyroscopic,
    "the torque in body axes": lambda s, x: s.load.torque_body + 0.0 * x.angular_velocity,
    "the torque in world axes": lambda s, x: rotate_inverse(x.orientation, s.load.torque_world),
    "the applied torque": lambda s, x: applied_torque(s, x) + 0.0 * x.angular_velocity,
    "the damping torque": damping_torque,
    "the torque of gravity": gravity_torque,
    LOADS: loads,
}


def _own(system: System) -> Array:
    return np.asarray(system.body.inertia, dtype=float)


def _whole(system: System) -> Array:
    return np.asarray(moving_inertia(system), dtype=float)


def _of_origin(system: System) -> Array:
    center = np.asarray(system.body.center_of_mass, dtype=float)
    return np.asarray(_own(system) + parallel_axis(float(system.body.mass), center))


def _diagonal(tensor: Array) -> Array:
    return np.diag(np.diag(tensor))


def _without_signs(tensor: Array) -> Array:
    return 2.0 * _diagonal(tensor) - tensor


TENSORS: dict[str, Callable[[System], Array]] = {
    "the inertia's diagonal alone": lambda s: _diagonal(_whole(s)),
    "the inertia about the centre of mass": _own,
    "the diagonal of the inertia about the centre of mass": lambda s: _diagonal(_own(s)),
    "the inertia about the body's origin": _of_origin,
    "the inertia with its products' signs wrong": lambda s: _without_signs(_whole(s)),
    "the mean of the moments of inertia": lambda s: np.trace(_whole(s)) / 3.0 * np.eye(3),
    "the largest moment of inertia": lambda s: np.max(np.diag(_whole(s))) * np.eye(3),
}
OTHERS: dict[str, Callable[[System], Array]] = {
    **{
        f"is divided by {name}": lambda s, of=of: np.linalg.inv(of(s))  # type: ignore[misc]
        for name, of in TENSORS.items()
    },
    "is not divided by the inertia": lambda s: np.eye(3),
    "is divided by the mass in place of the inertia": lambda s: np.eye(3) / float(s.body.mass),
    "is multiplied by the inertia, not by its inverse": _whole,
    "is divided by the inertia twice": lambda s: np.linalg.inv(_whole(s) @ _whole(s)),
    "is multiplied by the diagonal alone of the inertia's inverse": lambda s: _diagonal(
        np.linalg.inv(_whole(s))
    ),
}
# A gyroscopic term whose momentum is by the tensor as well that it is divided by.
FORMED = ("the inertia's diagonal alone", "the inertia about the centre of mass")


@dataclass(frozen=True)
class Apart:
    """One torque by its own matrix; nothing is fitted.

    of: which it is.  does: what is made of it.  torque: (n, 3) N m, what acts.  matrix: (3, 3),
    what makes omega-dot of it.  due: the torque that is right in its place.
    """

    of: str
    does: str
    torque: Callable[[System, State], Array]
    matrix: Callable[[System], Array]
    due: Callable[[System, State], Array]

    @property
    def name(self) -> str:
        """What it is."""
        return f"{self.of} {self.does}"

    def text(self, _: System, p: Array) -> str:
        """The cause."""
        return self.name

    def made(self, evidence: Evidence, p: Array) -> Acceleration:
        """The accelerations."""
        system, states = evidence.system, evidence.states
        own = apply(self.matrix(system), self.torque(system, states))
        due = apply(evidence.solve, self.due(system, states))
        return turned(evidence, evidence.true.angular - due + own)

    def fit(self, evidence: Evidence) -> Array | None:
        """No number where this is the engine's equation; None where it is not."""
        try:
            made = self.made(evidence, NONE)
        except np.linalg.LinAlgError:  # a diagonal may have a zero
            return None
        if not evidence.fits(made):
            return None
        changed = evidence.shares_between(made, evidence.true) > SLACK
        return NONE if int(np.count_nonzero(changed)) >= OFTEN else None


def _every() -> Iterator[Apart]:
    for what, of in TORQUES.items():
        for text, matrix in OTHERS.items():
            yield Apart(what, text, of, matrix, of)
    for name in FORMED:
        tensor = TENSORS[name]

        def formed(s: System, x: State, tensor: Callable[[System], Array] = tensor) -> Array:
            w = x.angular_velocity
            return np.asarray(-cross(w, apply(tensor(s), w)))

        matrix = OTHERS[f"is divided by {name}"]
        yield Apart(
            GYROSCOPIC, f"is formed with, and divided by, {name}", formed, matrix, gyroscopic
        )


EVERY = tuple(_every())


def solved_apart(evidence: Evidence, together: bool = False) -> list[tuple[Apart, Array]]:
    """All that are the engine's equation; of torques that are the same here the plainest.

    together: that of several loads alone, where more than one acts; else all others. Inverse
    dynamics solve for nothing.
    """
    if evidence.source in (INVERSE, INVERTED):
        return []
    found, seen = list[tuple[Apart, Array]](), dict[bytes, Callable[[System, State], Array]]()
    for one in EVERY:
        due = np.asarray(one.due(evidence.system, evidence.states)) + 0.0  # no zero has a sign
        if not np.any(due) or seen.setdefault(due.tobytes(), one.due) is not one.due:
            continue
        p = one.fit(evidence) if (one.of == LOADS) == together else None
        if p is not None:
            found.append((one, p))
    return found
