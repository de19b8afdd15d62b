"""First steps of the same system with one thing the other way, where steps alone are wrong.

No gate judges them; see `harness.requests.opposite`.
"""

from __future__ import annotations

from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.steps import vanishing_step
from omegadot.gates.steps.accuracy import finest_of, tolerated_by
from omegadot.gates.steps.probe import probe_at
from omegadot.harness.drive import CaseResult, Driver
from omegadot.harness.requests.opposite import opposite_cases
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import State

STATES = 4  # each of many steps; what fits so many was found at three times as many


def request_opposite_steps(driver: Driver, case: Case, result: CaseResult) -> None:
    """Into `result`, of every integrator whose steps follow another equation as they vanish."""
    eps = eps_of(result.precision)
    for integrator in result.integrators:
        probe, answer = result.first_steps.get(integrator.name, (None, None))
        if probe is None or answer is None or not answer.ok:
            continue
        tolerated = tolerated_by(integrator)
        rows = vanishing_step.rows(case.system, probe, State(**answer.result), eps, tolerated)
        if all(row.verdict != "fail" for row in rows):
            continue
        finest = finest_of(integrator) if integrator.knob == "accuracy" else None
        how = {"integrator": integrator.name, "accuracy": finest}
        for what, other in opposite_cases(case):
            few = probe_at(other.system, place_on_pivot(other.system, probe.states[:STATES]), eps)
            steps = driver.request(other, "first_steps", **how, **vars(few))
            result.opposite_steps[integrator.name, what] = (other.system, few, steps)
