"""The second way: the script of a finding, over the engine's own API, in a process of its own."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from omegadot.adapters.node.packages import cache
from omegadot.commands.findings.measured import Measured

_LINE = re.compile(r"^(release|figure|mended) (\S+)$", re.MULTILINE)


def reproduce(script: Path, before: Measured, timeout: float) -> Measured:
    """What the script prints: its engine's release, its figure and that with the setting mended.

    timeout: s. A script that fails, or prints no figure, leaves the reason in ``script_error``.
    """
    empty = replace(before, script_release="", script_value=None, script_mended=None)
    try:
        done = subprocess.run(
            command_of(script),
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
            env={**os.environ, "NODE_PATH": str(cache() / "node_modules")},
        )
    except subprocess.TimeoutExpired:
        return replace(empty, script_error=f"took longer than {timeout:.0f} s")
    except OSError as error:
        return replace(empty, script_error=f"could not be started ({error.strerror})")
    printed = dict(_LINE.findall(done.stdout))
    if done.returncode or "figure" not in printed or "release" not in printed:
        last = (done.stderr.strip().splitlines() or ["it printed no figure and no release"])[-1]
        return replace(empty, script_error=last[:200])
    figure, mended = (_number(printed.get(name)) for name in ("figure", "mended"))
    own = {"script_release": printed["release"], "script_error": ""}
    return replace(before, **own, script_value=figure, script_mended=mended)


def command_of(script: Path) -> list[str]:
    """What runs it. Python leaves out PYTHONPATH, so that no adapter is near (``-I``)."""
    own = [sys.executable, "-I"] if script.suffix == ".py" else ["node"]
    return [*own, str(script)]


def _number(text: str | None) -> float | None:
    try:
        return None if text is None else float(text)
    except ValueError:
        return None
