"""three.js, which draws the bodies, out of the installed trimesh: it ships it in its own viewer."""

from __future__ import annotations

import re
from functools import cache
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from omegadot.reports.charts.chart_library import pack

# The library ends with this line of its universal build; trimesh's own scripts follow it.
_BUILD = re.compile(
    r"<script>(.*?Object\.defineProperty\(\w+,\"__esModule\",\{value:!0\}\)\}+\)+;)", re.DOTALL
)


@cache
def packed_three() -> str:
    """The library, which defines ``THREE``, packed; empty where trimesh ships none to be read.

    A thirtieth of a second, once a process.
    """
    found = find_spec("trimesh")  # found, not imported: its Python is of no use here
    if found is None or not found.submodule_search_locations:
        return ""
    archive = Path(found.submodule_search_locations[0], "resources", "templates", "viewer.zip")
    return library_of(archive.read_bytes()) if archive.is_file() else ""


def library_of(archive: bytes) -> str:
    """The packed library of a viewer's archive; empty where there is none to be read."""
    try:
        with ZipFile(BytesIO(archive)) as opened:
            page = opened.read("viewer.html.template").decode()
    except (BadZipFile, KeyError, UnicodeDecodeError):
        return ""
    library = _BUILD.search(page)
    return pack(library[1].encode()) if library and "CapsuleGeometry" in library[1] else ""
