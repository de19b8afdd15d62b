"""A choice in tables, the same for the terminal and the page; and all of it in the terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.text import Text

from omegadot.reports.choice import sentences
from omegadot.reports.choice.sentences import (
    LONGEST,
    NAMES,
    missed_text,
    open_yet,
    setting_text,
    shown,
)
from omegadot.reports.text.numbers import grouped, short
from omegadot.reports.text.text_grid import Grid, plain_console, text_grid

Row = Mapping[str, Any]
MEGABYTE = 1e6


# What a terminal has no room for, and the page has.
WIDE = ("memory in MB", "Pareto-optimal")


def ranking(choice: Row, case: Row) -> Grid:
    """Those that qualify, the cheapest first."""
    wanted = choice["requirements"]["accuracy"]
    errors = (NAMES[r["requirement"]] for r in wanted)
    heads: tuple[str, ...] = ("rank", "engine", "integrator", "step in s", "steps", *errors)
    heads = (*heads, "real-time factor", "memory in MB", "Pareto-optimal", "next larger step tried")
    rows = [
        (
            _rank(row),
            f"{row['engine']} {row['version']}",
            row["integrator"],
            setting_text(row["found"]),
            str(row["found"]["steps"]) if row["found"]["timestep"] else "–",
            *(_error(row["found"], requirement) for requirement in wanted),
            _factor(row),
            f"{row['memory'] / MEGABYTE:.0f}" if row["memory"] else "–",
            "yes" if row["on_front"] else "",
            _larger(row),
        )
        for row in case["candidates"]
        if row["status"] == "qualifies"
    ]
    return Grid(f"{case['name']}: what qualifies, the cheapest first", heads, rows)


def narrow(grid: Grid) -> Grid:
    """A table without the columns that only the page has."""
    kept = [k for k, head in enumerate(grid.heads) if head not in WIDE]
    return Grid(
        grid.title, [grid.heads[k] for k in kept], [[row[k] for k in kept] for row in grid.rows]
    )


def _error(found: Row, requirement: Row) -> str:
    error = found["errors"].get(requirement["requirement"])
    if error is None:
        return "–"
    text = shown(error["value"], requirement)
    margin = error["margin"]
    return text if margin is None else f"{text} (margin {grouped(margin)}x)"


def _factor(row: Row) -> str:
    factor = row["real_time_factor"]
    if factor is None:
        return "–"
    low, high = factor["quartiles"]
    return f"{grouped(factor['median'])} ({grouped(low)} to {grouped(high)})"


def _rank(row: Row) -> str:
    return f"{row['rank']} (tied)" if row["tied"] else str(row["rank"])


def _larger(row: Row) -> str:
    larger = row["larger"]
    if larger is None:
        return "none: every step tried passes"
    ratio = larger["ratio"]
    by = "" if ratio is None else f": {grouped(ratio)} times the limit"
    message = f"{setting_text(larger)} fails{by}"
    if row["passes_again"]:
        message += f", {setting_text(row['passes_again'])} passes again"
    return message


def refusals(case: Row) -> Grid:
    """Those that do not qualify: which requirement each misses, and its nearest run."""
    rows: list[tuple[str, ...]] = []
    for row in case["candidates"]:
        if row["status"] == "qualifies":
            continue
        near, engine = row["nearest"], f"{row['engine']} {row['version']}"
        at = setting_text(near) if near else "–"
        if row["status"] != "out":
            rows.append((engine, row["integrator"], f"{row['status']}: {row['reason']}", at, ""))
            continue
        misses = "; ".join(missed_text(missed) for missed in row["missed"])
        rows.append((engine, row["integrator"], misses, at, _guess(row)))
    heads = ("engine", "integrator", "misses", "at step in s", "predicted from its order")
    return Grid(f"{case['name']}: what does not qualify, at its nearest run", heads, rows)


def _guess(row: Row) -> str:
    guess = row["predicted"]
    if guess is None:
        return "" if row["found"] else "no order observed at these steps"
    if guess["seconds"] > LONGEST:
        return "out of reach: a run would take more than an hour"
    step, seconds = short(guess["timestep"]), grouped(guess["seconds"])
    if not open_yet(guess):
        slow = "; ".join(missed_text(missed) for missed in guess["missed"])
        return f"cannot qualify: at a step of {step} s, {seconds} s a run, {slow}"
    return f"a step of {step} s may suffice, {seconds} s a run (not verified)"


def everywhere(choice: Row) -> Grid | None:
    """What qualifies in all of several scenarios; None where there is only one."""
    cases = choice["scenarios"]
    if len(cases) < 2:
        return None
    heads = ("rank", "engine and integrator", "total in s", "steps in s, scenario by scenario")
    rows: list[tuple[str, ...]] = []
    for row in choice["everywhere"]:
        knobs = zip(row["timesteps"], row["accuracies"], strict=True)
        settings = [
            setting_text({"timestep": step, "accuracy": accuracy}) for step, accuracy in knobs
        ]
        rows.append((
            _rank(row), row["candidate"], short(row["seconds"]["median"], 3),
            ", ".join(settings),
        ))  # fmt: skip
    return Grid("What qualifies in every scenario, the cheapest first", heads, rows)


def print_choice(choice: Mapping[str, Any], console: Console | None = None) -> None:
    """Print the answer, then case by case what qualifies, what does not and what would change it.

    The answer stands first: on a terminal of few lines the tables push it off the screen.
    """
    console = console or plain_console(240)
    overall = everywhere(choice)
    if overall is not None:
        console.print(Text(sentences.verdict_everywhere(choice), style="bold"))
    for case in choice["scenarios"]:
        console.print(Text(sentences.headline(case), style="bold"))
    console.print(Text(f"Required: {sentences.requested(choice)}."))
    for case in choice["scenarios"]:
        console.print()
        if case["title"] != case["name"]:
            console.print(Text(f"{case['name']}: {case['title']}"))
        for grid in (narrow(ranking(choice, case)), refusals(case)):
            if grid.rows:
                console.print(text_grid(*grid))
                console.print()
        for line in sentences.variant_lines(case):
            console.print(Text(line))
    if overall is not None and overall.rows:
        console.print()
        console.print(text_grid(*overall))
    console.print()
    for line in sentences.notes(choice):
        console.print(Text(line, style="yellow"))
    console.print(Text(f"{sentences.STEPS} {sentences.FACTOR}", style="dim"))
