"""One engine, sound or not, on one random case: which gates fail, and why."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.adapters.protocol import Adapter, Description, Integrator
from omegadot.commands.faults.fault import Spoiled
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.gates.rows import Row
from omegadot.gates.verdicts import UNDECIDED
from omegadot.harness.drive import CaseResult
from omegadot.harness.in_process import driver_of
from omegadot.harness.judge import JudgedRun, judge_case, shared_rows
from omegadot.harness.repeats import request_again
from omegadot.harness.step_probes import probe_steps

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


def judge(
    pool: Pool,
    prepared: Prepared,
    name: str,
    adapter: Adapter,
    integrators: tuple[Integrator, ...] = (),
) -> Judgement:
    """Put an engine through the gates, with one integrator of order 1 and one of order 4.

    integrators: those to run instead.

    The adapter may have seen other cases: what it keeps of them shows, as it does in any run. No
    refinement is run, and what one could still decide does not count as failed.
    """
    case = prepared.case
    chosen = integrators or chosen_integrators(adapter)
    driver = driver_of(name, adapter, chosen)
    result = driver.evaluate_equations(case, prepared.evaluation_states)
    pool.step_companions(prepared, result.integrators)
    result.runs.update(driver.run_all(case, lambda: None))
    probe_steps(driver, case, prepared.evaluation_states, result)
    request_again(driver, case, prepared.evaluation_states, result)
    with np.errstate(all="ignore"):  # a wrong engine may give any numbers
        shared = shared_rows(case, prepared.evaluation_states, result)
        runs = judge_case(prepared.truth, case, result, {})
    rows = (*shared, *(row for run in runs for row in run.rows))
    failure = result.first_failure()
    answers = [failure] if failure else []
    answers += [a for a in result.runs.values() if a.outcome not in ("ok", "unsupported")]
    broken = f"{answers[0].outcome}: {answers[0].reason}" if answers else ""
    failed = [row for row in rows if row.verdict == "fail" and not row.note.startswith(UNDECIDED)]
    gates = frozenset(row.gate for row in failed)
    return Judgement(gates, broken, rows, result, tuple(runs))
