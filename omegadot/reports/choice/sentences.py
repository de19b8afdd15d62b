"""A choice as text, the same for the terminal and the page."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from omegadot.reports.record.run_json import impossible_bodies
from omegadot.reports.summary.headline import step_notes
from omegadot.reports.text.numbers import grouped, listed, plain, quantity, times
from omegadot.written import written

Row = Mapping[str, Any]
MOST_DIGITS = 17  # of a double
STEP_DIGITS = 3
NAMES = {
    "attitude": "attitude error",
    "omega": "omega error",
    "energy-drift": "energy drift",
    "momentum-drift": "momentum drift",
    "linear-momentum-drift": "linear momentum drift",
    "flip-time": "flip-time error",
    "real-time-factor": "real-time factor",
}
LONGEST = 3600.0  # s, for a run that a user might wait for


def step_text(timestep: float) -> str:
    """A step in s, rounded down to three digits, as it is known to 5 %: never above the step."""
    digits = STEP_DIGITS - 1 - math.floor(math.log10(timestep))
    scaled = math.floor(timestep * 10.0**digits * (1.0 + 1e-12))  # 0.002 is no 0.00199
    return written(scaled / 10.0**digits, STEP_DIGITS)


def setting_text(found: Row) -> str:
    """The step in s, or the accuracy of an integrator that chooses its own steps."""
    if found["timestep"] is None:
        return f"accuracy {written(found['accuracy'], 2)}"
    return step_text(found["timestep"])


def _setting(found: Row) -> str:
    text = setting_text(found)
    return text if found["timestep"] is None else f"{text} s"


def shown(value: float | None, row: Row, digits: int = 2) -> str:
    """A value of a requirement in the unit that its limit was written in; SI in older files."""
    own = row.get("shown") or {"unit": row["unit"], "si": 1.0}
    return quantity(None if value is None else value / own["si"], own["unit"], digits)


def requested(choice: Row) -> str:
    """The requirements as they were written, in one line."""
    wanted = choice["requirements"]
    message = [f"{NAMES[r['requirement']]} within {r['requested']}" for r in wanted["accuracy"]]
    if wanted["real_time_factor"] is not None:
        message.append(f"real-time factor of at least {plain(wanted['real_time_factor'])}")
    if wanted["precision"]:
        message.append(f"{wanted['precision']} precision")
    message += [f"feature {name}" for name in wanted["features"]]
    if wanted["licences"]:
        message.append(f"licence {' or '.join(wanted['licences'])}")
    if wanted["python"]:
        message.append(f"Python {wanted['python']}")
    return listed(message)


def _label(row: Row) -> str:
    return f"{row['engine']} {row['version']} {row['integrator']}"


def open_yet(guess: Row) -> bool:
    """Whether a candidate might qualify where its order predicts that the limits are met.

    It might not where such a run is one that nobody waits for, or misses another requirement.
    """
    return bool(guess["seconds"] <= LONGEST and not guess.get("missed"))


def headline(case: Row) -> str:
    """What came out of a case, in a sentence or two."""
    start = f"{case['name']}, {plain(case['duration'])} s: "
    if case["reason"]:
        return f"{start}nothing was chosen: {case['reason']}."
    if case["unverifiable"]:
        keys = listed([NAMES[key] for key in case["unverifiable"]])
        return f"{start}nothing qualifies: double precision cannot verify the requested {keys}."
    rows = case["candidates"]
    best = [row for row in rows if row["rank"] == 1]
    if not best:
        return start + _nothing(rows)
    more = sum(1 for row in rows if row["predicted"] and open_yet(row["predicted"]))
    open_ = f" ({more} more might, in runs longer than the budget)" if more else ""
    verb = "qualifies" if case["qualifying"] == 1 else "qualify"
    count = f"{case['qualifying']} of {times(len(rows), 'integrator')} {verb}{open_}"
    first = best[0]
    found = first["found"]
    kind = "a step of" if found["timestep"] is not None else "an"
    named = f"{_label(first)} with {kind} {_setting(found)}"
    named += f" ({times(found['steps'], 'step')})" if found["timestep"] is not None else ""
    if len(best) > 1:
        others = listed([_label(row) for row in best[1:]])
        return f"{start}{count}. The cheapest is {named}, within the timing error of {others}."
    return f"{start}{count}. The cheapest is {named}."


def _nothing(rows: Sequence[Row]) -> str:
    """Nothing qualifies; the nearest candidate, if anything ran."""
    ran = [row for row in rows if row["nearest"] and row["missed"]]
    if not ran:
        return "nothing qualifies, and nothing ran."
    near = min(ran, key=lambda row: max((m["factor"] or math.inf) for m in row["missed"]))
    return f"nothing qualifies. The nearest is {_label(near)}: {missed_text(near['missed'][0])}."


def _written(values: Sequence[float], row: Row) -> Iterator[tuple[str, ...]]:
    for digits in range(2, MOST_DIGITS):
        yield tuple(shown(value, row, digits) for value in values)


def missed_text(missed: Row) -> str:
    """One requirement that is missed, and by how much."""
    name = NAMES[missed["requirement"]]
    if missed["found"] is None or missed["factor"] is None:
        return f"{name} not finite"
    pair = [missed["limit"], missed["found"]]
    # As many digits as it takes to see that they differ.
    limit, found = next(
        (texts for texts in _written(pair, missed) if texts[0] != texts[1]),
        tuple(shown(value, missed) for value in pair),
    )
    wanted = "at least" if missed["requirement"] == "real-time-factor" else "at most"
    return f"{name} {found}, required {wanted} {limit} (off by {grouped(missed['factor'])}x)"


def variant_lines(case: Row) -> Iterator[str]:
    """How the ranking changes when a requirement is halved or doubled."""
    for variant in case["variants"]:
        if not (variant["order"] or variant["left"] or variant["joined"]):
            continue  # nothing qualifies in either case: there is no ranking to be the same
        term = {0.5: "halved", 2.0: "doubled"}.get(variant["factor"], f"x {variant['factor']}")
        limit = shown(variant["limit"], variant)
        start = f"{NAMES[variant['requirement']]} {term} ({limit}): "
        order = variant["order"]
        changes = []
        if variant["left"]:
            verb = "drop" if len(variant["left"]) > 1 else "drops"
            changes.append(f"{listed(variant['left'])} {verb} out")
        if variant["joined"]:
            verb = "qualify" if len(variant["joined"]) > 1 else "qualifies"
            changes.append(f"{listed(variant['joined'])} {verb} too")
        if not changes:
            changes.append("the ranking is the same" if variant["same"] else "the ranking changes")
        steps = [
            f"rank {o['rank']}{' (tied)' * o['tied']} {o['candidate']} at {_setting(o)}"
            for o in order
        ]
        yield start + "; ".join(changes) + (": " + ", ".join(steps) if steps else "") + "."


def notes(choice: Row) -> Iterator[str]:
    """Engines that were excluded, and open points about the others."""
    for engine in choice["engines"]:
        if not engine["installed"]:
            yield f"{engine['name']}: {engine['outcome']}: {engine['reason']}"
        for clause in engine["refused"]:
            yield f"{engine['name']} {engine['version']} is excluded: {clause}."
        if engine["note"] and not engine["refused"]:
            yield f"{engine['name']} {engine['version']}: {engine['note']}."
    yield from (f"{note}." for note in step_notes(choice["engines"]))
    for death in choice["worker_deaths"]:
        yield f"{death['engine']}: a worker died, {death['how']}"
    yield from impossible_bodies(choice["scenarios"])
    for case in choice["scenarios"]:
        for key in case["unverifiable"]:
            wanted = {r["requirement"]: r for r in choice["requirements"]["accuracy"]}[key]
            floor = shown(case["floor"][key], wanted)
            yield (
                f"{case['name']}: double precision resolves the {NAMES[key]} to {floor} only; "
                "require a larger limit."
            )


STEPS = (
    "The listed number of steps is the smallest verified one: it and all larger ones tried met "
    "every limit at every sample, and the next smaller one tried failed. It is known to 5 %; the "
    "step is the horizon over it, rounded down to three digits. The margin is the limit over the "
    "error. Candidates share a rank unless one costs over 5 % more in three of four timing rounds."
)
FACTOR = "The real-time factor counts stepping alone: median and quartiles."
ON_FRONT = (
    "A candidate is Pareto-optimal where no run tried is better in cost, error and memory at once."
)
GUARANTEE = f"{STEPS} {ON_FRONT} {FACTOR}"


def verdict_everywhere(choice: Row) -> str:
    """What came out of a set of scenarios."""
    best = [row["candidate"] for row in choice["everywhere"] if row["rank"] == 1]
    if not best:
        return "Nothing qualifies in every scenario."
    tie = " (within the timing error)" if len(best) > 1 else ""
    return f"Cheapest over all scenarios: {listed(best)}{tie}."
