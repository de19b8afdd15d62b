"""What a record states of the machine and the packages that made it."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

RECORDED = (
    "numpy", "scipy", "pydantic", "polars", "pyarrow", "plotly", "jinja2", "mujoco", "pin", "dartpy"
)  # fmt: skip


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            for line in lines:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
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
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def memory_of_machine() -> int:
    """Bytes of memory that there are: the machine's, or those that its container may have.

    Zero where the system does not report.
    """
    try:
        found = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (ValueError, OSError, AttributeError):
        return 0
    try:
        with open("/sys/fs/cgroup/memory.max", encoding="ascii") as file:
            return min(found, int(file.read()))
    except (OSError, ValueError):  # there is no such file, or it states "max"
        return found
