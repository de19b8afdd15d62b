"""Random cases with everything that judging an engine on them needs, each worked out once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice

from omegadot.adapters.exact.adapter import ExactAdapter
from omegadot.adapters.protocol import Integrator
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.gates.case import Case
from omegadot.gates.equation import EvaluationStates, evaluation_states_of
from omegadot.gates.truth import Truth, scheme_key
from omegadot.harness.drive import Driver
from omegadot.harness.in_process import driver_of
from omegadot.harness.random_cases import features_of, random_case
from omegadot.harness.truth_requests import case_companions, case_truth

MOST_DRAWN = 1000  # for each case that is wanted: rarer features are as good as none


@dataclass(frozen=True)
class Prepared:
    """A case with its exact trajectory and its evaluation states."""

    case: Case
    truth: Truth
    evaluation_states: EvaluationStates


class Pool:
    """Random cases of one seed, in order, drawn and solved when they are first wanted."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self._exact: Driver = driver_of("exact", ExactAdapter())
        self._reference: Driver = driver_of("reference", ReferenceAdapter())
        self._drawn: list[tuple[Case, frozenset[str]]] = []
        self._prepared: dict[int, Prepared] = {}

    def _draw(self, index: int) -> tuple[Case, frozenset[str]]:
        while len(self._drawn) <= index:
            case = random_case(self.seed, len(self._drawn))
            self._drawn.append((case, features_of(case)))
        return self._drawn[index]

    def prepare(self, index: int) -> Prepared:
        """The case of this number, solved. Raises RuntimeError where it has no exact trajectory."""
        if index not in self._prepared:
            case, _ = self._draw(index)
            truth = case_truth(self._exact, case)
            if isinstance(truth, str):
                raise RuntimeError(f"{case.name}: {truth}")
            evaluation_states = evaluation_states_of(case, truth, self.seed)
            self._prepared[index] = Prepared(case, truth, evaluation_states)
        return self._prepared[index]

    def having(self, needs: Iterable[str], count: int) -> list[int]:
        """The numbers of the first `count` cases with all of these features."""
        wanted, tried = frozenset(needs), range(MOST_DRAWN * count)
        return list(islice((n for n in tried if wanted <= self._draw(n)[1]), count))

    def step_companions(self, prepared: Prepared, integrators: Iterable[Integrator]) -> None:
        """Have the reference step the schemes that these integrators declare."""
        truth, case = prepared.truth, prepared.case
        named = {scheme_key(integrator, case.system) for integrator in integrators}
        known = {key for key, _ in truth.companions}
        missing = sorted((key for key in named - known if key), key=str)
        if missing:
            found = case_companions(self._reference, case, truth, missing, case.sweeps)
            truth.companions.update(found)
