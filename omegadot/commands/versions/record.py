"""What was found as plain data: printed as JSON, and all that tables and the page are made of."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from omegadot import __version__
from omegadot.commands.versions.aims import conserves_kinetic_energy
from omegadot.commands.versions.bisection import Bisection
from omegadot.commands.versions.changes import (
    Change,
    Portrait,
    changes_between,
    integrator_of,
    pace_changes,
    pace_of,
)
from omegadot.commands.versions.gallery import Gallery
from omegadot.commands.versions.metric import Figure, Name, shown, title
from omegadot.workers.machine import describe_machine

SCHEMA = 1
Record = dict[str, Any]


def record_of(
    gallery: Gallery, portraits: Sequence[Portrait], bisection: Bisection | None
) -> Record:
    """Versions, rising, with what changed from each to the next that could be measured."""
    steps = []
    for one, other in pairwise(p for p in portraits if p.ok and bisection is None):
        paces = {name: vars(ratio) for name, ratio in pace_changes(one, other).items()}
        steps.append({**_step(one, other, changes_between(one, other)), "paces": paces})
    return {
        "schema": SCHEMA,
        "omegadot": __version__,
        "engine": gallery.product.engine,
        "package": gallery.product.package,
        "setup": gallery.setup,
        "via": gallery.via,
        "machine": describe_machine(),
        "cases": [
            {
                "name": case.name,
                "title": case.scenario.title,
                "timestep": case.sweeps[0].timestep,
                "duration": case.sweeps[0].timestep * case.sweeps[0].steps,
                "energy_ratio": conserves_kinetic_energy(case),
            }
            for case in gallery.aims.cases
        ],
        "versions": [_version(portrait) for portrait in portraits],
        "steps": steps,
        "bisect": bisection and _bisection(bisection),
    }


def _step(before: Portrait, after: Portrait, changes: Sequence[Change]) -> Record:
    changed = [_change(change) for change in changes]
    return {"from": before.version, "to": after.version, "changes": changed}


def _version(portrait: Portrait) -> Record:
    paces = {name: pace_of(times) for name, times in portrait.speeds.items()}
    left_out = ("has", "unreported", "speeds")
    return {
        **{name: value for name, value in vars(portrait).items() if name not in left_out},
        "figures": {title(name): _figure(name, f) for name, f in portrait.figures.items()},
        "seconds_per_step": {name: vars(pace) for name, pace in paces.items() if pace},
    }


def _figure(name: Name, figure: Figure | None) -> Record | None:
    if figure is None:
        return None
    number = figure.value
    finite = not isinstance(number, float) or math.isfinite(number)
    return {
        "value": number if finite else None,
        "band": figure.band if math.isfinite(figure.band) else None,
        "text": shown(name, figure),
    }


def _change(change: Change) -> Record:
    """A change, with the parts of its name that identify it."""
    return {
        "metric": title(change.name),
        "kind": change.name[0],
        "integrator": integrator_of(change.name),
        "name": list(change.name),
        "before": _figure(change.name, change.before),
        "after": _figure(change.name, change.after),
        "size": change.size if math.isfinite(change.size) else None,
    }


def _bisection(found: Bisection) -> Record:
    """The releases found, and what was looked at on the way."""
    return {
        "query": found.query,
        "metrics": [title(name) for name in found.metrics],
        "low": found.low.version if found.low else None,
        "high": found.high.version if found.high else None,
        "looked_at": [portrait.version for portrait in found.looked_at],
        "found": [
            {**_step(step.before, step.after, step.changes), "skipped": step.skipped}
            for step in found.steps
        ],
    }
