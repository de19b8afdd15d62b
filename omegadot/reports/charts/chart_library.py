"""The libraries that go into the page, packed: Plotly for the charts, three.js for the bodies.

three.js comes out of the installed trimesh, which ships it in its own viewer.
"""

from __future__ import annotations

import gzip
import re
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from zipfile import BadZipFile, ZipFile

import numpy as np
from markupsafe import Markup

# The library ends with this line of its universal build; trimesh's own scripts follow it.
_BUILD = re.compile(
    r"<script>(.*?Object\.defineProperty\(\w+,\"__esModule\",\{value:!0\}\)\}+\)+;)", re.DOTALL
)


# RFC 1924's letters, with a comma for the one that may not stand in a page.
_LETTERS = b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~"


def pack(data: bytes) -> Markup:
    """Gzip and base 85, 25 % longer than the bytes: the same text for the same bytes.

    Five letters stand for four bytes, the highest first; as many letters as zeros were added at
    the end are left out.
    """
    packed = gzip.compress(data, compresslevel=6, mtime=0)
    missing = -len(packed) % 4
    words = np.frombuffer(packed + bytes(missing), ">u4").astype(np.uint32)
    digits = words[:, None] // np.array([85**k for k in (4, 3, 2, 1, 0)], np.uint32) % 85
    letters = np.frombuffer(_LETTERS, np.uint8)[digits].tobytes()
    return Markup(letters[: len(letters) - missing].decode("ascii"))


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
