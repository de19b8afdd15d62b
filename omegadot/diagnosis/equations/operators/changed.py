"""One operator on one operand: whether it is an engine's equation, and with which numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.evidence import SCREENED, SLACK, Evidence
from omegadot.diagnosis.equations.operators.numbered import with_numbers
from omegadot.diagnosis.equations.operators.operands import Operand, acting
from omegadot.diagnosis.equations.operators.operator import Operator, Seen
from omegadot.diagnosis.equations.operators.plain import flips, of_quaternions, of_vectors
from omegadot.reference_impl.system import Acceleration, Array, System

TRIES = 6
DELTA = 1e-6
VECTORS, QUATERNIONS, NUMBERS = tuple(of_vectors()), tuple(of_quaternions()), with_numbers()
FLIPS = tuple(flips())
NONE = np.zeros(0)
OFTEN = 3  # states at which a change must show


@dataclass(frozen=True)
class Changed:
    """One vector of the right equation, changed."""

    operand: Operand
    operator: Operator

    @property
    def name(self) -> str:
        """What it is, whatever the numbers."""
        return self.operator.text(self.operand.name, "", np.ones(2))

    def text(self, _: System, p: Array) -> str:
        """The cause, with its numbers."""
        return self.operator.text(self.operand.name, self.operand.unit, p)

    def made(self, evidence: Evidence, p: Array) -> Acceleration:
        """The accelerations with these numbers."""
        due = self.operand.of(evidence)
        return self.operand.put(evidence, self.operator.change(due, evidence.states, p))

    def fit(self, evidence: Evidence) -> Array | None:
        """The numbers with which this is the engine's equation; None where none are."""
        guess: Array = NONE
        if self.operator.guess is not None:
            found = self.operator.guess(_seen(evidence, self.operand))
            if found is None or not np.all(np.isfinite(found)):
                return None
            guess = found
        p = self._numbers(evidence, guess)
        return p if p is not None and self._shows(evidence, p) else None

    def _shows(self, evidence: Evidence, p: Array) -> bool:
        """Whether it changes more states than the one or two that anything may change."""
        changed = evidence.shares_between(self.made(evidence, p), evidence.true) > SLACK
        return int(np.count_nonzero(changed)) >= OFTEN

    def _numbers(self, evidence: Evidence, p: Array) -> Array | None:
        for _ in range(TRIES):
            here = self.made(evidence, p)
            if evidence.fits(here):
                return p
            if len(p) != 1 or not p[0] > 0.0:
                return None
            rest = evidence.weighted(evidence.found, here)
            line = evidence.weighted(self.made(evidence, p * (1.0 + DELTA)), here) / (p[0] * DELTA)
            size = float(line @ line)
            if not size > 0.0 or not np.isfinite(size):
                return None
            p = p + float(line @ rest) / size
        return None


def _seen(evidence: Evidence, operand: Operand) -> Seen:
    came = None if operand.came is None else operand.came(evidence)
    linear = operand.unit == "m/s^2"
    bound = evidence.linear_bound if linear else evidence.angular_bound
    return Seen(operand.of(evidence), came, evidence.states, evidence.sound, bound)


def changed_vectors(evidence: Evidence, steps: bool) -> list[tuple[Changed, Array]]:
    """All that are the engine's equation, with their numbers.

    steps: the evidence is of steps, each of which begins at one state alone.
    """
    found = list[tuple[Changed, Array]]()
    places = np.linspace(0, len(evidence.sound) - 1, SCREENED).round().astype(int)
    few = evidence.at(places)
    for operand in acting(evidence):
        if operand.reported and (steps or evidence.system.load.pivot is None):
            continue  # on a free body it is the same as omega-dot
        inputs = FLIPS if operand.came is None and operand.unit and not operand.rounded else ()
        plain = [
            one
            for one in (*(QUATERNIONS if operand.unit == "" else VECTORS), *inputs)
            if not (steps and one.among) and (one.turns or not operand.constant)
            if one.rounds or not operand.rounded or (one.among and operand.among)
        ]
        due = operand.of(evidence)
        lanes = np.stack([one.change(due, evidence.states, NONE)[places] for one in plain])
        close = np.all(few.shares(operand.put(few, lanes)) <= SLACK, axis=-1)
        close &= np.any(lanes, axis=(-1, -2))  # what leaves nothing is missing
        likely = [one for one, good in zip(plain, close, strict=True) if good]
        numbered = operand.unit and not (operand.constant or operand.rounded)
        likely += NUMBERS if numbered else ()
        fitted = [(one, one.fit(evidence)) for one in (Changed(operand, x) for x in likely)]
        found += [(one, p) for one, p in fitted if p is not None]
    return found
