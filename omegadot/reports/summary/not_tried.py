"""What the scenarios of a run do not have in them, and random systems do."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np

from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.advice import Advice
from omegadot.scenarios.random_systems import BLOCK

MOST_NAMED = 4
LEAST_TURN = 1e-12  # of a quaternion's scalar part, below one
# One is the other's own kind, or rules it out: no scenario is to be looked for with both.
NO_PAIRS = (
    ("a pivot at the origin", "a pivot off the origin"),
    ("a pivot at the origin", "a moving start"),
    ("a pivot off the origin", "a moving start"),
    ("a torque in body axes", "a torque in world axes"),
    ("gravity", "gravity off the -z axis"),
    ("a turned start", "a first quaternion of negative scalar part"),
)


def parts_of(system: Mapping[str, Any], initial: Mapping[str, Any]) -> dict[str, bool]:
    """What a scenario has in it besides a free body, by name.

    system: its numbers as in ``run.json``.  initial: the table of its file.
    """
    tensor, pivot = np.array(system["inertia"]), system["pivot"]
    products = np.abs(tensor - np.diag(np.diag(tensor)))
    gravity, scalar = system["gravity"], (initial.get("orientation") or [1.0])[0]
    return {
        "a pivot at the origin": pivot is not None and not any(pivot),
        "a pivot off the origin": pivot is not None and any(pivot),
        "a centre of mass off the origin": any(system["center_of_mass"]),
        "gravity": any(gravity),
        "gravity off the -z axis": any(gravity[:2]) or gravity[2] > 0.0,
        "damping": bool(system["damping"]),
        "a torque in body axes": any(system["torque_body"]),
        "a torque in world axes": any(system["torque_world"]),
        "products of inertia": bool(np.any(products > 1e-12 * np.max(tensor))),
        "a turned start": abs(scalar) < 1.0 - LEAST_TURN,
        "a first quaternion of negative scalar part": scalar < 0.0,
        "a moving start": any(initial.get("linear_velocity") or ()),
    }


def pairs_of(parts: Iterable[str]) -> list[tuple[str, str]]:
    """Every two parts that one system may have together without one implying the other."""
    return [pair for pair in combinations(parts, 2) if pair not in NO_PAIRS]


def not_tried(run: Mapping[str, Any], passed: Sequence[str]) -> Advice | None:
    """What none of the scenarios that an engine passed has in it, and what to do about it.

    None where they have everything, or no engine can be checked.  passed: scenarios, by name.
    """
    ours = [e for e in run["engines"] if e["name"] not in YARDSTICKS and e.get("argument")]
    found = [
        parts_of(entry["system"], (entry.get("definition") or {}).get("initial") or {})
        for entry in run["scenarios"]
        if entry["name"] in passed and entry.get("system")
    ]
    if not found or not ours:
        return None
    absent = [name for name in found[0] if not any(parts[name] for parts in found)]
    pairs = pairs_of(name for name in found[0] if name not in absent)
    apart = [
        pair for pair in pairs if not any(parts[pair[0]] and parts[pair[1]] for parts in found)
    ]
    texts = [*absent[:MOST_NAMED]]
    if len(absent) > MOST_NAMED:
        texts.append(f"{len(absent) - MOST_NAMED} more")
    if apart:
        texts.append("some of the others in one system")
    if not texts:
        return None
    engine = ours[0]["argument"] if len(ours) == 1 else "ENGINE"
    return Advice(
        f"Not tested here: {'; '.join(texts)}.",
        f"omegadot check {shlex.quote(engine)}",
        f"draws {BLOCK} random systems, with all of them among these",
    )
