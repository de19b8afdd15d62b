"""A cause that acts in some batches of states alone, or at some of their places."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import (
    ALONG,
    BEYOND_ROUNDING,
    FORWARD,
    INVERSE,
    Evidence,
)
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.wrong_equation import equation_causes
from omegadot.diagnosis.experiments.asked import Asked
from omegadot.diagnosis.experiments.batch_patterns import ALONE
from omegadot.diagnosis.experiments.batches import Batches, together
from omegadot.diagnosis.experiments.conditioned import conditioned
from omegadot.diagnosis.wording.kinds import is_named, kind_of
from omegadot.gates.case import Case
from omegadot.reference_impl.system import Acceleration, State

OF_BATCHES = "requested together"  # in a cause that is of these already
LEAST, MOST_SIZE = 12, 200  # states of each scenario on which a cause in some batches is looked for


@dataclass(frozen=True)
class InBatches:
    """condition: in which batches.  size: one of which every state shows it; 0 for none."""

    condition: str = ""
    size: int = 0

    def of(self, text: str) -> str:
        """A cause on this condition; as it is without one."""
        return conditioned(text, self.condition)


def in_batches(
    asked: Asked, case: Case, scene: Scene, sources: Sequence[str], alone: bool
) -> InBatches:
    """By requests of states that show a fault. alone: the first does, requested by itself."""
    for source in sources:
        evidence = scene.evidence.get(source)
        if evidence is None or not evidence.finite:
            continue
        wrong = np.flatnonzero(evidence.shares(evidence.true) > BEYOND_ROUNDING)
        batches = Batches(asked, case, evidence, np.zeros(1, dtype=np.intp) if alone else wrong)
        if len(batches.shows):
            found = batches.condition()
            every = [n for n, flags in batches.seen.items() if np.all(flags) and n <= MOST_SIZE]
            return InBatches(found, max(every, default=0) if found else 0)
    return InBatches()


def is_of_batches(text: str) -> bool:
    """Whether a cause is one in the place among others already."""
    return OF_BATCHES in kind_of(text)


def in_small_batches(
    asked: Asked, cases: Mapping[str, Case], scenes: Mapping[str, Scene], found: InBatches
) -> Across:
    """The equations of all scenarios as they are answered in batches that show the fault."""
    across = Across()
    for name, scene in scenes.items():
        evidence = scene.evidence.get(FORWARD)
        if evidence is None or name not in cases or not evidence.finite:
            continue
        count = max(1, -(-LEAST // found.size))
        places = np.arange(count * found.size, dtype=np.intp) % len(evidence.sound)
        parts = [together(asked, cases[name], evidence, own) for own in np.split(places, count)]
        known = [one for one in parts if one is not None]
        if len(known) == count:
            across.add(Scene(scene.name, scene.system, scene.features, {FORWARD: _joined(known)}))
    return across


def alone_text(text: str, across: Across | None, name: str, found: InBatches) -> str:
    """What is wrong in these batches, where others are right; text: where nothing is known."""
    causes = equation_causes(across, name, FORWARD) if across and name in across.scenes else []
    cause = "; ".join(causes)
    if is_named(cause):
        return conditioned(cause, found.condition)
    if found.condition in ("", ALONE):
        return text
    return f"the equation is wrong only where {found.condition}"


def sources_of(torque: bool) -> tuple[str, ...]:
    """Of which answers, of inverse dynamics or of forward dynamics."""
    return (INVERSE,) if torque else (FORWARD, ALONG)


def _joined(parts: Sequence[Evidence]) -> Evidence:
    first = parts[0]
    states = State(
        *(
            np.concatenate(own)
            for own in zip(*(vars(e.states).values() for e in parts), strict=True)
        )
    )
    angular, linear = (
        np.concatenate([getattr(e.found, name) for e in parts]) for name in ("angular", "linear")
    )
    bound = np.concatenate([e.angular_bound for e in parts])
    of_linear = np.concatenate([e.linear_bound for e in parts])
    found = Acceleration(angular, linear)
    return Evidence(FORWARD, first.system, states, found, bound, of_linear, first.eps)
