"""The chart library that goes into the page, packed while everything else is made ready."""

from __future__ import annotations

import base64
import gzip
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from importlib.util import find_spec
from pathlib import Path


def pack(data: bytes) -> str:
    """Gzip and base64, the same text for the same bytes."""
    return base64.b64encode(gzip.compress(data, compresslevel=6, mtime=0)).decode("ascii")


@cache
def packed_library() -> Future[str]:
    """Plotly's own script, out of the installed package, packed.

    It takes one core a third of a second: call it early, use the result late.
    """
    aside = ThreadPoolExecutor(1, "packing")
    packed = aside.submit(_pack_plotly)
    aside.shutdown(wait=False)
    return packed


def _pack_plotly() -> str:
    found = find_spec("plotly")  # found, not imported: its Python is of no use here
    assert found is not None
    assert found.submodule_search_locations
    folder = Path(found.submodule_search_locations[0])
    return pack((folder / "package_data" / "plotly.min.js").read_bytes())
