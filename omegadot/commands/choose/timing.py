"""What a step costs: engine after engine, round after round, nothing else running meanwhile."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from omegadot.commands.choose.candidate import Candidate
from omegadot.commands.choose.ranking import Spread
from omegadot.commands.choose.trial import Trial
from omegadot.gates.case import Case, Sweep
from omegadot.harness.drive import Driver

FEWEST_ROUNDS, MOST_ROUNDS = 7, 15
SECONDS_A_RUN = 0.15  # so short that a round sees every engine in the same weather
SECONDS_IN_ALL = 8.0
Key = tuple[str, str]


@dataclass(frozen=True)
class Timed:
    """What is to be timed: a candidate of a case at the step of one of its runs."""

    case: Case
    candidate: Candidate
    trial: Trial

    def sweep(self) -> Sweep:
        """The horizon, or as much of it as takes a moment; the ends alone are kept."""
        moment = max(1, round(SECONDS_A_RUN / max(self.trial.seconds_per_step, 1e-9)))
        steps = min(self.trial.steps, moment)
        return Sweep(self.trial.timestep, steps, steps)


def rounds_for(wanted: Sequence[Timed]) -> int:
    """As many as there is time for, within the fewest and the most."""
    one = sum(timed.sweep().steps * timed.trial.seconds_per_step for timed in wanted)
    return int(min(max(SECONDS_IN_ALL / max(one, 1e-9), FEWEST_ROUNDS), MOST_ROUNDS))


def time_all(wanted: Mapping[Key, Timed], driver_of: Mapping[str, Driver]) -> dict[Key, Spread]:
    """Seconds per step of each, from interleaved repeats after a round that is not counted.

    By names of case and candidate. A candidate that fails to answer in any round is left out.
    """
    found: dict[Key, list[float]] = {key: [] for key in wanted}
    rounds = rounds_for(list(wanted.values()))
    for number in range(rounds + 1):
        for key, timed in wanted.items():
            driver = driver_of[timed.candidate.engine.name]
            answer = driver.run(timed.case, timed.candidate.integrator.name, timed.sweep())
            if answer.ok and number:
                found[key].append(float(answer.result["seconds_per_step"]))
    return {key: Spread(tuple(found[key])) for key in found if len(found[key]) == rounds}
