"""Finer steps where a sweep is too coarse to show the order of an error."""

from __future__ import annotations

from omegadot.gates.case import Case, Sweep
from omegadot.harness.drive import Driver
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.workers.harness_end.process import Answer

MOST_HALVINGS = 4
Refinements = dict[str, dict[Sweep, tuple[Sweep, Answer]]]


def refine(driver: Driver, case: Case, runs: list[JudgedRun], finer: Refinements) -> list[str]:
    """Run the integrators that are still unresolved at half their finest step so far.

    Error-controlled ones are run at the accuracy, or at the spacing of samples, that they need.

    The new runs go into `finer`. Returns the integrators that were run; none when all is decided,
    when a run failed, or after the most halvings.
    """
    finest = min(case.sweeps, key=lambda sweep: sweep.timestep)
    done = []
    wanted = {run.integrator.name: run.finer for run in runs if run.unresolved}
    for name in sorted(wanted):
        known = finer.setdefault(name, {})
        halvings = len(known) + 1
        if halvings > MOST_HALVINGS or any(not answer.ok for _, answer in known.values()):
            continue
        sweep = wanted[name] or finest.refined(2**halvings)
        known[sweep] = (sweep, driver.run(case, name, sweep))
        done.append(name)
    return done
