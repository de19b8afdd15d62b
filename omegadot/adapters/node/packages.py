"""The packages of the engines that run through Node: which there are, where they are kept.

They are pinned in package.json of this folder, which is the whole list, and stand in a folder of
the user's cache, outside of any project: ``omegadot engines --install node`` fills it.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
from pathlib import Path

FOLDER = Path(__file__).parent
MANIFEST = FOLDER / "package.json"
INSTALL = "omegadot engines --install node"
ENGINES = {
    "cannon-es": "cannon-es",
    "rapier3d-compat": "@dimforge/rapier3d-compat",
    "jolt-physics": "jolt-physics",
    "physx-js-webidl": "physx-js-webidl",
    "havok": "@babylonjs/havok",
    "ammo": "ammo.js",
}
"""The package of each engine."""


def cache() -> Path:
    """Where the packages are kept: ``omegadot/node`` in XDG_CACHE_HOME, or else in ~/.cache.

    As the XDG base directory specification has it, a relative path counts as none.
    """
    given = os.environ.get("XDG_CACHE_HOME", "")
    base = given if os.path.isabs(given) else os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "omegadot" / "node"


def pinned(engine: str) -> str:
    """The release of an engine that its adapter was tried with."""
    versions: dict[str, str] = json.loads(MANIFEST.read_text(encoding="utf-8"))["dependencies"]
    return versions[ENGINES[engine]]


def _folder(engine: str) -> Path:
    return cache() / "node_modules" / ENGINES[engine]


def installed(engine: str) -> str:
    """The release that the cache has, "" for none."""
    try:
        text = (_folder(engine) / "package.json").read_text(encoding="utf-8")
        return str(json.loads(text)["version"])
    except (OSError, ValueError, KeyError, TypeError):
        return ""


def missing(engine: str) -> str:
    """What an engine lacks to be run, and what installs it; "" where it lacks nothing."""
    if shutil.which("node") is None:
        return (
            f"{engine} runs through Node, and there is no program node; install Node 18 or later "
            f"with npm, then the engine with {INSTALL}"
        )
    wanted, found = pinned(engine), installed(engine)
    if found == wanted:
        return ""
    there = f", {found} is" if found else ""
    return f"{engine} {wanted} is not installed{there}; install it with {INSTALL}"


def command_of(engine: str) -> str:
    """The command line of the program that serves an engine.

    Raises ImportError where Node, or the engine's package, is not installed.
    """
    reason = missing(engine)
    if reason:
        raise ImportError(reason)
    return shlex.join(
        ["node", (FOLDER / "worker.js").as_posix(), engine, _folder(engine).as_posix()]
    )
