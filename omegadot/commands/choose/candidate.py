"""One engine with one integrator on one case: its runs, and the steps that meet the limits."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from omegadot.adapters.protocol import Integrator
from omegadot.commands.choose.ruler import CHANNELS, NoTruthError, Ruler
from omegadot.commands.choose.search import Edge, Search, Trials, edge_of, order_between
from omegadot.commands.choose.trial import Row, Trial
from omegadot.diagnosis.reported.clock import clock_cause
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Sweep
from omegadot.gates.runs import trajectory
from omegadot.gates.steps.accuracy import finest_of, order_of, steps_per_radian
from omegadot.harness.drive import Driver
from omegadot.harness.plan import Engine
from omegadot.reference_impl.system import State

LARGEST_TURN = math.pi  # rad a step; beyond half a turn attitudes cannot be distinguished
FEWEST_STEPS = 2
UNDECLARED = 2.0  # the order to begin with where none is declared
MOST_RECHECKS = 8
LIKE = (0.75, 1.35)  # an order within these of the declared one is trusted to go on
COARSEST, MIDDLE = 0.1, 1e-6  # accuracies: the coarsest that is tried, and the first
NOMINAL = 64  # steps in place of one, so that neighbouring accuracies are a few per cent apart
Limits = Mapping[str, float]


class BrokenError(Exception):
    """The engine failed to answer. outcome: one of the record's; the message: the reason."""

    def __init__(self, outcome: str, reason: str) -> None:
        super().__init__(reason)
        self.outcome = outcome


@dataclass
class Candidate:
    """What was found out about an engine's integrator, run by run.

    budget: s that one run may take.  edge: for the limits.  variants: by requirement and factor,
    the edge for that limit multiplied.
    """

    engine: Engine
    integrator: Integrator
    driver: Driver
    ruler: Ruler
    budget: float
    trials: Trials = field(default_factory=dict)
    edge: Edge = field(default_factory=lambda: Edge(None, None))
    variants: dict[tuple[str, float], Edge] = field(default_factory=dict)
    outcome: str = "ok"
    reason: str = ""

    @property
    def name(self) -> str:
        """Engine and integrator, as the command line takes them."""
        return f"{self.engine.name}:{self.integrator.name}"

    def declared_order(self, limits: Limits) -> float:
        """The lowest order that is declared in the channels requested."""
        if self.controlled:
            return float(order_of(self.integrator) + 1)
        orders = self.integrator.orders
        found = [orders[c] for key in limits if (c := CHANNELS.get(key, "omega")) in orders]
        return float(min(found, default=UNDECLARED))

    @property
    def controlled(self) -> bool:
        """Whether an accuracy is sought in place of a step."""
        return self.integrator.knob == "accuracy"

    def accuracy_of(self, steps: int) -> float:
        """The accuracy for which an integrator of order p takes about ``steps / 64`` of its own:
        ``(64 radians / steps)^(p+1)``.
        """
        return max(
            finest_of(self.integrator), (self._radians / steps) ** (order_of(self.integrator) + 1)
        )

    def steps_at(self, accuracy: float) -> int:
        """The inverse of `accuracy_of`."""
        return math.ceil(self._radians * steps_per_radian(self.integrator, accuracy))

    @property
    def _radians(self) -> float:
        return NOMINAL * max(1.0, self.ruler.yardstick.rate * self.ruler.duration)

    def nearest(self, limits: Limits) -> Trial | None:
        """The run that came nearest to meeting every limit; the larger step where two are equal."""
        trials = self.trials.values()
        return min(trials, key=lambda t: (t.ratio(limits), t.steps), default=None)

    def predicted(self, limits: Limits) -> Row | None:
        """Where the order states the limits would be met: a guess, not a verdict.

        order: that of the two finest runs, or the declared one where there is but one.  seconds:
        what one such run would take. It lies beyond the search's budget.
        """
        if self.controlled:
            return None
        trials = sorted(self.trials.values(), key=lambda t: t.steps)
        order, declared = None, self.declared_order(limits)
        if len(trials) > 1:
            order = order_between(trials[-2], trials[-1], limits)
        elif trials and math.isfinite(trials[0].ratio(limits)):
            order = declared
        if order is None or not LIKE[0] * declared <= order <= LIKE[1] * declared:
            return None  # the errors do not shrink at their order yet: the rest cannot be predicted
        finest = trials[-1]
        steps = finest.steps * finest.ratio(limits) ** (1.0 / order)
        timestep = finest.timestep * finest.steps / steps
        return {"timestep": timestep, "order": order, "seconds": steps * finest.seconds_per_step}

    @property
    def fewest_steps(self) -> int:
        """As few steps a horizon as keep each below the turn that attitudes can show."""
        if self.controlled:
            return self.steps_at(COARSEST)
        angle = self.ruler.yardstick.rate * self.ruler.duration
        return max(FEWEST_STEPS, math.ceil(angle / LARGEST_TURN))

    def most_steps(self) -> int:
        """As many as the budget has time for, at the best pace seen: a busy machine is not slow."""
        known = [t.seconds_per_step for t in self.trials.values() if t.seconds_per_step]
        affordable = int(self.budget / min(known)) if known else 0
        most = max(affordable, self.fewest_steps, *(self.trials if known else ()))
        return min(most, self.steps_at(finest_of(self.integrator))) if self.controlled else most

    def sweep(self, steps: int, dense: bool = False) -> Sweep:
        """The horizon in so many steps; samples of an accuracy are as dense as they need be."""
        if not self.controlled:
            return self.ruler.sweep(steps, dense)
        return replace(self.ruler.sweep(self.ruler.samples), accuracy=self.accuracy_of(steps))

    def evaluate(self, steps: int, dense: bool = False) -> Trial:
        """Run the whole horizon in so many steps and measure it. Raises BrokenError."""
        sweep, timestep = self.sweep(steps, dense), self.ruler.duration / steps
        answer = self.driver.run(self.ruler.case, self.integrator.name, sweep)
        if answer.outcome == "raised" and any(t.errors for t in self.trials.values()):
            # It works with other steps, so this one is simply too large for it.
            return Trial(steps, timestep, {}, 0.0, 0, sweep.accuracy)
        if not answer.ok:
            raise BrokenError(answer.outcome, answer.reason)
        samples, requested = len(answer.result["time"]), len(sweep.times)
        if samples != requested:
            reason = f"run() gave {samples} samples where {requested} were requested"
            raise BrokenError("raised", reason)
        eps = eps_of(self.engine.description.precision)
        if trajectory.time_row(sweep, answer.result["time"], eps).verdict == "fail":
            text = clock_cause(answer.result["time"], sweep, eps)
            raise BrokenError("raised", f"run() reports other times than requested: {text}")
        errors = self.ruler.errors(sweep, State(**answer.result["state"]))
        seconds = float(answer.result["seconds_per_step"]) * sweep.steps / steps
        return Trial(steps, timestep, errors, seconds, len(sweep.times), sweep.accuracy)

    def seek(self, limits: Limits, factors: Sequence[float]) -> None:
        """Find the largest step, and that for each limit multiplied by each of the factors."""
        # The middle of the scenario's own steps is tried first.
        steps = sorted(sweep.timestep for sweep in self.ruler.case.sweeps)
        start = math.ceil(self.ruler.duration / steps[len(steps) // 2])
        if self.controlled:
            start = self.steps_at(max(MIDDLE, finest_of(self.integrator)))
        start = max(start, self.fewest_steps)
        try:
            self.trials[start] = self.evaluate(start)
            self.edge = self._looked_at_closely(Search.confirmed, limits)
            for key in limits:
                for factor in factors:
                    changed = {**limits, key: limits[key] * factor}
                    edge = self._looked_at_closely(Search.largest_step, changed)
                    self.variants[key, factor] = edge
        except (BrokenError, NoTruthError) as error:
            self.outcome, self.reason = getattr(error, "outcome", "raised"), str(error)

    def _looked_at_closely(self, seek: Callable[[Search], Edge], limits: Limits) -> Edge:
        """What is found, until it passes at every one of its samples too."""
        least, declared = self.fewest_steps, self.declared_order(limits)
        search = Search(self.trials, self.evaluate, limits, least, self.most_steps, declared)
        for _ in range(MOST_RECHECKS):
            found = seek(search).passing
            if found is None or found.samples >= len(self.sweep(found.steps, True).times):
                break
            self.trials[found.steps] = self.evaluate(found.steps, dense=True)
            if self.trials[found.steps].passes(limits):
                break
        return edge_of(self.trials, limits)
