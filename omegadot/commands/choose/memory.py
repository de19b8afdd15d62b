"""How much memory a worker has held at most."""

from __future__ import annotations

from pathlib import Path


def peak_memory(pid: int | None) -> int | None:
    """Bytes that a living process had in memory at its peak; None where the system does not report.

    It is Linux's VmHWM: Python, NumPy and the engine's libraries are in it.
    """
    if pid is None:
        return None
    try:
        text = Path(f"/proc/{pid}/status").read_text(encoding="ascii", errors="replace")
    except OSError:
        return None
    for line in text.splitlines():
        name, _, value = line.partition(":")
        if name == "VmHWM":
            return int(value.split()[0]) * 1024
    return None
