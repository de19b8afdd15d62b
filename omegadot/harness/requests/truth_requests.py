"""Requests to the workers of the exact solution and of the reference's companions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.case import Case, Sweep
from omegadot.gates.truth import Companion, SchemeKey, Truth
from omegadot.harness.drive import Driver
from omegadot.reference_impl.solutions.companion import Steps
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.system import State
from omegadot.workers.harness_end.process import Answer

STEPS_TIMED = 64
Companions = dict[tuple[SchemeKey, float], Companion]


def case_truth(exact: Driver, case: Case) -> Truth | str:
    """The exact trajectory of a case, or the sentence that states why there is none."""
    times = case.sample_times
    answer = _requested(exact, case, "solve", times=times)
    if not answer.ok:
        return f"the exact trajectory cannot be worked out: {answer.reason}"
    state = State(**answer.result["state"])
    yardstick = Yardstick(case.system, times, state)
    found, floor = answer.result, answer.result["floor"]
    relative = {"omega": floor["angular_velocity"] / yardstick.rate, "attitude": floor["attitude"]}
    growth = growth_along(case.system, times, state, yardstick.rate)
    return Truth(found["source"], times, state, found["omega_dot"], growth, relative, yardstick)


def _requested(driver: Driver, case: Case, operation: str, **fields: Any) -> Answer:
    """An answer by which every engine is judged: a crash is worth a second try."""
    fields |= {"system": case.system, "initial": case.initial}
    answer = driver.request(case, operation, **fields)
    return driver.request(case, operation, **fields) if answer.outcome == "crashed" else answer


def case_companions(
    reference: Driver,
    case: Case,
    truth: Truth | str,
    keys: Iterable[SchemeKey],
    sweeps: Sequence[Sweep],
) -> Companions:
    """The reference's run for every scheme and step; a scheme that fails is left out."""
    if isinstance(truth, str):
        return {}
    found: Companions = {}
    plan = [Steps(sweep.timestep, sweep.steps, sweep.every) for sweep in sweeps]
    for key in keys:
        fields = {**vars(key), "plan": plan, "rate": truth.yardstick.rate}
        answer = _requested(reference, case, "companion", **fields)
        if answer.ok:
            for sweep, run in zip(sweeps, answer.result, strict=True):
                parts = (State(**run["state"]), run["growth"], run["omega_dot"])
                found[key, sweep.timestep] = Companion(*parts, key.scheme)
    return found


def reference_runs(
    reference: Driver, case: Case, companions: Companions
) -> dict[tuple[str, float], Answer]:
    """The companions as the runs of the engine `reference`: they are the same computation.

    Companions of a sweep share their steps, so the cost of one is measured on a short run apart.
    """
    runs = {}
    for integrator in reference.engine.integrators:
        first = case.sweeps[0]
        short = Sweep(first.timestep, min(first.steps, STEPS_TIMED), first.every)
        timed = reference.run(case, integrator.name, short)
        for sweep in case.sweeps:
            key = (integrator.name, sweep.timestep)
            found = companions.get((SchemeKey(integrator.name), sweep.timestep))
            if found is None or not timed.ok:
                failed = Answer("raised", "the reference gave no answer for this scheme")
                runs[key] = failed if timed.ok else timed
                continue
            own = {"time": sweep.times, "state": vars(found.state), "omega_dot": found.omega_dot}
            runs[key] = Answer("ok", result={**timed.result, **own})
    return runs
