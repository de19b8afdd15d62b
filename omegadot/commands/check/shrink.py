"""From a check that fails to the simplest system on which the same gate fails.

Greedy: every simplification is tried on the simplest system so far, and kept where the same gate
fails for the same metric; again from the first, until none is left or the budget is used up.
"""

from __future__ import annotations

import time
import warnings
from collections import Counter
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from omegadot.commands.check.failing_state import Shown, failing_state, is_of_motion
from omegadot.commands.check.judge import CAUSE, failure
from omegadot.commands.check.result import GATES_OF_A_RUN, GATES_OF_A_SCENARIO, Check, Result
from omegadot.commands.check.simpler import SIMPLER, brief
from omegadot.commands.check.tables import Tables, ingredients, tables_of
from omegadot.gates.case import Case
from omegadot.gates.errors.verdicts import UNDECIDED
from omegadot.gates.rows import Row
from omegadot.harness.arguments import case_of
from omegadot.harness.outcome import EngineCase, RunRequest
from omegadot.harness.plan import EngineChoice
from omegadot.harness.runner import Runner
from omegadot.scenarios import Scenario, ScenarioError, scenario_of
from omegadot.scenarios.writing import to_toml

MOST = 3  # failures that are shrunk, each of another kind
TRIALS = 60  # for each
SECONDS = 20.0  # for all together
UNKNOWN = "none is known"  # with which begins what is known where no cause is


@dataclass(frozen=True)
class Failing:
    """The simplest system found on which a check fails.

    check: the one that was shrunk.  message: what fails of the simplest.  has: what is left in it.
    trials: systems tried.  finished: nothing simpler was left to try within the budget.
    command: runs it alone, once `toml` is in the file that it names.  at: the state at which it
    fails, where its own motion does not show that; else empty.  cause: the likely one of the check
    before it was shrunk, which decides between more causes; "" without any.
    """

    check: Check
    scenario: Scenario
    message: str
    has: tuple[str, ...]
    trials: int
    finished: bool
    command: str
    at: Shown = field(default_factory=dict)
    cause: str = ""

    @property
    def toml(self) -> str:
        """The scenario file."""
        return to_toml(self.scenario)


def kinds_of_failure(results: Mapping[Check, Result], cases: Mapping[str, Case]) -> list[Check]:
    """One failing check a kind, gate by integrator, three at most.

    Of the checks that show the cause of the most, the one on the case of fewest steps. Where a gate
    of the engine fails, those of its runs fail in consequence, and are left out; of an integrator
    the first of its gates that fails is taken.
    """
    causes = {c: r.message.partition(CAUSE)[2] for c, r in results.items()}
    named = Counter(cause for cause in causes.values() if cause and not cause.startswith(UNKNOWN))

    def cost(check: Check) -> tuple[int, int]:
        steps = sum(sweep.steps for sweep in cases[check.scenario].sweeps)
        return -named[causes[check]], steps

    failed = [c for c, r in results.items() if r.verdict == "fail" and c.scenario in cases]
    found: list[Check] = []
    for gates, key in ((GATES_OF_A_SCENARIO, "gate"), (GATES_OF_A_RUN, "integrator")):
        kinds: dict[object, list[Check]] = {}
        for gate in gates:
            for check in (c for c in failed if c.gate == gate):
                own = kinds.setdefault(getattr(check, key), [])
                if not own or own[0].gate == gate:
                    own.append(check)
        found = found or [min(own, key=cost) for own in kinds.values()]
    return found[:MOST]


def shrink(
    check: Check,
    case: Case,
    choice: EngineChoice,
    timeout: float,
    seed: int,
    command: str,
    seconds: float = SECONDS,
) -> Failing | None:
    """The simplest system on which this check's gate fails; None where it fails no more.

    choice: the engine.  seed: of the evaluation states.  command: the line up to the scenario.
    seconds: after which no further system is tried, nor one that is expected to last longer.
    """
    chosen = replace(choice, integrators=(check.integrator,) if check.integrator else ())
    request = RunRequest([], [chosen], seed=seed, timeout=min(timeout, SECONDS))
    runner = Runner(request)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        try:
            runner.engines.start()
            return _search(runner, check, case, command, seconds)
        except BaseException:
            runner.engines.stop()
            raise
        finally:
            runner.engines.finish()


@dataclass(frozen=True)
class _Failed:
    """What fails of one system: the rows of the gate, and whether its own motion shows it.

    integrator: of the run that fails, if it is one's.
    """

    rows: list[Row]
    of_motion: bool = False
    integrator: str | None = None


def _failed(found: EngineCase, gate: str) -> _Failed:
    """The rows of a gate that fail on a case: of the engine, or of the first run that fails."""
    shared = gate in GATES_OF_A_SCENARIO
    every = [(found.shared, None)] if shared else [(r.rows, r.integrator.name) for r in found.runs]
    for rows, integrator in every:
        failed = [row for row in rows if row.verdict == "fail"]
        own = [row for row in failed if row.gate == gate]
        if own:
            return _Failed(own, is_of_motion(failed), integrator)
    return _Failed([])


def _metrics(rows: Sequence[Row]) -> set[str]:
    """What fails; that steps cannot show an order is no failure to look for in another system."""
    return {row.metric for row in rows if not row.note.startswith(UNDECIDED)}


def _candidates(start: Tables) -> Generator[Tables, bool, None]:
    """Simpler systems than the simplest so far, each once; what was kept is simplified again.

    Sent in return is whether the system is kept.
    """
    simplest, tried, again = start, {repr(start)}, True
    while again:
        again = False
        for simpler in SIMPLER:
            while repr(tables := simpler(simplest)) not in tried:
                tried.add(repr(tables))
                if not (yield tables):
                    break
                simplest, again = tables, True


def _search(
    runner: Runner, check: Check, case: Case, command: str, seconds: float
) -> Failing | None:
    name = f"{case.name}-shrunk"
    whole, of_engine = tables_of(case, name), check.gate in GATES_OF_A_SCENARIO
    began = time.monotonic()

    def failed(tables: Tables) -> _Failed:
        try:
            judged = runner.run_case(case_of(scenario_of(tables, name), ()))
        except ScenarioError:  # no body has this inertia
            return _Failed([])
        return next((f for e in judged.engines if (f := _failed(e, check.gate)).rows), _Failed([]))

    wanted, trials, finished = set[str](), 0, True
    # most gates of the engine fail on one step as well, and the whole run takes long
    for simplest in (brief(whole), whole) if of_engine else (whole,):
        trials, started = trials + 1, time.monotonic()
        last = failed(simplest)
        wanted, took = _metrics(last.rows), time.monotonic() - started
        if wanted:
            break
    if not wanted:
        return None
    candidates = _candidates(simplest)
    tables = next(candidates, None)
    while tables is not None:
        started = time.monotonic()
        finished = trials < TRIALS and started + took < began + seconds
        if not finished:
            break
        trials += 1
        now = failed(tables)
        # What its own motion shows, that of the simplest shows as well.
        kept = bool(wanted & _metrics(now.rows)) and now.of_motion >= last.of_motion
        if kept:
            simplest, last, took = tables, now, time.monotonic() - started
        try:
            tables = candidates.send(kept)
        except StopIteration:
            break
    found = scenario_of(simplest, name)
    alone = f"{command} --scenario {name}.toml"
    left = ingredients(found, stepped=check.gate in GATES_OF_A_RUN)
    at = {} if last.of_motion else _state_of(runner, found, check.gate, last.integrator)
    return Failing(check, found, failure(last.rows), left, trials, finished, alone, at)


def _state_of(runner: Runner, found: Scenario, gate: str, integrator: str | None) -> Shown:
    """The state at which the simplest system fails, from its answers to the same requests."""
    judged = runner.run_case(case_of(found, ()))
    states = (
        failing_state(judged, engine, gate, integrator, runner.request.seed)
        for engine in judged.engines
        if _failed(engine, gate).rows
    )
    return next(states, {})
