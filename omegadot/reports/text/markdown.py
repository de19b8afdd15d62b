"""One run as a comment on a pull request: verdict, matrix, failures, what did not run."""

from __future__ import annotations

from omegadot.reports.record.record import Record
from omegadot.reports.shipped import table as shipped_table
from omegadot.reports.shipped.rows import shipped_rows
from omegadot.reports.summary import matrix
from omegadot.reports.summary.advice import Advice
from omegadot.reports.summary.headline import headline, remarks, truth
from omegadot.reports.summary.provenance import command_of
from omegadot.reports.summary.reasons import reason_of
from omegadot.reports.summary.summary import STATUSES, Cell, Summary, counts, summarise, task_status
from omegadot.reports.text.markdown_text import COMMENT, code, escape, folded, table
from omegadot.reports.text.numbers import engine_name, first, times

_FAILING = ("fail", "declared", "crashed", "timeout", "raised", "diverged")


def markdown_of(record: Record) -> str:
    """The record in Markdown, below the length that a comment may have."""
    summary = summarise(record)
    notes = " ".join(remarks(summary) + truth(summary))
    message = record.run.get("headline") or headline(summary)
    lines = [f"### omegadot: {escape(message, 1000)}", ""]
    lines += _as_shipped(record, COMMENT // 8)
    lines += [escape(notes, 1000), ""] if notes else []
    lines += [f"- {escape(one.sentence, 1000)}" for one in summary.failures]
    lines += [""] * bool(summary.failures)
    for advice in (summary.accuracy, summary.untried):
        lines += [_advice(advice), ""] if advice else []
    lines += [_counts(summary), ""]
    lines += _matrix(summary, COMMENT // 4)
    lines += _failures(record, COMMENT // 4)
    lines += _missing(summary, COMMENT // 8)
    lines += folded("Versions and machine", _versions(record, COMMENT // 8))
    command = code(command_of(record.run))
    lines += ["", command] if command else []
    return "\n".join(lines) + "\n"


def _as_shipped(record: Record, room: int) -> list[str]:
    """Each engine in both setups; nothing of a run in one."""
    rows = shipped_rows(record)
    if not rows:
        return []
    found = table(shipped_table.heads(rows), shipped_table.cells(rows), room, "more rows")
    note = escape(shipped_table.note(rows), 1000)
    return [f"**{shipped_table.TITLE}**", "", *found, "", note, ""]


def _advice(advice: Advice) -> str:
    return f"{escape(advice.text, 1000)} {code(advice.command)} {escape(advice.purpose)}."


def _counts(summary: Summary) -> str:
    return "".join(f"{line}. " for line in counts(summary)).rstrip() or "No run was made."


def _matrix(summary: Summary, room: int) -> list[str]:
    """Scenarios by engines, those of the worst verdict first where there is no room for all."""
    if not summary.columns:
        return []
    heads = ["scenario", *(column.name for column in summary.columns)]

    def rank(scenario: str) -> int:
        own = (summary.cells[scenario, column].status for column in summary.columns)
        return min(map(STATUSES.index, own))

    rows = [
        (name, *(_cell(summary.cells[name, column]) for column in summary.columns))
        for name in sorted(summary.scenarios, key=rank)
    ]
    message = (
        "✓ every gate holds, with the worst omega-dot residual at identical states, relative; "
        "✗ a gate fails, the first that does and its worst measure; ! a declared exception."
    )
    return [*table(heads, rows, room, "more scenarios, none of them worse"), "", message]


def _cell(cell: Cell) -> str:
    shown = matrix.shown(cell)
    term = "" if cell.status in ("pass", "fail") else shown.status
    number = shown.numbers.get(matrix.FAILED, shown.numbers.get("residual"))
    found = " ".join(filter(None, (shown.mark, term, shown.gate, number)))
    return ", ".join(filter(None, (found, shown.part)))


def _failures(record: Record, room: int) -> list[str]:
    """Runs that failed, or that failed as declared, each reason once."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for task in record.run["tasks"]:
        status = task_status(task)
        if status in _FAILING:
            gates = [gate for gate, v in (task.get("gates") or {}).items() if v == status]
            engine = engine_name(task["engine"], setup=task.get("setup") or "physics")
            own = engine, task.get("integrator") or "", ", ".join(gates)
            key = (status, *own, reason_of(task))
            groups.setdefault(key, []).append(task["scenario"])
    if not groups:
        return []
    order = sorted(groups, key=lambda key: (STATUSES.index(key[0]), -len(groups[key])))
    rows = [(*key[:4], _places(groups[key]), key[4]) for key in order]
    heads = ("outcome", "engine", "integrator", "gates", "where", "reason")
    return ["", "**Failures**", "", *table(heads, rows, room)]


def _places(scenarios: list[str]) -> str:
    runs = f", {times(len(scenarios), 'run')}" if len(scenarios) > 1 else ""
    return first(list(dict.fromkeys(scenarios)), 3) + runs


def _missing(summary: Summary, room: int) -> list[str]:
    rows = [
        (item.engine, item.status, item.runs or "none", item.reason)
        for item in summary.missing
        if item.status not in _FAILING
    ]
    if not rows:
        return []
    heads = ("engine", "outcome", "runs", "reason")
    return ["", "**What did not run**", "", *table(heads, rows, room)]


def _versions(record: Record, room: int) -> list[str]:
    run = record.run
    rows = [("omegadot", run.get("omegadot") or "")]
    for engine in run["engines"]:
        version = engine.get("version") or engine.get("reason") or "not installed"
        rows.append((engine["name"], version))
    rows += [fact for group in ("machine", "versions") for fact in (run.get(group) or {}).items()]
    rows += [(key, run[key]) for key in ("created", "seconds", "seed") if run.get(key) is not None]
    return table(("", ""), rows, room)
