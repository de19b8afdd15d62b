"""Runs of both records: which are the same one, and whose outcome or verdict changed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from omegadot.reports.summary.summary import STATUSES
from omegadot.reports.two_runs.change import Change
from omegadot.reports.two_runs.figures import VERDICT_RANK
from omegadot.reports.two_runs.sides import RunKey, Task

# Nothing was known of such a run before, so that whatever it comes to now is new.
_UNKNOWN_BEFORE = ("not-installed", "interrupted")


Pair = tuple[Task, Task]


def _stand_ins(tasks: Iterable[Task]) -> dict[tuple[str, str, str], list[Task]]:
    """The tasks of engines that never got to a step, by scenario, engine and setup."""
    found: dict[tuple[str, str, str], list[Task]] = {}
    for task in tasks:
        if task.stands_for_all:
            key = task.key
            found.setdefault((key.scenario, key.engine, key.setup), []).append(task)
    return found


def _stand_in(key: RunKey, tasks: Mapping[tuple[str, str, str], list[Task]]) -> Task | None:
    """The task that stands for this run: an engine that did not start stands for all its runs."""
    for task in tasks.get((key.scenario, key.engine, key.setup), ()):
        if task.key.integrator in ("", key.integrator):
            return task
    return None


def pair_runs(
    was: Mapping[RunKey, Task], now: Mapping[RunKey, Task]
) -> tuple[list[Pair], list[Task], list[Task]]:
    """Each run with the same one of the other record; those that have vanished, and appeared.

    An engine that did not start stands in for its runs.
    """
    absent_now, absent_then = _stand_ins(now.values()), _stand_ins(was.values())
    pairs = [
        (task, other)
        for key, task in was.items()
        if (other := now.get(key) or _stand_in(key, absent_now))
    ]
    seen = {other.key for _, other in pairs}
    pairs += [
        (other, task)
        for key, task in now.items()
        if key not in seen and (other := _stand_in(key, absent_then))
    ]
    first, second = ({pair[place].key for pair in pairs} for place in (0, 1))
    vanished = [task for key, task in was.items() if key not in first]
    appeared = [task for key, task in now.items() if key not in second]
    appeared += [other for task, other in pairs if _unknown_before(task, other)]
    return [pair for pair in pairs if not _unknown_before(*pair)], vanished, appeared


def _unknown_before(was: Task, now: Task) -> bool:
    return was.outcome in _UNKNOWN_BEFORE and was.outcome != now.outcome


def _outcome_rank(outcome: str) -> int:
    """Higher is better; a run that came to its end is best."""
    return len(STATUSES) if outcome == "ok" else STATUSES.index(outcome)


def changed_runs(pairs: Iterable[Pair]) -> Iterator[Change]:
    """The runs with another outcome; where it is the same, the gates with another verdict."""
    for was, now in pairs:
        key = now.key if was.stands_for_all else was.key
        if was.outcome != now.outcome:
            worse = _outcome_rank(now.outcome) < _outcome_rank(was.outcome)
            yield Change(key, worse, "", "", "", was.outcome, now.outcome, why=now.why)
            continue
        for gate, verdict in was.gates.items():
            # A gate that was reached and is no longer has no verdict any more.
            verdict_now = now.gates.get(gate, "info")
            if verdict != verdict_now:
                worse = VERDICT_RANK[verdict_now] < VERDICT_RANK[verdict]
                yield Change(key, worse, gate, "", "", verdict, verdict_now, why=now.why)


def without_repetition(gates: Iterable[Change], figures: Iterable[Change]) -> list[Change]:
    """Both, without the gates whose change is that of a figure in them.

    A figure of model or equation belongs to the engine, and stands for all its runs.
    """
    reported = list(figures)
    covered = {
        (change.key, change.gate, change.worse) for change in reported if change.was != change.now
    }
    whole = []
    for change in gates:
        keys = change.key, change.key._replace(integrator="", timestep=None, accuracy=None)
        if not any((key, change.gate, change.worse) in covered for key in keys):
            whole.append(change)
    return whole + reported
