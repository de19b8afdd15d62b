"""How much memory a worker may hold, and how much it has held at most."""

import re
import sys
from pathlib import Path

MEMORY_VARIABLE = "OMEGADOT_WORKER_MEMORY"
"""Names the environment's limit on the worker's data, in bytes."""


def limit_memory(most: int) -> None:
    """Have allocations beyond `most` bytes of data refused, where the system can.

    Data, not address space: engines and numerical libraries reserve much more than they use.
    """
    try:
        import resource
    except ImportError:  # there is no such limit on this system
        return
    _, hard = resource.getrlimit(resource.RLIMIT_DATA)
    if hard != resource.RLIM_INFINITY:
        most = min(most, hard)
    resource.setrlimit(resource.RLIMIT_DATA, (most, hard))


def peak_memory() -> int | None:
    """Bytes that this process had in memory at its peak; None where it cannot find out.

    Python, NumPy and the engine's libraries are in it.
    """
    if sys.platform == "linux":  # where getrusage begins at what the parent held
        found = re.search(r"VmHWM:\s*(\d+) kB", Path("/proc/self/status").read_text("ascii"))
        return int(found[1]) * 1024 if found else None
    if sys.platform == "darwin":
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return None
