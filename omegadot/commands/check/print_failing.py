"""The smallest failing systems in the terminal: each as a file, with the command that runs it."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from omegadot.commands.check.failing_state import state_text
from omegadot.commands.check.shrink import Failing
from omegadot.reports.text.numbers import listed


def print_failing(console: Console, failing: Sequence[Failing], of_several: bool) -> None:
    """Each of the smallest systems, and of those of one gate and cause the first alone.

    of_several: whether the failures have several causes, so that each names its own.
    """
    for number, one in enumerate(failing):
        before = next((other for other in failing[:number] if _alike(other, one)), None)
        if before is None:
            _print(console, one, of_several)
            continue
        text = f"{one.check.id} fails for the same cause as {before.check.id}, the system above."
        console.print(Text(text, "bold"))


def _alike(one: Failing, other: Failing) -> bool:
    """Whether two systems show one thing: that the same gate fails for the same cause."""
    return bool(one.cause) and (one.check.gate, one.cause) == (other.check.gate, other.cause)


def _print(console: Console, found: Failing, of_several: bool) -> None:
    left = listed(list(found.has)) if found.has else "a free body on which nothing acts"
    searched = "" if found.finished else f" (the search ended after {found.trials} systems)"
    console.print(Text(f"Smallest failing system of {found.check.id}{searched}:", "bold"))
    console.print(Text(f"    What is left in it: {left}. {found.message}"))
    if found.at:
        what = "the equation is wrong" if found.check.gate == "equation" else "a single step fails"
        line = f"It fails at a state that is none of its run: {what} at {state_text(found.at)}."
        console.print(Text(f"    {line}"))
    if found.cause and of_several:
        console.print(Text(f"    Likely cause, found on {found.check.scenario}: {found.cause}"))
    console.print(Text(f"    Save as {found.scenario.name}.toml, then: {found.command}"))
    console.print(Text(found.toml))
