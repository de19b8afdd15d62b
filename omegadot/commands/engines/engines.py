"""``omegadot engines``: what is installed, and what each engine reports of itself."""

from __future__ import annotations

import json
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import typer

from omegadot.harness.arguments import engine_choices
from omegadot.harness.plan import EngineChoice
from omegadot.workers.harness_end.process import Answer, WorkerProcess

START_TIMEOUT = 60.0


def _describe(choice: EngineChoice) -> Answer:
    worker = WorkerProcess(choice.target, "physics", START_TIMEOUT)
    answer = worker.start()
    worker.finish()
    return answer


def _entry(choice: EngineChoice, answer: Answer) -> dict[str, Any]:
    if not answer.ok:
        return {"name": choice.name, "installed": False, "reason": answer.reason}
    return {**answer.result, "name": choice.name, "installed": True, "reason": ""}


def print_engines(adapters: Sequence[str], as_json: bool) -> None:
    """Start every engine in a process of its own and print what it answers."""
    choices = engine_choices([], adapters)
    with ThreadPoolExecutor() as threads:
        answers = list(threads.map(_describe, choices))
    entries = [_entry(choice, answer) for choice, answer in zip(choices, answers, strict=True)]
    if as_json:
        typer.echo(json.dumps(entries, indent=2))
        return
    for entry in entries:
        _print_entry(entry)


def _print_entry(entry: dict[str, Any]) -> None:
    from rich.console import Console
    from rich.markup import escape

    console = Console(highlight=False, soft_wrap=True)
    if not entry["installed"]:
        console.print(f"[bold]{escape(entry['name'])}[/]  not available: {escape(entry['reason'])}")
        return
    head = f"[bold]{escape(entry['name'])}[/] {escape(entry['version'])}"
    console.print(f"{head}  {entry['precision']}  {escape(entry['licence'])}")
    for integrator in entry["integrators"]:
        console.print(f"  {escape(_integrator_line(integrator))}")
    for title, key in (("keeps", "conventions"), ("switched off", "switched_off")):
        for clause in entry[key]:
            console.print(f"  {title}: {escape(clause)}", style="dim")


def _integrator_line(integrator: dict[str, Any]) -> str:
    """Its name, its declared scheme and its order, printed once where all channels share it."""
    orders, scheme = integrator["orders"], integrator["scheme"]
    if not orders:
        return f"{integrator['name']}: {integrator['note']}"
    if len(set(orders.values())) == 1:
        order = f"order {next(iter(orders.values()))}"
    else:
        order = "order " + ", ".join(f"{value} in {c}" for c, value in orders.items())
    same = scheme == integrator["name"]
    return f"{integrator['name']}: {order}" + ("" if same or not scheme else f", {scheme}")
