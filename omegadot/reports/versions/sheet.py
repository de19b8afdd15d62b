"""What was found of several versions of an engine, as text: the same sheet for every format."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from omegadot.reports.text.numbers import listed, plain, times
from omegadot.reports.text.text_grid import Grid
from omegadot.reports.versions.changes import RATIO, Line, lines_of, pace_lines, pace_text, runs_of

Record = dict[str, Any]
MOST_NAMED = 4
NOTHING = "nothing changed beyond rounding"


@dataclass(frozen=True)
class Part:
    """A step from one version to another, with what changed; several without a change are one."""

    head: str
    lines: list[Line]


@dataclass(frozen=True)
class Sheet:
    """title: one line.  absent: versions that did not run.  wrong: faults and troubles."""

    title: str
    remarks: list[str]
    absent: list[Line]
    parts: list[Part]
    tables: list[Grid]
    wrong: list[Line]


def sheet_of(record: Record) -> Sheet:
    """The sheet of a record."""
    versions = record["versions"]
    known = [version for version in versions if version["outcome"] == "ok"]
    return Sheet(
        title=_title(record, known),
        remarks=_remarks(record),
        absent=[
            (v["version"], f"{v['outcome']}: {v['reason']}") for v in versions if v not in known
        ],
        parts=_bisected(record["bisect"]) if record["bisect"] else _parts(record["steps"]),
        tables=[] if record["bisect"] else [t for t in _tables(record, known) if t.rows],
        wrong=[(v["version"], text) for v in known for text in _wrong(v)],
    )


def _wrong(version: Record) -> list[str]:
    """What is not as declared, in full, and the first of the queries that failed."""
    troubles = version["troubles"]
    more = [f"and {len(troubles) - MOST_NAMED} more queries"]
    return [*version["faults"], *troubles[:MOST_NAMED], *more[: len(troubles) > MOST_NAMED]]


def _title(record: Record, known: Sequence[Record]) -> str:
    engine, package = record["engine"], record["package"]
    named = engine if engine == package else f"{engine} ({package})"
    requested = times(len(record["versions"]), "version")
    if not known:
        return f"{named}: {requested}, none of which ran"
    ends = f"{known[0]['version']} to {known[-1]['version']}"
    if record["bisect"]:
        return f"{named} {ends}: {record['bisect']['query']}"
    changed = sum(bool(step["changes"]) for step in record["steps"])
    some = "" if len(known) == len(record["versions"]) else f"{len(known)} of "
    return f"{named} {ends}: {some}{requested}, {times(changed, 'step')} with changes"


def _remarks(record: Record) -> list[str]:
    bisected = record["bisect"]
    if bisected is None:
        cases = [f"{c['name']} ({plain(c['timestep'])} s)" for c in record["cases"]]
        way = record.get("via", "api")
        read = "" if way == "api" else f", bodies read from {way} by the engine itself"
        return [f"Run on {listed(cases)}, setup {record['setup']}{read}."]
    followed = bisected["metrics"]
    if not followed:  # no release ran, so that no metric is known
        return [f"Releases run: {listed(bisected['looked_at'])}."]
    named = listed(followed) if len(followed) <= MOST_NAMED else times(len(followed), "metric")
    return [
        f"Followed: {named}.",
        f"Releases run: {listed(bisected['looked_at'])}. Between two equal releases "
        "nothing is assumed to change.",
    ]


def _parts(steps: Sequence[Record]) -> list[Part]:
    parts: list[Part] = []
    for changed, group in groupby(steps, _changed):
        own = list(group)
        if not changed:
            parts.append(Part(f"{own[0]['from']} → {own[-1]['to']}", [("", NOTHING)]))
            continue
        for step in own:
            lines = lines_of(step["changes"]) or [("", NOTHING)]
            parts.append(Part(f"{step['from']} → {step['to']}", lines + pace_lines(step)))
    return parts


def _changed(step: Record) -> bool:
    return bool(step["changes"] or pace_lines(step))


def _bisected(bisected: Record) -> list[Part]:
    low, high = bisected["low"], bisected["high"]
    if high is None:
        return [Part("", [("", "fewer than two versions ran: nothing to compare")])]
    if not bisected["found"]:
        return [Part(f"{low} → {high}", [("", f"the ends do not differ: {NOTHING}")])]
    parts = []
    for step in bisected["found"]:
        lines = lines_of(step["changes"])
        if step["skipped"]:
            lines.append(("", f"{listed(step['skipped'])} between them did not run"))
        parts.append(Part(f"changed in {step['to']} (after {step['from']})", lines))
    return parts


def _tables(record: Record, known: Sequence[Record]) -> Iterator[Grid]:
    rows: list[tuple[str, ...]] = [(what, _values(known, what)) for what in _history(record, known)]
    yield Grid("History", ("figure", "versions"), rows)
    names = list(dict.fromkeys(name for v in known for name in v["integrators"]))
    yield Grid(
        "Time per step, µs: median (min–max)",
        ("version", *names),
        [(v["version"], *(_pace(v["seconds_per_step"].get(n)) for n in names)) for v in known]
        if any(v["seconds_per_step"] for v in known)
        else [],
    )


def _pace(pace: Record | None) -> str:
    if pace is None:
        return "–"
    return pace_text(*(1e6 * pace[name] for name in ("median", "least", "most")))


def _history(record: Record, known: Sequence[Record]) -> list[str]:
    """The figures whose history is shown: conventions and defaults that changed, and for each
    integrator its schemes, its order in attitude and its error on the first case.
    """
    reported = {
        change["metric"]
        for step in record["steps"]
        for change in step["changes"]
        if change["kind"] in ("convention", "default", "setup")
    }
    first = record["cases"][0]
    last = RATIO if first["energy_ratio"] else "attitude"
    case = f":{plain(first['timestep'])}:{last}"
    names = list(dict.fromkeys(name for v in known for name in v["figures"]))
    integrators = dict.fromkeys(name for v in known for name in v["integrators"])
    found = [name for name in names if name in reported]
    for integrator in integrators:
        found += [f"scheme:{integrator}:{kind}" for kind in ("free", "pivoted-damped")]
        found.append(f"order:{integrator}:free:attitude")
        found.append(f"drift:{first['name']}:{integrator}{case}")
    return [name for name in found if name in names]


def _values(known: Sequence[Record], metric: str) -> str:
    texts = [(v["version"], v["figures"].get(metric, {"text": "none"})["text"]) for v in known]
    return "; ".join(f"{versions}: {text}" for versions, text in runs_of(texts))
