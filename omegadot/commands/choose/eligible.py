"""What is known of an engine before it steps: precision, features, licence, Python."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, metadata

from packaging.specifiers import SpecifierSet

from omegadot.adapters.protocol import Description
from omegadot.commands.choose.requirements import Requirements

PRECISION = {"float64": "double", "float32": "single"}
# The name of a package is not that of its module: "pinocchio" is something else on PyPI.
PACKAGES = {
    "mujoco": "mujoco",
    "pinocchio": "pin",
    "dart": "dartpy",
    "drake": "drake",
    "exudyn": "exudyn",
    "basilisk": "bsk",
    "opensim": "opensim",
    "pybullet": "pybullet",
    "sapien": "sapien",
    "mjx": "mujoco-mjx",
    "mjx-float32": "mujoco-mjx",
    "jaxsim": "jaxsim",
    "jaxsim-float32": "jaxsim",
    "idyntree": "idyntree",
    "rapier3d": "rapier3d",
    "biorbd": "biorbd",
}
# More than any minor version of Python has had.
MOST_RELEASES = 40


def unmet(description: Description, wanted: Requirements) -> list[str]:
    """One clause for every requirement that the engine misses by what it is."""
    return list(_clauses(description, wanted))


def untestable(description: Description) -> list[str]:
    """The same of an engine whose motion over time cannot be tried."""
    if description.integrators:
        return []
    return ["integrators: it has none, so nothing about its motion over time can be tested"]


def _clauses(description: Description, wanted: Requirements) -> Iterator[str]:
    own = PRECISION[description.precision]
    if wanted.precision not in (None, own):
        yield f"precision: it computes in {own} precision, {wanted.precision} is required"
    for name in wanted.features:
        if name.replace("-", "_") not in description.features:
            yield f"feature: it has no {name.replace('-', ' ')}"
    allowed = {name.casefold() for name in wanted.licences}
    if allowed and description.licence.casefold() not in allowed:
        text = description.licence or "not stated"
        yield f"licence: its own is {text}, allowed is {' or '.join(wanted.licences)}"
    python, required = wanted.python, _required(description.name)
    if python and required and python != _running() and not _admits(required, python):
        yield f"python: its package requires {required}, {python} is required"


def _running() -> str:
    return f"{sys.version_info.major}.{sys.version_info.minor}"


def _required(engine: str) -> str | None:
    """The package's ``Requires-Python``; None where no package or no such line is known."""
    try:
        found: str | None = metadata(PACKAGES[engine])["Requires-Python"]
    except (PackageNotFoundError, KeyError):
        return None
    return found


def _admits(required: str, python: str) -> bool:
    """Whether a ``Requires-Python`` admits some release of this minor version."""
    specifiers = SpecifierSet(required)
    return any(f"{python}.{micro}" in specifiers for micro in range(MOST_RELEASES))


def python_note(engine: str, python: str | None) -> str:
    """What the package's metadata leave unknown about this Python; empty where it is known."""
    if python is None or python == _running():
        return ""
    required = _required(engine)
    if required is None:
        return f"nothing is known of Python {python}"
    return f"Python {python} is within {required}; it was run under {_running()}"
