"""One engine with one integrator on one case: its runs, and the steps that meet the limits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from omegadot.adapters.protocol import Integrator
from omegadot.commands.choose.ruler import Ruler
from omegadot.commands.choose.search import (
    Edge,
    Range,
    Seeking,
    Trials,
    confirmed,
    edge_of,
    largest_step,
)
from omegadot.commands.choose.trial import Trial
from omegadot.harness.drive import Driver
from omegadot.harness.plan import Engine
from omegadot.reference_impl.system import State

LARGEST_TURN = math.pi  # rad a step; beyond half a turn attitudes cannot be distinguished
FEWEST_STEPS = 2
UNDECLARED = 2.0  # the order to begin with where none is declared
MOST_RECHECKS = 8


class BrokenError(Exception):
    """The engine failed to answer. outcome: one of the record's; the message: the reason."""

    def __init__(self, outcome: str, reason: str) -> None:
        super().__init__(reason)
        self.outcome = outcome


@dataclass
class Candidate:
    """What was found out about an engine's integrator.

    variants: by requirement and factor, the edge for that limit multiplied.
    """

    engine: Engine
    integrator: Integrator
    trials: Trials = field(default_factory=dict)
    edge: Edge = field(default_factory=lambda: Edge(None, None))
    variants: dict[tuple[str, float], Edge] = field(default_factory=dict)
    outcome: str = "ok"
    reason: str = ""

    @property
    def name(self) -> str:
        """Engine and integrator, as the command line takes them."""
        return f"{self.engine.name}:{self.integrator.name}"

    def declared_order(self, limits: Mapping[str, float]) -> float:
        """The lowest order that is declared in the channels requested."""
        orders = self.integrator.orders
        named = {"attitude": "attitude", "energy-drift": "energy"}
        named |= {"momentum-drift": "angular_momentum", "linear-momentum-drift": "linear_momentum"}
        found = [orders[c] for key in limits if (c := named.get(key, "omega")) in orders]
        return float(min(found, default=UNDECLARED))


class Prober:
    """Runs one candidate's integrator. budget: s that one run may take."""

    def __init__(self, driver: Driver, ruler: Ruler, candidate: Candidate, budget: float) -> None:
        self._driver, self._ruler, self._budget = driver, ruler, budget
        self._candidate = candidate
        rate = ruler.yardstick.rate
        half_turns = math.ceil(rate * ruler.duration / LARGEST_TURN)
        self._range = Range(max(FEWEST_STEPS, half_turns), self._most_steps)

    def _most_steps(self) -> int:
        """As many as the budget has time for, at the best pace seen: a busy machine is not slow."""
        known = [t.seconds_per_step for t in self._candidate.trials.values() if t.seconds_per_step]
        if not known:
            return self._range.fewest
        most = int(self._budget / min(known))
        return max(most, self._range.fewest, *self._candidate.trials)

    def evaluate(self, steps: int, dense: bool = False) -> Trial:
        """Run the whole horizon in so many steps and measure it. Raises BrokenError."""
        sweep = self._ruler.sweep(steps, dense)
        name, case = self._candidate.integrator.name, self._ruler.case
        answer = self._driver.run(case, name, sweep)
        if answer.outcome == "raised" and any(t.errors for t in self._candidate.trials.values()):
            # It works with other steps, so this one is simply too large for it.
            return Trial(steps, sweep.timestep, {}, 0.0, 0, answer.outcome, answer.reason)
        if not answer.ok:
            raise BrokenError(answer.outcome, answer.reason)
        state = State(**answer.result["state"])
        errors = self._ruler.errors(sweep, state)
        seconds = float(answer.result["seconds_per_step"])
        return Trial(steps, sweep.timestep, errors, seconds, len(sweep.times))

    def _start(self) -> int:
        """The middle of the scenario's own steps, in steps a horizon."""
        steps = sorted(sweep.timestep for sweep in self._ruler.case.sweeps)
        wanted = math.ceil(self._ruler.duration / steps[len(steps) // 2])
        return max(wanted, self._range.fewest)

    def seek(self, limits: Mapping[str, float]) -> Edge:
        """The largest step, tried at its neighbours and at every one of its samples."""
        trials = self._candidate.trials
        if not trials:
            trials[self._start()] = self.evaluate(self._start())
        return self._looked_at_closely(confirmed, limits)

    def vary(self, limits: Mapping[str, float]) -> Edge:
        """The largest step for other limits, beginning with the runs that were made already."""
        return self._looked_at_closely(largest_step, limits)

    def _looked_at_closely(self, seeking: Seeking, limits: Mapping[str, float]) -> Edge:
        """What is found, until it passes at every one of its samples too."""
        trials, declared = self._candidate.trials, self._candidate.declared_order(limits)
        for _ in range(MOST_RECHECKS):
            found = seeking(trials, self.evaluate, limits, self._range, declared).passing
            if found is None or found.samples >= len(self._ruler.sweep(found.steps, True).times):
                break
            trials[found.steps] = self.evaluate(found.steps, dense=True)
            if trials[found.steps].passes(limits):
                break
        return edge_of(trials, limits)
