"""What explains the failures of a check: causes, and where none is named what is known instead."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from omegadot.commands.check.judge import CAUSE
from omegadot.commands.check.result import Check, Result
from omegadot.commands.check.shrink import UNKNOWN, Failing
from omegadot.reports.text.numbers import first, listed, short, times
from omegadot.written import written

MOST_CAUSES = 8
MOST_NAMES = 3
MOST_STEPS = 4
ELSEWHERE, HERE = re.compile(r"^on \d+ other scenarios?: "), "; here: "
INDENT = " " * 10


def explained(results: Mapping[Check, Result], failing: Sequence[Failing]) -> list[str]:
    """How many failed checks each cause explains, and where; none where one message has a cause.

    failing: the smallest systems, of which the one of a failure without a cause is named.
    """
    failed = {check: r.message for check, r in results.items() if r.verdict == "fail"}
    groups: dict[str, list[Check]] = {}
    for check, message in failed.items():
        groups.setdefault(_cause(message), []).append(check)
    if not failed or (len(set(failed.values())) < 2 and all(map(_is_named, groups))):
        return []
    ranked = sorted(groups.items(), key=lambda item: -len(item[1]))
    lines = [f"What explains the {times(len(failed), 'failed check')}:"]
    for cause, checks in ranked[:MOST_CAUSES]:
        if _is_named(cause):
            lines.append(f"    {len(checks):4d}  {cause} ({_where(checks)})")
            continue
        lines.append(f"    {len(checks):4d}  no cause was found ({_where(checks)}); what is known:")
        facts = _facts(cause, checks, results, [failed[check] for check in checks])
        lines += [f"{INDENT}{fact}" for fact in (*facts, *_smallest(checks, failing))]
    rest = sum(len(checks) for _, checks in ranked[MOST_CAUSES:])
    return lines + [f"    {rest:4d}  others, named below"] * bool(rest)


def _cause(message: str) -> str:
    """The cause that ends a message; that of other scenarios is the one that these have."""
    cause = message.partition(CAUSE)[2].rstrip(".")
    return cause if HERE in cause else ELSEWHERE.sub("", cause)


def _is_named(cause: str) -> bool:
    return bool(cause) and not cause.startswith(UNKNOWN)


def _where(checks: Sequence[Check]) -> str:
    """In which gates of the engine, and in the runs of which integrators."""
    gates = sorted({check.gate for check in checks if not check.integrator})
    runs = sorted({check.integrator for check in checks if check.integrator})
    found = [f"{listed(gates)} gate{'s' * (len(gates) > 1)}"] if gates else []
    return ", ".join([*found, *([f"runs of {listed(runs)}"] if runs else [])])


def _facts(
    cause: str, checks: Sequence[Check], results: Mapping[Check, Result], messages: Sequence[str]
) -> Iterator[str]:
    """A fact a line: what is off and on what it depends, then on which scenarios and steps."""
    known = cause.removeprefix(UNKNOWN).lstrip("; ")
    yield from known.split("; ") if known else [_off(messages)]
    tested = {check.scenario for check in results if check.gate in {c.gate for c in checks}}
    names = list(dict.fromkeys(check.scenario for check in checks))
    of = f"of {times(len(tested), 'scenario')}"
    yield f"it fails on {'all' if len(names) == len(tested) else len(names)} {of}" + (
        f": {first(names, MOST_NAMES)}" if len(names) < len(tested) else ""
    )
    yield from filter(None, (_steps(checks, results), _by_step(checks, results)))


def _off(messages: Sequence[str]) -> str:
    """What is off, by the channel that begins a message."""
    channels = dict.fromkeys(m.partition(":")[0] for m in messages if ":" in m)
    return f"what is off: {listed(list(channels))}" if channels else messages[0]


def _steps(checks: Sequence[Check], results: Mapping[Check, Result]) -> str:
    """Whether the failing runs are those of long steps alone, or of short ones; "" of neither.

    Of every scenario, integrator and gate on which one fails: the steps of the other runs.
    """
    runs = [check for check in checks if check.timestep is not None]
    keys = {(c.scenario, c.integrator, c.gate) for c in runs}
    fail: list[list[bool]] = []
    for key in keys:
        own = [c for c in results if (c.scenario, c.integrator, c.gate) == key]
        judged = [c for c in own if results[c].verdict in ("pass", "fail")]
        judged.sort(key=lambda c: c.timestep or 0.0)
        fail.append([results[c].verdict == "fail" for c in judged])
    if not fail:
        return ""
    if all(map(all, fail)):
        return "it fails at every step"
    if all(one == sorted(one) for one in fail):
        least = min(c.timestep or 0.0 for c in runs)
        return f"it fails at long steps alone, from {written(least)} s on; finer ones pass"
    if all(one == sorted(one, reverse=True) for one in fail):
        most = max(c.timestep or 0.0 for c in runs)
        return f"it fails at fine steps alone, up to {written(most)} s; longer ones pass"
    return ""


def _by_step(checks: Sequence[Check], results: Mapping[Check, Result]) -> str:
    """``on t-handle by a: 2e5 times its bound at 0.02 s, 6000 at 0.01 s``, of the longest sweep."""
    sweeps: dict[tuple[str, str | None, str], dict[float, float]] = {}
    for check in checks:
        excess = results[check].excess
        if excess is not None and check.timestep is not None:
            key = (check.scenario, check.integrator, check.gate)
            sweeps.setdefault(key, {})[check.timestep] = excess
    if not sweeps or max(map(len, sweeps.values())) < 2:
        return ""
    (scenario, integrator, _), found = max(sweeps.items(), key=lambda item: len(item[1]))
    first_step, *rest = sorted(found.items(), reverse=True)[:MOST_STEPS]
    text = f"{short(first_step[1])} times its bound at {written(first_step[0])} s"
    others = (f"{short(excess)} at {written(step)} s" for step, excess in rest)
    return f"on {scenario} by {integrator}: {', '.join([text, *others])}"


def _smallest(checks: Sequence[Check], failing: Sequence[Failing]) -> Iterator[str]:
    """What is left in the smallest system on which one of these fails."""
    for one in failing:
        if one.check in checks:
            left = listed(list(one.has)) if one.has else "a free body on which nothing acts"
            yield f"left in the smallest failing system, printed below: {left}"
            return
