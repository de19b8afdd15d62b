"""Finer steps where a sweep is too coarse to show the order of an error."""

from __future__ import annotations

import numpy as np

from omegadot.gates.case import Case, Sweep
from omegadot.harness.drive import Driver
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.workers.harness_end.process import Answer

MOST_HALVINGS = 4
MORE_OF_ONE = 4  # where the last two are one trajectory, as of an engine with a longest step
ONE = 1e-9  # relative: what of two trajectories is one
UNDECIDED = "the run was interrupted before the finer steps that decide this task"
Refinements = dict[str, dict[Sweep, tuple[Sweep, Answer]]]


def refine(driver: Driver, case: Case, runs: list[JudgedRun], finer: Refinements) -> list[str]:
    """Run the integrators that are still unresolved at half their finest step so far.

    Those that raise at every step so far are run at the step that they need, and error-controlled
    ones at the accuracy, or at the spacing of samples. An engine that splits what is longer than a
    step of its own takes the same steps for several of these: it is run at finer ones still.

    The new runs go into `finer`. Returns the integrators that were run; none when all is decided,
    when a run failed, or after the most halvings.
    """
    finest = min(case.sweeps, key=lambda sweep: sweep.timestep)
    done = []
    wanted = {run.integrator.name: run.finer for run in runs if run.unresolved}
    for name in sorted(wanted):
        known = finer.setdefault(name, {})
        raised = all(run.outcome == "raised" for run in runs if run.integrator.name == name)
        lost = [a for _, a in known.values() if not (a.ok or (raised and a.outcome == "raised"))]
        most = MOST_HALVINGS + MORE_OF_ONE * _are_one([a for _, a in known.values()][-2:])
        if len(known) >= most or lost:
            continue
        stepped = [one for one in known if one.accuracy is None]
        shortest = min((finest, *stepped), key=lambda one: one.timestep)
        sweep = wanted[name] or shortest.refined(2)
        known[sweep] = (sweep, driver.run(case, name, sweep))
        done.append(name)
    return done


def _are_one(answers: list[Answer]) -> bool:
    """Whether two runs of the same samples are one trajectory."""
    if len(answers) < 2 or not all(one.ok for one in answers):
        return False
    one, other = (answer.result["state"] for answer in answers)
    with np.errstate(over="ignore", invalid="ignore"):  # runs that blow up are no trajectory
        apart = [np.max(np.abs(one[name] - other[name])) for name in one]
    sizes = [np.max(np.abs(values)) for values in one.values()]
    return all(a <= ONE * size for a, size in zip(apart, sizes, strict=True))


def left_undecided(runs: list[JudgedRun]) -> list[JudgedRun]:
    """The runs of an interrupted case: what finer steps could still decide has no verdict.

    Nor has what fails by the order over all steps of such an integrator alone.
    """
    still_open = {run.integrator.name for run in runs if run.unresolved}
    return [
        JudgedRun(run.integrator, run.sweep, "interrupted", UNDECIDED)
        if run.unresolved or (run.integrator.name in still_open and _fails_by_order(run))
        else run
        for run in runs
    ]


def _fails_by_order(run: JudgedRun) -> bool:
    failing = {row.metric for row in run.rows if row.verdict == "fail"}
    return failing == {"observed_order"}
