"""Why a run came to its verdict, for people: the gates that fail, the likely cause, the reason."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

MODEL_ALONE = "its model alone was tested and nothing about its motion, which is no pass"


def failing_gates(task: Mapping[str, Any]) -> list[str]:
    """The gates of a run that fail, in their order."""
    return [gate for gate, verdict in (task.get("gates") or {}).items() if verdict == "fail"]


def tests_motion(task: Mapping[str, Any]) -> bool:
    """Whether a gate beyond the model's has a verdict: a model alone states nothing of a motion."""
    gates = task.get("gates") or {}
    return any(gate != "model" and v in ("pass", "fail", "declared") for gate, v in gates.items())


def cause_of(task: Mapping[str, Any]) -> str:
    """The likely cause of a run's failure; "" where none is known, or no gate of it fails."""
    return (task.get("cause") or "") if failing_gates(task) else ""


def reason_of(task: Mapping[str, Any]) -> str:
    """The likely cause of a run that fails, then what its outcome or its verdict follows from."""
    cause = cause_of(task)
    reason = task.get("reason") or task.get("why") or ""
    return "; ".join(filter(None, (f"likely cause: {cause}" if cause else "", reason)))
