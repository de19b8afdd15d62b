"""Engine is colour, integrator is dash, on every chart and swatch of the page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from omegadot.reports.charts.deviations import Chart
from omegadot.reports.charts.further_colours import further_colours

# Apart in the common forms of colour blindness, 3:1 or more against the page (light, dark).
INK = ("#1c1f23", "#e6e8eb")
COLOURS = (
    ("#0068ab", "#56a8e0"),
    ("#c24e00", "#f0883e"),
    ("#00795a", "#35c49a"),
    ("#a8437f", "#e48ac0"),
    ("#7a6a00", "#d8c440"),
    ("#5b4fc4", "#a99ff5"),
    ("#6b7077", "#9aa1a9"),
)
_OWN = {
    "reference": INK,
    "mujoco": COLOURS[0],
    "pinocchio": COLOURS[1],
    "dart": COLOURS[2],
    "drake": COLOURS[3],
}
# As in SVG's stroke-dasharray, in px.
DASHES = (
    "",
    "9 4",
    "2 3",
    "9 3 2 3",
    "16 5",
    "5 3",
    "16 4 2 4",
    "9 3 2 3 2 3",
    "1 6",
    "16 3 5 3",
    "4 8",
    "20 4 9 4",
)


def colours(engines: Iterable[str]) -> dict[str, tuple[str, str]]:
    """(light, dark) by engine; the well-known keep theirs in every report.

    Each further one has the next colour that is far from all before it, and from the well-known
    whether they are in the report or not.
    """
    names = list(dict.fromkeys(engines))
    unknown = [name for name in names if name not in _OWN]
    given = dict(zip(unknown, further_colours(tuple(_OWN.values()), len(unknown)), strict=True))
    return {name: _OWN.get(name) or given[name] for name in names}


def dashes(engines: Iterable[Mapping[str, Any]]) -> dict[tuple[str, str], str]:
    """The dash by engine and integrator.

    Integrators of the same scheme share a dash across engines, and the commonest schemes have the
    plainest; a second one of that scheme within an engine takes the next that is free there.
    """
    # The yardstick itself is never drawn.
    own = {e["name"]: _schemes(e) for e in engines if e["name"] != "exact"}
    counted = Counter(s for found in own.values() for s in dict.fromkeys(found.values()))
    schemes = {scheme: place for place, (scheme, _) in enumerate(counted.most_common())}
    given: dict[tuple[str, str], str] = {}
    for engine, found in own.items():
        places = {name: schemes[scheme] % len(DASHES) for name, scheme in found.items()}
        first = {place: name for name, place in reversed(places.items())}
        free = [place for place in range(len(DASHES)) if place not in first] or [0]
        others = [name for name, place in places.items() if first[place] != name]
        places |= {name: free[k % len(free)] for k, name in enumerate(others)}
        given |= {(engine, name): DASHES[place] for name, place in places.items()}
    return given


def _schemes(engine: Mapping[str, Any]) -> dict[str, str]:
    """The scheme of each integrator; one that declares none has its own."""
    return {
        i["name"]: i.get("scheme") or f"{engine['name']} {i['name']}"
        for i in engine.get("integrators") or ()
    }


@dataclass(frozen=True)
class Line:
    """How one engine's integrator is drawn everywhere. colour: (light, dark); width in px."""

    engine: str
    integrator: str
    setup: str
    colour: tuple[str, str]
    dash: str
    width: float

    @property
    def name(self) -> str:
        """Its name in the legend and the hover text."""
        return f"{self.engine} {self.integrator}" + (self.setup != "physics") * f" ({self.setup})"


def lines_of(charts: Iterable[Chart], engines: list[Mapping[str, Any]]) -> list[Line]:
    """Every line on the page, in the order of the engines.

    The engines first in order are drawn broadest, below the others: where lines coincide, each
    stays visible.
    """
    runs = {(c.engine, c.setup, c.integrator): None for chart in charts for c in chart.deviations}
    order = {entry["name"]: place for place, entry in enumerate(engines)}
    names = sorted({engine for engine, _, _ in runs}, key=lambda n: (order.get(n, len(order)), n))
    colour, dash = colours(names), dashes(engines)
    narrower = 1.4 / max(3, len(names) - 1)
    width = {name: round(1.8 + narrower * k, 2) for k, name in enumerate(reversed(names))}
    lines = []
    for engine, setup, name in sorted(runs, key=lambda run: names.index(run[0])):
        broad = width[engine] * (1.0 if setup == "physics" else 0.5)
        lines.append(Line(engine, name, setup, colour[engine], dash.get((engine, name), ""), broad))
    return lines
