"""Whether a fault shows in an answer: in forward dynamics, in steps, in a state read back."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import (
    BEYOND_ROUNDING,
    SLACK,
    Evidence,
    of_forward_dynamics,
)
from omegadot.diagnosis.experiments.observed import Flags, Trial
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.models.misread_state import would_show
from omegadot.diagnosis.stepping.vanishing.kinematics import shows_in_motion
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.gates.states.model import state_rows
from omegadot.gates.steps.accuracy import finest_of, tolerated_by
from omegadot.gates.steps.probe import probe_at
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import Acceleration, State, System

Shown = tuple[Flags, Flags]  # where a fault shows, and where that is known
MOST = 64  # requests for one fault


def shown_in(evidence: Evidence, one: Candidate | None) -> Shown:
    """By the states of some evidence. one: the cause; None where any difference is the fault.

    Where a cause would show and the engine is neither right nor as the cause has it, nothing is
    known of this fault.
    """
    shares = evidence.shares(evidence.true)
    wrong, right = ~(shares <= BEYOND_ROUNDING), shares <= 1.0
    if one is None:  # what scales omega-dot, or turns it, shows where there is one
        moved = norm(evidence.true.angular) > BEYOND_ROUNDING * evidence.angular_bound
        return wrong, wrong | (right & moved)
    made = one.predicted(evidence)
    if made is None:
        return wrong, np.zeros_like(wrong)
    visible = evidence.shares_between(made, evidence.true) > BEYOND_ROUNDING
    if one.family is None and one.terms is None:
        form = one.form(evidence.system) if one.fixed else None
        slack = SLACK if form is None else evidence.slack_of(form)
        wrong = wrong & (evidence.shares(made) <= slack)
    return wrong, (wrong | right) & visible


def shown_in_steps(steps: VanishingSteps, one: Candidate | None, text: str = "") -> Shown:
    """By the states that steps begin at: of the equation that they follow, or of any rate.

    text: a cause in what attitude and position move by; it shows where it moves them otherwise.
    """
    if one is not None:
        return shown_in(steps.evidence, one)
    with np.errstate(all="ignore"):
        shares = np.max([limit.shares() for limit in steps.rates.values()], axis=0)
    known = ~((shares > 1.0) & (shares <= BEYOND_ROUNDING))
    if text:
        known &= shows_in_motion(steps, text)
    return ~(shares <= BEYOND_ROUNDING), known


@dataclass
class Judge:
    """Has an engine answer for a system in states, and decides where a fault shows.

    case: whose name the systems have, with a number.  left: requests that may still be made.
    at_once: the states that one request takes at little cost.
    """

    driver: Requests
    case: Case
    eps: float
    candidate: Candidate | None = None
    at_once: int = 8
    left: int = MOST
    requests: int = field(default=0, init=False)

    def trial(self, system: System, states: State, base: Trial | None = None) -> Trial | None:
        """What comes of it; None where there is no answer, or no request is left."""
        if self.left <= 0 or self.driver.lost is not None:
            return None
        self.left, self.requests = self.left - 1, self.requests + 1
        name = f"{self.case.name}-experiment-{self.requests}"
        scenario = self.case.scenario.model_copy(update={"name": name})
        placed = place_on_pivot(system, states)
        with np.errstate(all="ignore"):
            shown = self.shown(replace(self.case, scenario=scenario, system=system), placed)
        return None if shown is None else Trial(system, placed, *shown, base)

    @abstractmethod
    def shown(self, case: Case, states: State) -> Shown | None:
        """Where the fault shows; None without an answer."""


class ForwardJudge(Judge):
    """Of forward dynamics."""

    def shown(self, case: Case, states: State) -> Shown | None:
        """By the difference from the equation, or by a cause."""
        answer = self.driver.request(case, "forward", states=states)
        if not answer.ok:
            return None
        found = Acceleration(**answer.result)
        return shown_in(of_forward_dynamics(case.system, states, found, self.eps), self.candidate)


def changes_by_itself(driver: Requests, case: Case, states: State, eps: float) -> bool:
    """Whether omega-dot of the same states is another when it is requested again at once."""
    answers = [driver.request(case, "forward", states=states) for _ in range(2)]
    if not all(answer.ok for answer in answers):
        return False
    one, other = (
        of_forward_dynamics(case.system, states, Acceleration(**answer.result), eps)
        for answer in answers
    )
    apart = norm(one.found.angular - other.found.angular)
    return bool(np.any(apart > BEYOND_ROUNDING * one.angular_bound))


@dataclass
class StepsJudge(Judge):
    """Of the limit of vanishing steps of one integrator. text: see `shown_in_steps`."""

    text: str = ""
    integrator: Integrator = field(default_factory=lambda: Integrator("", None, {}))
    at_once: int = 3

    def shown(self, case: Case, states: State) -> Shown | None:
        """By the rates of the limit, or by a cause of these."""
        one = self.integrator
        finest = finest_of(one) if one.knob == "accuracy" else None
        probe = probe_at(case.system, states, self.eps)
        how = {"integrator": one.name, "accuracy": finest, **vars(probe)}
        answer = self.driver.request(case, "first_steps", **how)
        if not answer.ok:
            return None
        stepped = State(**answer.result)
        steps = vanishing_steps(case.system, probe, stepped, self.eps, tolerated_by(one))
        return shown_in_steps(steps, self.candidate, self.text)


@dataclass
class StateJudge(Judge):
    """Of states that are set and read back, of which a request takes one.

    misreading: the cause, where it is one that shows at some states alone.
    """

    misreading: str = ""
    at_once: int = 1
    left: int = 3 * MOST  # which nothing is stepped or solved for

    def shown(self, case: Case, states: State) -> Shown | None:
        """By the gate's own rows."""
        wrong, known = list[bool](), list[bool]()
        for one in _each(states):
            answer = self.driver.request(case, "model", state=one, before=states[0])
            if not answer.ok:
                return None
            back = State(**answer.result["state"])
            wrong.append(not reads_back(case, one, back, self.eps))
            known.append(shows(self.misreading, case, one, self.eps))
        return np.array(wrong), np.array(known)


def reads_back(case: Case, requested: State, back: State, eps: float) -> bool:
    """Whether a state that was set is what is read back."""
    return all(row.verdict != "fail" for row in state_rows(case, requested, back, eps))


def shows(misreading: str, case: Case, state: State, eps: float) -> bool:
    """Whether the fault would be seen at this state; of an unknown one it is taken to be."""
    return not misreading or would_show(misreading, case, state, eps)


def _each(states: State) -> Iterator[State]:
    for k in range(len(states.angular_velocity)):
        yield states[k]
