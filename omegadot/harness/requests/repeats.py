"""Requests made again: the answers may not depend on what was requested, or loaded, before."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Case, Sweep
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.rows import Row
from omegadot.gates.runs import repeats
from omegadot.gates.runs.repeats import How
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.truth import Truth
from omegadot.harness.arguments import case_of
from omegadot.harness.drive import RELOADED, CaseResult, Driver
from omegadot.harness.requests.opposite import request_opposites
from omegadot.harness.requests.opposite_steps import request_opposite_steps
from omegadot.harness.requests.scaled import request_scaled
from omegadot.harness.requests.siblings import request_siblings
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State
from omegadot.scenarios import scenario

FEWEST_STEPS = 8

# Each with every load, and as unlike any other system as can be.
OTHERS = tuple(
    case_of(
        scenario(
            name=f"another-{support}",
            body={
                "mass": 7.3,
                "inertia": [[1.9, 0.3, -0.2], [0.3, 1.3, 0.1], [-0.2, 0.1, 1.1]],
                "center_of_mass": [0.31, -0.23, 0.17],
            },
            initial={"orientation": [-0.1, 0.7, 0.5, -0.5], "angular_velocity": [1.3, -0.9, 0.7]},
            load={
                "gravity": [1.7, -3.1, 5.3],
                "damping": 0.7,
                "torque": {"frame": frame, "value": [-0.9, 1.1, 0.6]},
                **pivot,
            },
            run={"duration": 0.04, "timesteps": [0.01], "sample": 0.01},
        ),
        (),
    )
    for support, frame, pivot in (
        ("pivoted", "world", {"pivot": [-0.19, 0.29, 0.13]}),
        ("free", "body", {}),
    )
)


def short_sweep(sweep: Sweep) -> Sweep:
    """The first samples of a sweep, of a few steps: as many as its own at most."""
    samples = -(-FEWEST_STEPS // sweep.every)
    return replace(sweep, steps=min(sweep.steps, samples * sweep.every))


def request_again(
    driver: Driver, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> None:
    """Have the coarsest run of every integrator repeated, in two ways or three, into `result`.

    Its first samples are, twice, as the first time differs from the run in its length. All of it is
    where the steps are the integrator's own, for these may depend on the length; its first samples
    are requested as well, to be compared with those after another system.
    Forward dynamics of systems that differ in one thing are requested. At the end another system is
    loaded and stepped, and then this one again; forward dynamics are requested then as well.
    """
    sweeps = {i.name: case.sweeps_of(i)[0] for i in result.integrators}
    runs = {name: result.runs.get((name, sweep.knob)) for name, sweep in sweeps.items()}
    steppers = [i for i in result.integrators if (run := runs[i.name]) is not None and run.ok]
    if not steppers:
        return

    def replay(integrator: Integrator, how: How, initial: State, whole: bool = False) -> None:
        name, sweep = integrator.name, sweeps[integrator.name]
        requested = sweep if whole else short_sweep(sweep)
        result.again[name, sweep.knob, how] = driver.replay(case, name, requested, initial)

    negated = replace(case.initial, orientation=-case.initial.orientation)
    # an unknown scheme may step a chart of its own, in which q and -q are different points
    known = {i.name for i in result.integrators if i.scheme in SCHEMES and i.knob == "timestep"}
    for integrator in steppers:
        whole = integrator.knob != "timestep"
        replay(integrator, "repeated", case.initial, whole)
        replay(integrator, "short" if whole else "repeated", case.initial)
    for integrator in steppers:
        if integrator.name in known:
            replay(integrator, "negated", negated)
    request_siblings(driver, case, evaluation_states, result)
    request_scaled(driver, case, evaluation_states, result)
    if result.scaled:  # forward dynamics are wrong
        request_opposites(driver, case, evaluation_states, result)
    else:
        request_opposite_steps(driver, case, result)
    if not _load_another(driver, case, steppers[0]):
        return
    if "forward_dynamics" in driver.engine.description.features:
        result.reloaded = driver.request(case, "forward", states=evaluation_states.random)
        result.before[RELOADED] = driver.before
    for integrator in steppers:
        replay(integrator, "reloaded", case.initial)


def _load_another(driver: Driver, case: Case, integrator: Integrator) -> bool:
    """Whether the engine has taken another system and stepped it; a body is free to be refused."""
    held = case.system.load.pivot is not None
    others = reversed(OTHERS) if held else OTHERS
    return any(
        driver.replay(o, integrator.name, o.sweeps_of(integrator)[0], o.initial).ok for o in others
    )


def rows_again(
    truth: Truth, integrator: Integrator, sweep: Sweep, result: CaseResult, measured: MeasuredRun
) -> Iterator[Row]:
    """The rows of these answers, for the run that they repeat; none for other runs."""
    first = result.runs[integrator.name, sweep.knob]
    for how in repeats.NOTES:
        answer = result.again.get((integrator.name, sweep.knob, how))
        if answer is None:
            continue
        whole = integrator.knob != "timestep" and how == "repeated"
        count = len((sweep if whole else short_sweep(sweep)).times)
        before = first
        if how == "reloaded":
            before = result.again.get((integrator.name, sweep.knob, "short"), first)
        if answer.ok and len(answer.result["time"]) == count:
            state, again = (State(**one.result["state"]) for one in (before, answer))
            yield repeats.row(truth, measured, state, how, again)
        elif answer.ok:
            yield repeats.refused(how, "it has another number of samples")
        elif answer.outcome == "raised":
            yield repeats.refused(how, answer.reason)
