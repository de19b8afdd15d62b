"""``run.json``: strict JSON, and the parts of it that tables and page stand on."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from omegadot.reports.record import schema
from omegadot.reports.record.run_model import check_run
from omegadot.reports.record.schema import RecordError
from omegadot.scenarios.tensor import ALLOWED, broken_triangle


def read_run(path: Path) -> dict[str, Any]:
    """Read ``run.json``; RecordError, one sentence, where it is not one of this schema."""
    try:
        run = json.loads(path.read_text(encoding="utf-8-sig"), parse_constant=_refuse_constant)
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


def impossible_bodies(scenarios: Iterable[Mapping[str, Any]]) -> list[str]:
    """A sentence on each. scenarios: rows with `name` and `definition`, as records have them."""
    found = []
    for entry in scenarios:
        body = (entry.get("definition") or {}).get("body") or {}
        tensor = body.get("inertia") if body.get(ALLOWED) else None
        broken = broken_triangle(np.array(tensor)) if tensor else None
        if broken:
            found.append(
                f"{entry['name']}: an impossible inertia, allowed on request: its greatest"
                f" principal moment exceeds the sum of the other two ({broken} kg m^2)."
            )
    return found


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a JSON value")


def dump_json(value: object) -> str:
    """Strict JSON of `plain`."""
    return json.dumps(plain(value), indent=1, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """What strict JSON can hold: null for what is not finite, lists for arrays and sets."""
    if value is None or type(value) in (str, int, bool):  # most are, or a number
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, set | frozenset):
        return [plain(entry) for entry in sorted(value)]
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if hasattr(value, "tolist"):  # a NumPy array or scalar
        return plain(value.tolist())
    return value
