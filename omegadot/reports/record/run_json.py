"""``run.json``: strict JSON, and the parts of it that tables and page stand on."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from omegadot.reports.record import schema
from omegadot.reports.record.schema import RecordError
from omegadot.scenarios.tensor import ALLOWED, broken_triangle


def read_run(path: Path) -> dict[str, Any]:
    """Read ``run.json``; RecordError, one sentence, where it is not one of this schema."""
    try:
        run = json.loads(path.read_text(encoding="utf-8"), parse_constant=_refuse_constant)
    except (OSError, ValueError, RecursionError) as error:
        raise RecordError(f"{path}: not readable as JSON ({error}); run again.") from error
    if not isinstance(run, dict) or "schema" not in run:
        raise RecordError(f"{path}: has no key 'schema', so it is not an omegadot record.")
    if run["schema"] != schema.SCHEMA:
        raise RecordError(
            f"{path}: schema is {run['schema']!r}, this omegadot reads {schema.SCHEMA}; "
            "use the version that wrote it."
        )
    check_run(run, str(path))
    return run


def check_run(run: dict[str, Any], where: str) -> None:
    """Raise RecordError unless the parts that tables and page stand on are there."""
    for key in ("engines", "scenarios", "tasks"):
        entries = run.get(key)
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            raise RecordError(f"{where}: {key} must be a list of objects; run again.")
    needed = {"engines": ("name",), "scenarios": ("name",), "tasks": ("scenario", "engine")}
    for key, names in needed.items():
        for number, entry in enumerate(run[key]):
            for name in names:
                if not isinstance(entry.get(name), str):
                    raise RecordError(f"{where}: {key}[{number}].{name} must be a text; run again.")
    _check_clusters(run.get("clusters", []), where)
    for number, task in enumerate(run["tasks"]):
        _check_value(task.get("outcome"), schema.OUTCOMES, f"{where}: tasks[{number}].outcome")
        for gate, verdict in (task.get("gates") or {}).items():
            _check_value(verdict, schema.VERDICTS, f"{where}: tasks[{number}].gates.{gate}")


def impossible_bodies(scenarios: Iterable[Mapping[str, Any]]) -> list[str]:
    """A sentence on each. scenarios: rows with `name` and `definition`, as records have them."""
    found = []
    for entry in scenarios:
        body = (entry.get("definition") or {}).get("body") or {}
        broken = broken_triangle(np.array(body["inertia"])) if body.get(ALLOWED) else None
        if broken:
            found.append(
                f"{entry['name']}: an impossible inertia, allowed on request: its greatest"
                f" principal moment exceeds the sum of the other two ({broken} kg m^2)."
            )
    return found


def _check_clusters(clusters: object, where: str) -> None:
    """Records from before there were clusters have none."""
    if not isinstance(clusters, list):
        raise RecordError(f"{where}: clusters must be a list of objects; run again.")
    for number, cluster in enumerate(clusters):
        entry = cluster if isinstance(cluster, dict) else {}
        members, scheme = entry.get("members"), entry.get("scheme")
        sound = (
            isinstance(entry.get("scenario"), str)
            and isinstance(entry.get("timestep"), int | float)
            and isinstance(scheme, str | None)
            and isinstance(entry.get("exact", False), bool)
            and all(isinstance(name, str) for name in entry.get("also") or ())
            and isinstance(members, list | tuple)
            and all(isinstance(member, str) for member in members)
        )
        if not sound:
            raise RecordError(
                f"{where}: clusters[{number}] must have a scenario, a timestep, a scheme or null, "
                "and members, a list of texts; run again."
            )


def _check_value(found: object, allowed: tuple[str, ...], where: str) -> None:
    if found not in allowed:
        raise RecordError(f"{where} is {found!r}, expected one of {', '.join(allowed)}.")


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a JSON value")


def dump_json(value: object) -> str:
    """Strict JSON: what is not finite becomes null, arrays and sets become lists."""
    return json.dumps(_plain(value), indent=1, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, set | frozenset):
        return [_plain(entry) for entry in sorted(value)]
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if hasattr(value, "tolist"):  # a NumPy array or scalar
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
