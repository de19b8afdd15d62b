"""The scenarios of a record whose body cannot be: its inertia was allowed to be impossible."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from omegadot.scenarios.tensor import ALLOWED, broken_triangle


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
