"""What the 3-D view opens with: runs that fail beside a sound one, else a spread of engines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from omegadot.reports.charts.coinciding import Lane
from omegadot.reports.page.view_3d.attitudes import RunAttitudes
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.orders import Orders
from omegadot.reports.summary.reasons import failing_gates

PLACES = 3  # runs that the view shows beside the exact solution
_OF_A_RUN = {"scheme", "invariants", "trajectory"}
Ranks = Mapping[tuple[float | None, float | None], int]
Key = tuple[str, str, str, float | None, float | None]


@dataclass(frozen=True)
class Opening:
    """lanes: what is shown beside the exact solution.  rank: at which step, 0 for the finest.

    everyone: whether every engine is shown instead, more than `PLACES` having run.
    """

    lanes: list[Lane]
    rank: int = 0
    everyone: bool = False


def key_of(run: RunAttitudes) -> Key:
    """What names a run within a scenario."""
    return run.engine, run.setup, run.integrator, run.timestep, run.accuracy


def failing_runs(tasks: Iterable[Mapping[str, Any]]) -> dict[str, dict[Key, list[str]]]:
    """By scenario and run: the gates that fail."""
    found: dict[str, dict[Key, list[str]]] = {}
    for task in tasks:
        if gates := failing_gates(task):
            run = task.get("integrator") or "", task.get("timestep"), task.get("accuracy")
            key = (task["engine"], task.get("setup") or "physics", *run)
            found.setdefault(task["scenario"], {})[key] = gates
    return found


def opening(
    runs: Sequence[RunAttitudes], ranks: Ranks, failing: Mapping[Key, list[str]], orders: Orders
) -> Opening:
    """What to open with on a scenario. runs: in the order of the page's lines.

    orders: declared in attitude, by engine and integrator.
    Where engines fail: of the two that err the most, the integrator whose failing run does, then of
    the engines that do not fail the most exact run of the order of the first, so that what is seen
    apart is the fault and not the order, or the most exact where none has that order; at the finest
    step at which the first of them fails.
    Else of three engines in turn the least and the most exact integrator, at the coarsest step.
    The reference is not counted among the engines that ran.
    """
    everyone = len({run.engine for run in runs if run.engine != "reference"}) > PLACES
    failed = [run for run in runs if key_of(run) in failing]
    if not failed:
        judged = [run for run in runs if run.engine != "reference"] or list(runs)
        engines = _by_engine(judged)[:PLACES]
        lanes = [lane_of(_extreme(own, ranks, k)) for k, own in enumerate(engines)]
        return Opening(lanes, everyone=everyone)

    def harm(run: RunAttitudes) -> tuple[bool, float]:  # before runs of a wrong equation alone
        return bool(_OF_A_RUN & set(failing[key_of(run)])), run.largest

    worst = [max(own, key=harm) for own in _by_engine(failed)]
    worst = sorted(worst, key=harm, reverse=True)[: PLACES - 1]
    lanes = [lane_of(run) for run in worst]
    rank = min(_rank(run, ranks) for run in failed if lane_of(run) == lanes[0])
    engines_failing = {engine for engine, *_ in failing}
    sound = [run for run in runs if run.engine not in engines_failing and _rank(run, ranks) == 0]
    order = orders.get((worst[0].engine, worst[0].integrator))

    def other_order(run: RunAttitudes) -> bool:
        return order is not None and orders.get((run.engine, run.integrator)) != order

    best = sorted(sound, key=lambda run: (other_order(run), run.engine in YARDSTICKS, run.largest))
    return Opening([*lanes, *map(lane_of, best[:1])], rank, everyone)


def _extreme(own: Sequence[RunAttitudes], ranks: Ranks, place: int) -> RunAttitudes:
    """Of one engine at its coarsest step: the least exact run at even places, else the most."""
    coarsest = max(_rank(run, ranks) for run in own)
    at_it = [run for run in own if _rank(run, ranks) == coarsest]
    return (min if place % 2 else max)(at_it, key=lambda run: run.largest)


def _rank(run: RunAttitudes, ranks: Ranks) -> int:
    return ranks[run.timestep, run.accuracy]


def lane_of(run: RunAttitudes) -> Lane:
    """What one line of the page stands for."""
    return run.engine, run.setup, run.integrator


def _by_engine(runs: Iterable[RunAttitudes]) -> list[list[RunAttitudes]]:
    found: dict[str, list[RunAttitudes]] = {}
    for run in runs:
        found.setdefault(run.engine, []).append(run)
    return list(found.values())
