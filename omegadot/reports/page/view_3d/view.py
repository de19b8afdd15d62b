"""What the page's 3-D view is drawn from: shapes as JSON, attitudes as 16-bit codes.

An engine's attitude travels as the rotation from the exact attitude to it, which is zero to the
code's step wherever the engine is right: so the runs of a whole record take a few score kB.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import polars as pl

from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array
from omegadot.reports.charts.chart_library import packed_three
from omegadot.reports.charts.deviations import Chart
from omegadot.reports.charts.divergence import system_from
from omegadot.reports.charts.packing import pack_codes, pack_json, rounded
from omegadot.reports.charts.palette import Line
from omegadot.reports.charts.payload import rank_of
from omegadot.reports.page.templating import script
from omegadot.reports.page.view_3d.attitudes import DIVERGED, Attitudes, attitudes_of
from omegadot.reports.page.view_3d.bodies import look_of
from omegadot.reports.page.view_3d.opening import (
    Key,
    failing_runs,
    key_of,
    lane_of,
    opening,
)
from omegadot.reports.page.view_3d.turning import Turning, turning_of
from omegadot.reports.record.record import Record
from omegadot.reports.summary.orders import Orders, declared_orders
from omegadot.reports.text.numbers import knob

# A unit, half a turn, and this many times the scenario's greatest omega each have code 32767.
_LARGEST = 32767
_SPINS = 8.0
# One idea a file; what comes first is used by what comes after.
_SCRIPTS = (
    *("unpack", "written", "view_trajectory", "view_shapes", "view_scene", "view_polhode"),
    *("view_canvas", "view_stage", "view_wall", "view_errors", "view_clock", "view_runs", "view"),
)


class Codes:
    """Numbers as 16-bit codes in two's complement, one table after the other."""

    def __init__(self) -> None:
        self._parts: list[Array] = [np.empty(0)]
        self.used = 0

    def add(self, rows: Array, largest: float) -> None:
        """A table, column by column; what is beyond `largest` ends there."""
        self._parts.append(rows.T.ravel() / largest)
        self.used += rows.size

    def all(self) -> Array:
        """All of them, (used,) uint16."""
        share = np.clip(np.concatenate(self._parts), -1.0, 1.0)
        codes: Array = np.rint(share * _LARGEST).astype(np.int16).view(np.uint16)
        return codes


def view_section(
    record: Record, charts: Mapping[str, Chart], lines: list[Line], anchors: Mapping[str, str]
) -> dict[str, Any]:
    """What the template of the 3-D view takes: the scenarios' names, packed data, the script."""
    description, codes = view_payload(record, charts, lines)
    for scenario in description["scenarios"]:
        scenario["anchor"] = anchors[scenario["name"]]
    return {
        "scenarios": description["scenarios"],
        "diverged": description["diverged"],
        "three": packed_three() if description["scenarios"] else "",
        "data": pack_json(description),
        "codes": pack_codes(codes),
        "js": script(_SCRIPTS),
    }


def view_payload(
    record: Record, charts: Mapping[str, Chart], lines: list[Line]
) -> tuple[dict[str, Any], Array]:
    """The script's description of every body and run, and all their codes in a row.

    Each scenario's codes begin with its exact solution, w x y z of the attitude and then omega,
    one row of as many codes as it has times each. A run is ``[line, rank, knob, frames, start,
    count, diverges, largest, end, gates, flips, turns]``: six rows of `count` codes from `start`,
    the rotation from the exact attitude and omega less the exact one, at the exact times numbered
    in ``frames``; gates, those that fail; the last two, as in `Turning`, where the exact motion
    has ``flips``.  first, rank and everyone: the lines and the step to open with, and whether with
    every engine.
    """
    places = {(line.engine, line.setup, line.integrator): k for k, line in enumerate(lines)}
    attitudes, failing = attitudes_of(record.trajectories), failing_runs(record.run["tasks"])
    orders = declared_orders(record.run["engines"])
    scenarios: list[dict[str, Any]] = []
    codes = Codes()
    for entry in record.run["scenarios"]:
        own, chart = attitudes.get(entry["name"]), charts.get(entry["name"])
        if own is None or chart is None or not entry.get("system"):
            continue
        system = system_from(entry["system"])
        look = look_of(system, entry.get("definition") or {}, own.angular_velocity[0])
        rows = record.trajectories.filter(pl.col("scenario") == entry["name"])
        turning = turning_of(rows, system, own.truth)
        fastest = float(np.abs(own.angular_velocity).max()) or 1.0
        scenario: dict[str, Any] = {
            "name": entry["name"],
            "title": entry.get("title") or entry["name"],
            "times": [rounded(t, 7) for t in own.time],
            "start": codes.used,
            "fastest": fastest,
            "coarse": own.coarse,
            "truth": own.truth,
            "pivot": entry["system"].get("pivot") is not None,
            "flips": turning.exact,
            **look.payload(),
        }
        codes.add(normalize(own.orientation), 1.0)
        codes.add(own.angular_velocity, fastest)
        failed = failing.get(entry["name"], {})
        scenario.update(_runs(own, chart, places, codes, fastest, failed, orders, turning))
        scenarios.append(scenario)
    description = {
        "lines": [
            {
                "name": line.name,
                "engine": line.engine + (line.setup != "physics") * f" ({line.setup})",
                "integrator": line.integrator,
                "colour": line.colour,
            }
            for line in lines
        ],
        "diverged": float(np.rad2deg(DIVERGED)),
        "spins": _SPINS,
        "scenarios": scenarios,
    }
    return description, codes.all()


def _runs(
    own: Attitudes,
    chart: Chart,
    places: Mapping[tuple[str, str, str], int],
    codes: Codes,
    fastest: float,
    failing: Mapping[Key, list[str]],
    orders: Orders,
    turning: Turning,
) -> dict[str, Any]:
    ranks = rank_of(chart)
    clocks: dict[bytes, int] = {}
    runs = []
    shown = [
        run for run in own.runs if lane_of(run) in places and (run.timestep, run.accuracy) in ranks
    ]
    shown.sort(key=lambda run: places[lane_of(run)])
    opened = opening(shown, ranks, failing, orders)
    for run in shown:
        line, rank = places[lane_of(run)], ranks[run.timestep, run.accuracy]
        clock = clocks.setdefault(run.frames.tobytes(), len(clocks))
        texts = knob(run.timestep, run.accuracy)
        # When it diverges, s, its largest error, degrees, and when its samples end, s.
        reported = run.diverges, rounded(np.rad2deg(run.largest), 3), run.end
        gates = ", ".join(failing.get(key_of(run), ()))
        turned = turning.runs.get(key_of(run), ())
        runs.append(
            [line, rank, texts, clock, codes.used, len(run.frames), *reported, gates, *turned]
        )
        codes.add(run.error, np.pi)
        codes.add(run.spin, _SPINS * fastest)
    frames = [np.frombuffer(clock, int).tolist() for clock in clocks]
    return {
        "frames": frames,
        "runs": sorted(runs, key=lambda entry: entry[:2]),
        "first": [places[lane] for lane in opened.lanes],
        "rank": opened.rank,
        "everyone": opened.everyone,
    }
