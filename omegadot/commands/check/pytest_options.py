"""The options of the pytest plugin. Nothing is imported for them, as every pytest loads them."""

from __future__ import annotations

from typing import Any

PREFIX = "--omegadot-"
OPTIONS: dict[str, dict[str, Any]] = {
    "engine": {
        "action": "append",
        "metavar": "NAME[:INTEGRATOR]",
        "help": "check this engine; repeatable",
    },
    "adapter": {
        "action": "append",
        "metavar": "FILE|module:Class",
        "help": "check an engine of your own; repeatable",
    },
    "require-engine": {
        "action": "append",
        "metavar": "NAME",
        "help": "check this engine, and fail where it is missing; repeatable",
    },
    "scenario": {
        "action": "append",
        "metavar": "NAME|FILE",
        "help": "check on this scenario; repeatable; default: every built-in",
    },
    "baseline": {"metavar": "DIR", "help": "compare with the values stored in DIR"},
    "update-baseline": {"action": "store_true", "help": "store the measured values in DIR instead"},
    "exceptions": {
        "action": "append",
        "metavar": "FILE",
        "help": "known failures, declared in TOML; repeatable",
    },
}


def dest_of(name: str) -> str:
    """The name under which an option's value is kept."""
    return "omegadot_" + name.replace("-", "_")
