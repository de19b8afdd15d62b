"""The findings as a page: a table of what happens and what mends it, and a section for each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby

from omegadot.commands.findings.entry import REACHES
from omegadot.commands.findings.findings import FindingsResult
from omegadot.commands.findings.verdict import SAME, Finding
from omegadot.written import written

AGAIN = "omegadot findings --format markdown > docs/findings.md"
HEAD = f"""# Findings

<!-- Made by a command. Do not edit; run it again:
{AGAIN} -->

Where engines move a body otherwise than the Newton-Euler equations do, in the releases that are
named. Each finding was measured in two ways that share no code: in the record of a run, and by a
bare script over the engine's own API. It stands here because both have the same figure, to
{written(100 * SAME)} % (of an order, to the whole number), and the exact solution has another.
{{count}}

First come findings that meet an ordinary body, then those of bodies that are slow, fast, small or
large. Among them the largest figure is first, and orders are last. What mends a finding is in the
engine's own words.
"""
NOTES = """
**How to read a section.** *Record* makes the record of which the figure is: the row of
`metrics.parquet` that is named, at the step that is named. It is an error or a drift, the largest
of the run. Beside it is the most that rounding may do to it ([how](method.md)). Those of omega,
energy and momentum are relative. With `--setup both` an engine runs with all its defaults, `as
shipped`, and with those switched off that disturb the motion, in the setup `physics`. *Script* is
the second way, for an environment that has the engine. Node finds packages in the folder that
`NODE_PATH` names; `omegadot engines --install node` fills `omegadot/node/node_modules` of the
user's cache.

**A new finding** is one file in [docs/findings](findings): a script, with a table at its head of
what it claims. `omegadot findings RECORD... --reproduce` measures it both ways and writes the
figures to `measured.json` there. This page is drawn from those alone.
"""
CHANNELS = {"angular_momentum": "angular momentum", "linear_momentum": "momentum"}


def markdown_of(found: FindingsResult) -> str:
    """The page."""
    standing = found.standing
    engines = len({one.entry.engine for one in standing})
    parts = [HEAD.format(count=f"There are {len(standing)}, of {engines} engines.")]
    parts += [_overview(standing), NOTES]
    for reach, own in groupby(standing, lambda one: one.entry.reach):
        parts += [f"\n## {REACHES[reach]}\n", *map(_section, own)]
    return "\n".join([*parts, _doubted(found.doubted)])


def _overview(standing: Iterable[Finding]) -> str:
    rows = [("engine", "what happens", "kind", "off by", "what mends it"), ("---",) * 5]
    for one in standing:
        mends = f"`{one.entry.mends}`" if one.entry.mends else "–"
        link = f"[{one.entry.title}](#{anchor(_title(one))})"
        engine = f"{one.entry.engine} {one.measured.release}"
        rows.append((engine, link, one.entry.kind, figure(one), mends))
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _title(one: Finding) -> str:
    return f"{one.entry.engine}: {one.entry.title}"


def anchor(title: str) -> str:
    """The name of a heading in links, as Markdown on the web has it."""
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def figure(one: Finding) -> str:
    """What the record has: ``omega, 52 %``, ``attitude, 0.0074 rad``, ``order 2 in place of 4``."""
    value, expected = one.measured.value, one.entry.expected
    _, channel, metric = one.entry.row
    if expected is not None:
        of = CHANNELS.get(channel, channel)
        return f"{of}, order {written(value, 2)} in place of {written(expected)}"
    of = metric if channel == "model" else channel
    return f"{CHANNELS.get(of, of)}, {quantity(value, one)}"


def quantity(value: float | None, one: Finding) -> str:
    """A figure with its unit: what is relative in per cent, or in times, or by its power of ten."""
    unit = one.measured.unit
    if unit != "1" or value is None:
        return f"{written(value, 2)} {unit}"
    if abs(value) >= 10.0:
        return f"{written(value, 2)} times its size"
    return f"{written(100 * value, 2)} %" if abs(value) >= 1e-4 else written(value, 2)


def _section(one: Finding) -> str:
    entry, measured = one.entry, one.measured
    lines = [
        f"### {_title(one)}",
        "",
        f"{entry.what} {entry.why}",
        "",
        f"- Measured: {_both(one)}.",
    ]
    if entry.mends:
        left = quantity(measured.script_mended, one)
        lines += [f"- What mends it: `{entry.mends}`. {left} is left, by the script."]
    else:
        lines += ["- What mends it: nothing that the engine offers."]
    lines += [f"- Record: `{record_command(one)}`", f"- Script: `{script_command(one)}`"]
    return "\n".join([*lines, f"- Source: <{entry.link}>", ""])


def _both(one: Finding) -> str:
    """The figures of both ways, the bound, and that of the run set up for physics."""
    entry, measured = one.entry, one.measured
    order = entry.expected is not None
    by_script = measured.script_value
    again = written(by_script, 2) if order else quantity(by_script, one)
    where = f"`{entry.metric}` of `{entry.scenario_name}`"
    if not entry.metric.startswith(("model/", "equation/")):
        where += f" at {written(entry.timestep)} s"
    text = f"{figure(one)} in the record ({where}), {again} by the script"
    if not order and measured.bound is not None:
        text += f"; rounding does {quantity(measured.bound, one)} at most"
    if entry.setup != "physics" and measured.physics is not None:
        text += f"; {quantity(measured.physics, one)} in the setup `physics`"
    return text


def record_command(one: Finding) -> str:
    """What makes a record with the run in it, and the same set up for physics."""
    entry = one.entry
    setup = " --setup both" if entry.setup != "physics" else ""
    return f"omegadot run {entry.scenario} --engine {entry.engine}:{entry.integrator}{setup}"


def script_command(one: Finding) -> str:
    """What runs the script, from the folder of the project."""
    script = one.entry.script
    program = "python" if script.suffix == ".py" else "node"
    return f"{program} {script.as_posix()}"


def _doubted(doubted: Sequence[Finding]) -> str:
    lines = ["\n## Not reproduced", ""]
    if not doubted:
        return "\n".join([*lines, "None: each finding that is declared was reproduced.", ""])
    lines += ["Declared, and not shown by both ways:", ""]
    lines += [f"- **{_title(one)}** (`{one.entry.script.name}`): {one.doubt}." for one in doubted]
    return "\n".join([*lines, ""])
