"""Further requests to an integrator: first steps, and restarts of unknown schemes."""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.roundings import PLAIN, Roundings, roundings_per_step
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case, Sweep
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.steps import restart, vanishing_step
from omegadot.gates.steps.accuracy import finest_of, tolerated_by
from omegadot.gates.steps.limits import roundings_of
from omegadot.gates.steps.probe import probe_of
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult, Driver
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State, System


def probe_steps(
    driver: Driver, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> None:
    """Have integrators take first steps, and unknown schemes restart runs, into `result`.

    A known scheme's runs are held against the reference's, which depend on nothing else.
    """
    for integrator in result.integrators:
        sweeps, eps = case.sweeps_of(integrator), eps_of(result.precision)
        runs = {s: result.runs.get((integrator.name, s.knob)) for s in sweeps}
        if not any(run is not None and run.ok for run in runs.values()):
            continue
        probe = probe_of(case.system, evaluation_states, eps)
        finest = finest_of(integrator) if integrator.knob == "accuracy" else None
        how = {"integrator": integrator.name, "accuracy": finest}
        answer = driver.request(case, "first_steps", **how, **vars(probe))
        result.first_steps[integrator.name] = (probe, answer)
        # A known scheme's run is the reference's; steps of the integrator's own may be others.
        again = integrator.scheme not in SCHEMES and integrator.knob == "timestep"
        for sweep, run in runs.items() if again else ():
            found = restart.restart_of(sweep, sweeps[0])
            if found and run is not None and run.ok and len(run.result["time"]) == len(sweep.times):
                sample, left = found
                start = State(**run.result["state"])[sample]
                answer = driver.run(case, integrator.name, left, start)
                result.restarts[integrator.name, sweep.timestep] = (sample, left, answer)


def roundings_in(system: System, result: CaseResult, integrator: Integrator) -> Roundings:
    """What the steps of an integrator round, as its declared orders and its first steps show."""
    orders = (order for order in integrator.orders.values() if order is not None)
    known = integrator.scheme in SCHEMES or integrator.knob == "accuracy"
    per_step = PLAIN.per_step if known else roundings_per_step(max(orders, default=0))
    probe, answer = result.first_steps.get(integrator.name, (None, None))
    if probe is None or answer is None or not answer.ok:
        return Roundings(per_step=per_step)
    with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
        stepped, eps = State(**answer.result), eps_of(result.precision)
        return roundings_of(system, probe, stepped, eps, per_step)


def rows_of_probes(
    truth: Truth, integrator: Integrator, sweep: Sweep, result: CaseResult
) -> list[Row]:
    """The rows of these answers for one run; none where they were not requested, or failed."""
    found = []
    probe, steps = result.first_steps.get(integrator.name, (None, None))
    if probe is not None and steps is not None and steps.ok:
        own, tolerated = truth.yardstick, tolerated_by(integrator)
        stepped = State(**steps.result)
        known = integrator.scheme in SCHEMES
        how = (own.eps, tolerated, known, own.roundings)
        found += vanishing_step.rows(own.system, probe, stepped, *how)
    sample, left, restarted = result.restarts.get((integrator.name, sweep.knob), (0, sweep, None))
    if restarted is not None and restarted.ok:
        state = State(**result.runs[integrator.name, sweep.knob].result["state"])
        rest = State(**restarted.result["state"])
        if len(rest.angular_velocity) == len(left.times):
            found.append(restart.row(truth, integrator, sweep, state, sample, rest))
        else:
            found.append(restart.refused("it has another number of samples"))
    elif restarted is not None and restarted.outcome == "raised":
        found.append(restart.refused(restarted.reason))
    return found
