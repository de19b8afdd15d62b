"""uv or pip: how environments are made and filled, and which releases are published.

Where packages come from is the user's configuration of the one or the other.
"""

from __future__ import annotations

import importlib.util
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from omegadot.commands.versions.release import Span, version_of
from omegadot.workers.wire import one_line
from omegadot.written import written

SECONDS_TO_INSTALL = 900.0
LONGEST_REASON = 300


class InstallError(Exception):
    """It could not be done; the message is the reason, in one line."""


def python_of(folder: Path) -> Path:
    """The interpreter of an environment."""
    windows = folder / "Scripts" / "python.exe"
    return windows if sys.platform == "win32" else folder / "bin" / "python"


def _done(command: Sequence[str], given: str = "") -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(
            command,
            input=given,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=SECONDS_TO_INSTALL,
        )
    except subprocess.TimeoutExpired as error:
        raise InstallError(f"not done within {written(SECONDS_TO_INSTALL)} s") from error
    except OSError as error:
        raise InstallError(f"{command[0]} could not be started: {error.strerror}") from error


def _run(command: Sequence[str]) -> str:
    done = _done(command)
    if done.returncode != 0:
        raise InstallError(reason_of(done.stderr or done.stdout))
    return done.stdout


def reason_of(message: str) -> str:
    """What went wrong, out of all that an installer reported."""
    # Drawn arrows and colours lead the lines of uv, and it breaks sentences over several.
    plain = re.sub(r"\x1b\[[0-9;]*m|[×╰─▶├│]| \(from versions: [^)]*\)", " ", message)
    lines = [" ".join(line.split()) for line in plain.splitlines()]
    reported = [line for line in lines if line and not line.startswith(("WARNING", "[notice]"))]
    errors = [line.removeprefix("ERROR: ") for line in reported if line.startswith("ERROR: ")]
    return one_line(
        "; ".join(errors[-2:]) or " ".join(reported[-6:]) or "no reason given", LONGEST_REASON
    )


class Pip:
    """``python -m venv`` and this Python's pip. Every call raises InstallError."""

    name = "pip"

    def create(self, folder: Path) -> None:
        """An empty environment with this very Python, without a pip: this one fills it."""
        _run([sys.executable, "-P", "-m", "venv", "--without-pip", str(folder)])

    def install(self, folder: Path, requirements: Sequence[str]) -> None:
        """Put packages into an environment, from wheels alone: nothing is compiled."""
        to = [sys.executable, "-P", "-m", "pip", "--python", str(python_of(folder))]
        _run([*to, "install", "--no-input", "--only-binary=:all:", *requirements])

    def releases(self, package: str, span: Span) -> list[str]:
        """The releases of a package within a span that this Python could have, rising.

        Of ``pip index versions``; its text is read where it cannot answer in JSON.
        """
        command = [sys.executable, "-P", "-m", "pip", "index", "versions", package, "--no-input"]
        try:
            return span.of(json.loads(_run([*command, "--json"]))["versions"])
        except InstallError as error:
            if "no such option" not in str(error):
                raise
        text = re.search(r"Available versions: (.*)", _run(command))
        return span.of(version.strip() for version in text[1].split(",")) if text else []


class Uv:
    """uv, by the command that starts it; what its calls do is what those of `Pip` do."""

    name = "uv"

    def __init__(self, command: Sequence[str]) -> None:
        self._command = [*command]

    def create(self, folder: Path) -> None:
        """``uv venv``."""
        _run([*self._command, "venv", "--quiet", "--python", sys.executable, str(folder)])

    def install(self, folder: Path, requirements: Sequence[str]) -> None:
        """``uv pip install``."""
        to = ["--python", str(python_of(folder)), "--only-binary", ":all:"]
        _run([*self._command, "pip", "install", "--quiet", *to, *requirements])

    def releases(self, package: str, span: Span) -> list[str]:
        """No call of uv lists releases: it is called for the newest below each one found."""
        found: list[str] = []
        bounds = [f">={span.low}"] if span.low else []
        last = [f"<={span.high}"] if span.high else []
        while newest := self._newest(package, bounds + last):
            found.append(newest)
            last = [f"<={newest}", f"!={newest}"]
        return span.of(found)

    def _newest(self, package: str, bounds: Sequence[str]) -> str | None:
        """None where no release lies within the bounds."""
        compile_ = ["pip", "compile", "--quiet", "--no-deps", "--no-header", "--no-annotate"]
        to = ["--python", sys.executable, "--only-binary", ":all:", "-"]
        done = _done([*self._command, *compile_, *to], package + ",".join(bounds))
        if done.returncode != 0:
            if bounds and "No solution found" in done.stderr:
                return None
            raise InstallError(reason_of(done.stderr))
        pinned = re.search(rf"^{re.escape(package)}==(\S+)", done.stdout, re.MULTILINE)
        return pinned[1] if pinned and version_of(pinned[1]) else None


Installer = Pip | Uv


def installer_named(name: str) -> Installer:
    """uv, pip, or, of "auto", uv where there is one. Raises InstallError."""
    if name != "pip":
        program = shutil.which("uv")
        if program:
            return Uv([program])
        if importlib.util.find_spec("uv") is not None:
            return Uv([sys.executable, "-P", "-m", "uv"])
    if name == "uv":
        raise InstallError("there is no uv, neither as a program nor as a package of this Python")
    if importlib.util.find_spec("pip") is None:
        raise InstallError("there is neither uv nor pip to make environments with; install one")
    return Pip()
