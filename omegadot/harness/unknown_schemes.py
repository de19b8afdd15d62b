"""Further requests to an integrator whose steps the reference has no run of."""

from __future__ import annotations

from omegadot.adapters.protocol import Integrator
from omegadot.gates import restart, vanishing_step
from omegadot.gates.accuracy import finest_of, tolerated_by
from omegadot.gates.case import Case, Sweep
from omegadot.gates.equation import EvaluationStates
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult, Driver
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State


def probe_unknown_schemes(
    driver: Driver, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> None:
    """Have unknown schemes take first steps, and begin their runs again, into `result`."""
    for integrator in result.integrators:
        if integrator.scheme in SCHEMES and integrator.knob == "timestep":
            continue  # the reference has a run to hold its steps against
        sweeps = case.sweeps_of(integrator)
        runs = {s: result.runs.get((integrator.name, s.knob)) for s in sweeps}
        if not any(run is not None and run.ok for run in runs.values()):
            continue
        probe = vanishing_step.probe_of(case.system, evaluation_states)
        finest = finest_of(integrator) if integrator.knob == "accuracy" else None
        how = {"integrator": integrator.name, "accuracy": finest}
        answer = driver.request(case, "first_steps", **how, **vars(probe))
        result.first_steps[integrator.name] = (probe, answer)
        if integrator.knob == "accuracy":
            continue  # how a run is restarted is a matter of its tolerance
        for sweep, run in runs.items():
            found = restart.restart_of(sweep)
            if found and run is not None and run.ok and len(run.result["time"]) == len(sweep.times):
                sample, left = found
                start = State(**run.result["state"])[sample]
                answer = driver.run(case, integrator.name, left, start)
                result.restarts[integrator.name, sweep.timestep] = (sample, answer)


def rows_of_unknown(
    truth: Truth, integrator: Integrator, sweep: Sweep, result: CaseResult
) -> list[Row]:
    """The rows of these answers for one run; none where they were not requested, or failed."""
    found = []
    probe, steps = result.first_steps.get(integrator.name, (None, None))
    if probe is not None and steps is not None and steps.ok:
        system, tolerated = truth.yardstick.system, tolerated_by(integrator)
        found += vanishing_step.rows(system, probe, State(**steps.result), tolerated)
    sample, restarted = result.restarts.get((integrator.name, sweep.knob), (0, None))
    if restarted is not None and restarted.ok:
        state = State(**result.runs[integrator.name, sweep.knob].result["state"])
        rest = State(**restarted.result["state"])
        if len(rest.angular_velocity) == len(sweep.times) - sample:
            found.append(restart.row(truth, integrator, sweep, state, sample, rest))
        else:
            found.append(restart.refused("it has another number of samples"))
    elif restarted is not None and restarted.outcome == "raised":
        found.append(restart.refused(restarted.reason))
    return found
