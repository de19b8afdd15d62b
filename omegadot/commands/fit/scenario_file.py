"""The scenario of a fit, and its file."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from omegadot.commands.fit.estimates import Estimates
from omegadot.commands.fit.samples import Samples
from omegadot.reference_impl.system import Array
from omegadot.scenarios import Scenario, scenario

MARK = "# Fitted to a log by omegadot fit."
STEPS = (1.0, 0.5, 0.25)  # of the samples' interval


def scenario_of_fit(
    samples: Samples, own: Estimates, torque: Array, mass: float, name: str | None
) -> Scenario:
    """The body, its state at the first sample, and its load. Raises ScenarioError for the name."""
    duration = float(samples.times[-1] - samples.times[0])
    interval = min(_shortest(float(np.median(np.diff(samples.times))), samples.tick), duration)
    initial = {"angular_velocity": own.omega}
    if own.orientation is not None:
        initial["orientation"] = own.orientation
    inertia = 0.5 * (own.inertia + own.inertia.T)
    return scenario(
        name=name or _name(samples.file),
        title=f"Fitted to {_printable(Path(samples.file).name)}",
        body={"mass": mass, "inertia": inertia},
        initial=initial,
        load={
            "damping": max(own.damping, 0.0),
            "torque": {"frame": "body", "value": torque},
        },
        run={
            "duration": duration,
            "timesteps": [float(f"{step * interval:.3g}") for step in STEPS],
            "sample": interval,
        },
    )


def _shortest(value: float, within: float) -> float:
    """The number with the fewest digits that is so near: differences of times end in rounding."""
    found = (float(f"{value:.{digits}g}") for digits in range(1, 17))
    return next((number for number in found if abs(number - value) <= within), value)


def _name(file: str) -> str:
    """Kebab-case, of the file's."""
    stem = "-".join(re.findall(r"[a-z0-9]+", Path(file).stem.lower()))[:50].strip("-")
    return f"{stem or 'trace'}-fit"


def _printable(text: str) -> str:
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def text_of(found: Scenario, comments: list[str]) -> str:
    """The file: comments, then every key."""
    lines = [MARK] + [f"# {_printable(' '.join(comment.split()))}" for comment in comments]
    return "\n".join([*lines, *_table(found.to_dict(), "")]) + "\n"


def _table(table: dict[str, Any], prefix: str) -> Iterator[str]:
    for key, value in table.items():
        if not isinstance(value, dict):
            yield f"{key} = {json.dumps(value, ensure_ascii=False)}"
    for key, value in table.items():
        if isinstance(value, dict):
            yield f"\n[{prefix}{key}]"
            yield from _table(value, f"{prefix}{key}.")
