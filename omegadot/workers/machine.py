"""What a record states of the machine and the packages that made it."""

from __future__ import annotations

import contextlib
import os
import platform
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
import psutil

RECORDED = (
    "numpy", "scipy", "pydantic", "polars", "pyarrow", "plotly", "jinja2",
    "mujoco", "pin", "dartpy", "drake", "exudyn", "bsk", "opensim", "pybullet", "sapien",
    "mujoco-mjx", "jaxsim", "jax", "jaxlib", "idyntree", "rapier3d", "biorbd"
)  # fmt: skip

# Of control groups, version 2 and 1. A container sees its own group as the root.
CONTAINER_LIMITS = (
    "/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"
)  # fmt: skip


def _processor() -> str:
    """The processor's name, where the system keeps it; else the kind that it is."""
    with contextlib.suppress(OSError, subprocess.SubprocessError):
        if sys.platform == "darwin":
            command = ["sysctl", "-n", "machdep.cpu.brand_string"]
            return subprocess.check_output(command, text=True).strip()
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
        if found := re.search(r"^model name\s*:\s*(.+)", text, re.MULTILINE):
            return found[1].strip()
    return platform.processor() or platform.machine()


def describe_machine() -> dict[str, Any]:
    """Platform, processor, cores and the mantissa that long double has here."""
    return {
        "platform": platform.platform(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "longdouble_bits": int(np.finfo(np.longdouble).nmant) + 1,
    }


def package_versions() -> dict[str, str]:
    """The versions of the packages that a figure may depend on; a missing one is left out."""
    found = {}
    for name in RECORDED:
        with contextlib.suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


def memory_of_machine() -> int:
    """Bytes of memory that there are: the machine's, or those that its container may have."""
    most: int = psutil.virtual_memory().total
    for limit in CONTAINER_LIMITS:
        with contextlib.suppress(OSError, ValueError):  # there is no such file, or no limit
            most = min(most, int(Path(limit).read_text("ascii")))
    return most
