"""One engine, sound or not, on one case, as `check` examines it: which gates fail, and why.

It is examined in stages, cheap ones first: the model and the equations, then one integrator after
another. What fails at a stage is caught, and the stages after it need not be run.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, is_dataclass, replace
from typing import Any

import numpy as np

from omegadot.adapters.protocol import Adapter, Description, Integrator
from omegadot.commands.faults.fault import OtherSystem, Spoiled
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.commands.faults.restepped import Accelerated
from omegadot.gates.errors.verdicts import UNDECIDED
from omegadot.gates.rows import Row
from omegadot.harness.drive import CaseResult, Driver
from omegadot.harness.in_process import driver_of
from omegadot.harness.judging.engine import shared_rows
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.judging.refine import MOST_HALVINGS, Refinements, refine
from omegadot.harness.judging.runs import judge_case
from omegadot.harness.requests.repeats import request_again
from omegadot.harness.requests.step_probes import probe_steps
from omegadot.harness.requests.until_raised import request_until_raised

GATES = ("model", "equation", "scheme", "invariants", "trajectory")


@dataclass(frozen=True)
class Judgement:
    """failed: the gates that fail.  broken: what could not be measured at all, as text."""

    failed: frozenset[str]
    broken: str
    rows: tuple[Row, ...]
    result: CaseResult
    runs: tuple[JudgedRun, ...]

    @property
    def accused(self) -> bool:
        """Whether a gate failed, or an answer did."""
        return bool(self.failed) or bool(self.broken)


class Nameless(Spoiled):
    """An engine whose integrators declare their orders and no scheme, otherwise as it is."""

    @property
    def description(self) -> Description:
        """The engine's, without its schemes."""
        found = self.inner.description
        return replace(found, integrators=tuple(map(without_scheme, found.integrators)))


def without_scheme(integrator: Integrator) -> Integrator:
    """The integrator with its orders alone."""
    return replace(integrator, scheme=None)


def chosen_integrators(engine: Adapter) -> tuple[Integrator, ...]:
    """The first integrator of order 1 and the first of order 4, whichever there are.

    A nameless engine's are those of the engine with its schemes, without them.
    """
    if isinstance(engine, Nameless):
        return tuple(map(without_scheme, chosen_integrators(engine.inner)))
    picked: dict[int, Integrator] = {}
    for integrator in engine.description.integrators:
        if integrator.scheme is not None:
            picked.setdefault(integrator.orders["attitude"], integrator)
    return tuple(picked[order] for order in (1, 4) if order in picked)


def stages(
    pool: Pool,
    prepared: Prepared,
    name: str,
    adapter: Adapter,
    integrators: tuple[Integrator, ...] = (),
    *,
    whole: bool = True,
) -> Iterator[Judgement]:
    """What an engine shows, stage by stage, each with its own rows and the answers so far.

    integrators: those to run; one of order 1 and one of order 4 without any.  whole: False leaves
    out the further requests to an integrator whose runs fail already.  The adapter may have seen
    other cases: what it keeps of them shows, as it does in any run.
    """
    case, at = prepared.case, prepared.evaluation_states
    driver = driver_of(name, adapter, integrators or chosen_integrators(adapter))
    result = driver.evaluate_equations(case, at)
    yield _stage(_shared_rows(prepared, result), result, ())
    for integrator in result.integrators:
        own = replace(result, integrators=(integrator,))
        runs = _runs(pool, prepared, driver, own, whole)
        repeated = CaseResult(siblings=own.siblings, reloaded=own.reloaded, precision=own.precision)
        rows = _shared_rows(prepared, repeated)
        yield _stage([*rows, *(row for run in runs for row in run.rows)], own, tuple(runs))


@np.errstate(all="ignore")  # a wrong engine may give any numbers
def _shared_rows(prepared: Prepared, result: CaseResult) -> list[Row]:
    return shared_rows(prepared.case, prepared.evaluation_states, result)


@np.errstate(all="ignore")
def _runs(
    pool: Pool, prepared: Prepared, driver: Driver, own: CaseResult, whole: bool
) -> list[JudgedRun]:
    """One integrator's runs, judged."""
    case, at, (integrator,) = prepared.case, prepared.evaluation_states, own.integrators
    for sweep in case.sweeps:
        own.runs[integrator.name, sweep.timestep] = driver.run(case, integrator.name, sweep)
    pool.step_companions(prepared, own.integrators, case.sweeps)
    if not whole:
        runs = judge_case(prepared.truth, case, own, {})
        if _any_fails(runs):
            return runs
    request_until_raised(driver, case, own)
    probe_steps(driver, case, at, own)
    request_again(driver, case, at, own)
    return _judged(pool, prepared, driver, own)


def _judged(pool: Pool, prepared: Prepared, driver: Driver, own: CaseResult) -> list[JudgedRun]:
    """One integrator's runs, with finer ones as long as these can still decide something."""
    case, finer = prepared.case, Refinements()
    runs = judge_case(prepared.truth, case, own, finer)
    for _ in range(MOST_HALVINGS):
        if _any_fails(runs):
            break
        if not refine(driver, case, runs, finer):
            break
        sweeps = [sweep for known in finer.values() for sweep, _ in known.values()]
        pool.step_companions(prepared, own.integrators, sweeps)
        runs = judge_case(prepared.truth, case, own, finer)
    return runs


def _any_fails(runs: list[JudgedRun]) -> bool:
    return any(_fails(row) for run in runs for row in run.rows)


def _fails(row: Row) -> bool:
    """Whether a row fails for good: what a finer step could still decide does not."""
    return row.verdict == "fail" and not row.note.startswith(UNDECIDED)


def _stage(rows: list[Row], result: CaseResult, runs: tuple[JudgedRun, ...]) -> Judgement:
    failure = result.first_failure()
    answers = [failure] if failure else []
    judged = [r for r in runs if r.outcome != "diverged"]
    answers += [result.runs[r.integrator.name, r.sweep.timestep] for r in judged]
    lost = [a for a in answers if a.outcome not in ("ok", "unsupported")]
    broken = f"{lost[0].outcome}: {lost[0].reason}" if lost else ""
    failed = frozenset(row.gate for row in rows if _fails(row))
    return Judgement(failed, broken, tuple(rows), result, runs)


def judge(
    pool: Pool,
    prepared: Prepared,
    name: str,
    adapter: Adapter,
    integrators: tuple[Integrator, ...] = (),
) -> Judgement:
    """All stages of an engine together."""
    found = list(stages(pool, prepared, name, adapter, integrators))
    return Judgement(
        failed=frozenset[str]().union(*(one.failed for one in found)),
        broken=next((one.broken for one in found if one.broken), ""),
        rows=tuple(row for one in found for row in one.rows),
        result=replace(found[-1].result, integrators=_every(found)),
        runs=tuple(run for one in found for run in one.runs),
    )


def _every(found: list[Judgement]) -> tuple[Integrator, ...]:
    return tuple(i for one in found[1:] for i in one.result.integrators)


def start_of(pool: Pool, prepared: Prepared, name: str, adapter: Adapter) -> Judgement:
    """The first stage alone: the model and the equations."""
    return next(stages(pool, prepared, name, adapter))


def first_failure(pool: Pool, prepared: Prepared, name: str, adapter: Adapter) -> Judgement:
    """The first stage at which an engine fails, or does not answer; the last one if none.

    A fault that changes neither the system nor an answer about the dynamics, where it acts on these
    alone, is not stepped: it would show nothing.
    """
    examined = stages(pool, prepared, name, adapter, whole=False)
    found = next(examined)
    if found.accused or _is_idle(adapter, prepared):
        return found
    for found in examined:
        if found.accused:
            break
    return found


def _is_idle(adapter: Adapter, prepared: Prepared) -> bool:
    """Whether a fault leaves the system or the dynamics as they are, to the bit."""
    faulty = adapter.inner if isinstance(adapter, Nameless) else adapter
    if isinstance(faulty, OtherSystem):
        return _same(faulty.loaded(faulty.system), faulty.system)
    if not isinstance(faulty, Accelerated) or not faulty.is_in_dynamics:
        return False
    at, sound = prepared.evaluation_states, faulty.inner
    return all(
        _same(faulty.forward_dynamics(states), sound.forward_dynamics(states))
        for states in (at.random, at.path)
    )


def _same(one: Any, other: Any) -> bool:
    """Whether two bodies, loads, systems or accelerations hold the same numbers."""
    if isinstance(one, tuple):
        return all(map(_same, one, other))
    if is_dataclass(one):
        return _same(tuple(vars(one).values()), tuple(vars(other).values()))
    return one is other or bool(np.array_equal(one, other))
