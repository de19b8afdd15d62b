"""The engines as a page for the docs: what each is, how it is driven and what differs in it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from omegadot.adapters.protocol import Description, Integrator
from omegadot.commands.engines.engines import EngineEntry
from omegadot.reports.text.markdown_text import table

AGAIN = "omegadot engines --format markdown > docs/engines.md"
HEAD = f"""# Engines

<!-- Made by a command. Do not edit; run it again:
{AGAIN} -->

How omegadot drives each engine, from what its adapter reports. In each, defaults that disturb the
motion are switched off. States cross an adapter in the project's own frames; the conventions are
those that the engine keeps inside. What its integrators are, measured instead of declared, is on
[another page](schemes.md).

- *omega-dot*: from the engine itself at a given state (forward dynamics), or from its runs alone.
- *inverse dynamics*: the torque that a given omega-dot requires.
- *takes*: what a body and its loads may have. *all* is a free or pivoted body, gravity, damping,
  applied torques, products of inertia and a centre of mass off the origin.
- *reads*: robot files of which the engine's own reader is checked, with `--via`.
"""
LOADS = ("free", "pivot", "gravity", "damping", "torque", "full_inertia", "offset_com")
KNOBS = {
    "timestep": "step",
    "accuracy": "accuracy",
    "fixed-accuracy": "step; accuracy fixed",
}
ROOM = 10**6  # bytes of a table: none is cut


def markdown_of(entries: Sequence[EngineEntry]) -> str:
    """The page: a table of all that started, and a section for each."""
    known = [entry.description for entry in entries if entry.description is not None]
    missing = [entry for entry in entries if entry.description is None]
    lines = [HEAD, *_overview(known)]
    for entry in missing:
        lines += ["", f"{entry.name} is not available: {entry.reason}."]
    for own in known:
        lines += ["", *section(own)]
    return "\n".join(lines) + "\n"


def _overview(known: Iterable[Description]) -> list[str]:
    heads = ("engine", "release", "precision", "licence", "omega-dot", "inverse dynamics")
    rows = [
        (
            own.name,
            own.version,
            own.precision,
            own.licence,
            "at a state" if "forward_dynamics" in own.features else "in runs",
            "yes" if "inverse_dynamics" in own.features else "no",
            _taken(own),
            ", ".join(own.importers) or "–",
        )
        for own in known
    ]
    return table((*heads, "takes", "reads"), rows, ROOM)


def _taken(own: Description) -> str:
    """Which bodies and loads it takes; those that it lacks where these are fewer."""
    lacking = [one.replace("_", " ") for one in LOADS if one not in own.features]
    batch = ["many states at once"] if "batch" in own.features else []
    return "; ".join([f"all but {', '.join(lacking)}" if lacking else "all", *batch])


def section(own: Description) -> list[str]:
    """The lines of one engine."""
    heads = ("integrator", "scheme", "order", "free bodies are stepped in", "knob")
    lines = [f"## {own.name} {own.version}", "", *table(heads, map(_row, own.integrators), ROOM)]
    for title, clauses in {
        "Conventions": own.conventions,
        "Switched off": own.switched_off,
        "Sources": own.links,
    }.items():
        lines += ["", f"{title}:", "", *(f"- {clause}" for clause in clauses)] if clauses else []
    return lines


def _row(one: Integrator) -> tuple[str, ...]:
    if not one.orders:
        return one.name, one.note, "–", "–", "–"
    coordinates = one.coordinates if one.scheme else "–"
    return one.name, one.scheme or "of its own", order_of(one), coordinates, KNOBS[one.knob]


def order_of(one: Integrator) -> str:
    """``4``, or ``4 in omega, 2 in attitude`` where channels differ."""
    orders = one.orders
    if len(set(orders.values())) == 1:
        return str(next(iter(orders.values())))
    return ", ".join(f"{value} in {channel}" for channel, value in orders.items())
