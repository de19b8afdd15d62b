"""The cases of `check` with everything that judging an engine on them needs, worked out once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice

import numpy as np

from omegadot.adapters.exact.adapter import ExactAdapter
from omegadot.adapters.protocol import Integrator
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.features import features_of
from omegadot.gates.case import Case, Sweep
from omegadot.gates.states.equation import EvaluationStates, evaluation_states_of
from omegadot.gates.truth import Truth, scheme_key
from omegadot.harness.arguments import case_of, scenarios_of
from omegadot.harness.drive import Driver
from omegadot.harness.in_process import driver_of
from omegadot.harness.random_cases import random_case
from omegadot.harness.requests.truth_requests import case_companions, case_truth

MOST_DRAWN = 1000  # for each case that is wanted: rarer features are as good as none


@dataclass(frozen=True)
class Prepared:
    """A case with its exact trajectory and its evaluation states."""

    case: Case
    truth: Truth
    evaluation_states: EvaluationStates


class Pool:
    """The built-in scenarios, and random cases of one seed, in order; solved when first wanted.

    caught_on_built_in, over_reference: what was found out of faults: by name and engine, the
    built-in scenario that catches it, and by name, whether each random system does over the
    reference.
    """

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self._exact: Driver = driver_of("exact", ExactAdapter())
        self._reference: Driver = driver_of("reference", ReferenceAdapter())
        self._drawn: list[tuple[Case, frozenset[str]]] = []
        self._prepared: dict[int, Prepared] = {}
        self._built_in: list[Prepared] = []
        self.caught_on_built_in: dict[tuple[str, str], str] = {}
        self.over_reference: dict[str, list[bool]] = {}

    def _draw(self, index: int) -> tuple[Case, frozenset[str]]:
        while len(self._drawn) <= index:
            case = random_case(self.seed, len(self._drawn))
            self._drawn.append((case, features_of(case)))
        return self._drawn[index]

    def _solved(self, case: Case) -> Prepared:
        """Raises RuntimeError where it has no exact trajectory."""
        with np.errstate(all="ignore"):  # growth may overflow, and is infinite then
            truth = case_truth(self._exact, case)
        if isinstance(truth, str):
            raise RuntimeError(f"{case.name}: {truth}")
        return Prepared(case, truth, evaluation_states_of(case, truth, self.seed))

    def prepare(self, index: int) -> Prepared:
        """The case of this number, solved. Raises RuntimeError where it has no exact trajectory."""
        if index not in self._prepared:
            self._prepared[index] = self._solved(self._draw(index)[0])
        return self._prepared[index]

    def first(self, count: int) -> list[Prepared]:
        """The first random cases."""
        return [self.prepare(index) for index in range(count)]

    def another(self) -> Case:
        """A random case that engines may have seen before those that they are judged on."""
        return random_case(self.seed, MOST_DRAWN)

    def built_in(self) -> list[Prepared]:
        """The built-in scenarios."""
        if not self._built_in:
            self._built_in = [self._solved(case_of(one, ())) for one in scenarios_of(())]
        return self._built_in

    def drawn(self, index: int) -> Case:
        """The case of this number."""
        return self._draw(index)[0]

    def having(self, needs: Iterable[str], count: int) -> list[int]:
        """The numbers of the first `count` cases with all of these features."""
        wanted, tried = frozenset(needs), range(MOST_DRAWN * count)
        return list(islice((n for n in tried if wanted <= self._draw(n)[1]), count))

    def step_companions(
        self, prepared: Prepared, integrators: Iterable[Integrator], sweeps: Iterable[Sweep]
    ) -> None:
        """Have the reference step the schemes that these integrators declare, with these steps."""
        truth, case = prepared.truth, prepared.case
        named = {scheme_key(integrator, case.system) for integrator in integrators}
        for key in sorted((key for key in named if key), key=str):
            missing = [s for s in sweeps if (key, s.timestep) not in truth.companions]
            if missing:
                found = case_companions(self._reference, case, truth, [key], missing)
                truth.companions.update(found)
