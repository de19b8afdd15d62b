"""The orders that integrators declare."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

Orders = Mapping[tuple[str, str], float | None]


def declared_orders(engines: Iterable[Mapping[str, Any]]) -> Orders:
    """The order in attitude that each integrator declares, by engine and integrator."""
    return {
        (engine["name"], own["name"]): (own.get("orders") or {}).get("attitude")
        for engine in engines
        for own in engine.get("integrators") or ()
    }
