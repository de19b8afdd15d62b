"""Installing engines that Python's installer does not know: npm packages, into the user's cache."""

from __future__ import annotations

import contextlib
import secrets
import shutil
import subprocess
from pathlib import Path

from omegadot.adapters.node.packages import INSTALL, MANIFEST, cache
from omegadot.harness.usage import UsageError

GROUPS = ("node",)
SECONDS = 900.0  # 76 MB are unpacked
# Nothing of a package is run, nothing is written but the packages, and nothing else is fetched.
NPM = ("install", "--no-package-lock", "--ignore-scripts", "--no-audit", "--no-fund")


def install(group: str) -> Path:
    """Install the engines of a group, in the releases that they were tried with.

    They are made in a new folder, which takes the old one's place when it is whole. Returns it.
    group: "node", those that run through Node. Raises UsageError.
    """
    if group not in GROUPS:
        raise UsageError(f"--install {group}: there is no such group; write {' or '.join(GROUPS)}.")
    programs = [shutil.which(name) for name in ("node", "npm")]
    if None in programs:
        raise UsageError(f"{INSTALL} needs the programs node and npm; install Node 18 or later.")
    place = cache()
    made = place.with_name(f"node-{secrets.token_hex(4)}")
    try:
        made.mkdir(parents=True)
        shutil.copy(MANIFEST, made)
        _run_npm(str(programs[1]), made)
        with contextlib.suppress(FileNotFoundError):
            shutil.rmtree(place)
        made.rename(place)
    except OSError as error:
        reason = error.strerror or "it cannot be written"
        raise UsageError(
            f"{INSTALL}: {place.parent}: {reason}; set XDG_CACHE_HOME to a folder that can be "
            "written."
        ) from error
    finally:
        shutil.rmtree(made, ignore_errors=True)
    return place


def _run_npm(npm: str, folder: Path) -> None:
    """Have npm install what package.json of a folder names. Raises UsageError."""
    try:
        done = subprocess.run(
            [npm, *NPM], cwd=folder, capture_output=True, timeout=SECONDS, check=False
        )
    except subprocess.TimeoutExpired:
        raise UsageError(f"{INSTALL}: npm has not ended within {SECONDS:.0f} s.") from None
    if done.returncode:
        lines = done.stderr.decode("utf-8", "replace").splitlines()
        named = [line.removeprefix("npm error").strip() for line in lines if "error" in line]
        reason = "; ".join([line for line in named if line][:3]) or "it gives no reason"
        raise UsageError(f"{INSTALL}: npm failed with exit code {done.returncode}: {reason}.")
