"""What can be reported of an engine before it steps: precision, features, licence, Python."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, metadata

from omegadot.adapters.protocol import Description
from omegadot.commands.choose.requirements import Requirements

PRECISION = {"float64": "double", "float32": "single"}
# The name of a package is not that of its module: "pinocchio" is something else on PyPI.
PACKAGES = {"mujoco": "mujoco", "pinocchio": "pin", "dart": "dartpy"}


def unmet(description: Description, wanted: Requirements) -> list[str]:
    """One clause for every requirement that the engine misses by what it is."""
    return [clause for clause in _clauses(description, wanted) if clause]


def _clauses(description: Description, wanted: Requirements) -> Iterator[str]:
    own = PRECISION[description.precision]
    if wanted.precision not in (None, own):
        yield f"precision: it computes in {own} precision, {wanted.precision} is required"
    lacking = [f for f in wanted.features if f.replace("-", "_") not in description.features]
    for name in lacking:
        yield f"feature: it has no {name.replace('-', ' ')}"
    allowed = {name.casefold() for name in wanted.licences}
    if allowed and description.licence.casefold() not in allowed:
        text = description.licence or "not stated"
        yield f"licence: its own is {text}, allowed is {' or '.join(wanted.licences)}"
    if wanted.python is not None:
        yield _python_refused(description.name, wanted.python)


def _running() -> str:
    return f"{sys.version_info.major}.{sys.version_info.minor}"


def _required(engine: str) -> str | None:
    """The package's ``Requires-Python``; None where no package or no such line is known."""
    try:
        found: str | None = metadata(PACKAGES[engine])["Requires-Python"]
    except (PackageNotFoundError, KeyError):
        return None
    return found


def _python_refused(engine: str, python: str) -> str:
    """The clause that states the package refuses this Python; empty where it does not."""
    required = _required(engine)
    if required is None or python == _running():
        return ""
    if all(_holds(python, part.strip()) for part in required.split(",")):
        return ""
    return f"python: its package requires {required}, {python} is required"


def _holds(python: str, clause: str) -> bool:
    """Whether one clause of a version specifier admits some release of this Python."""
    operator = clause.rstrip("0123456789.* ")
    bound = tuple(int(n) for n in clause[len(operator) :].strip().split(".") if n.isdigit())
    minor = tuple(int(n) for n in python.split("."))
    short = bound[:2]
    match operator.strip():
        case ">=" | "~=" | ">":
            return minor >= short
        case "<":
            return minor < short or (minor == short and len(bound) > 2 and bound[2] > 0)
        case "<=":
            return minor <= short
        case "==":
            return minor[: len(short)] == short
        case "!=":
            return not (minor == short and "*" in clause)
    return True


def python_note(engine: str, python: str | None) -> str:
    """What is not known about this Python, of the package's own words; empty where it is known."""
    if python is None or python == _running():
        return ""
    required = _required(engine)
    if required is None:
        return f"nothing is known of Python {python}"
    return f"Python {python} is within {required}; it was run under {_running()}"
