"""XML from anybody: no document types, so no entities to expand or to fetch, and a size limit."""

from __future__ import annotations

import stat
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from xml.parsers import expat

from omegadot.scenarios.errors import ScenarioError, printable

LARGEST_FILE = 20_000_000  # bytes; robots are described in a few hundred thousand
DEEPEST = 500


class _RefusedError(Exception):
    """Something that a robot's description has no need of; the message says what."""


class _Reader:
    """Builds the tree from expat's own events: ElementTree's parser would expand entities."""

    def __init__(self) -> None:
        self._builder = ElementTree.TreeBuilder()
        self._depth = 0
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._builder.data
        self._parser.StartDoctypeDeclHandler = self._refuse_doctype
        self._parser.EntityDeclHandler = self._refuse_doctype

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        if self._depth > DEEPEST:
            raise _RefusedError(f"elements nested more than {DEEPEST} deep")
        self._builder.start(name, attributes)

    def _end(self, name: str) -> None:
        self._depth -= 1
        self._builder.end(name)

    def _refuse_doctype(self, *_: object) -> None:
        raise _RefusedError("a document type declaration")

    def read(self, content: bytes) -> ElementTree.Element:
        """The root element. Raises expat.ExpatError and _RefusedError."""
        self._parser.Parse(content, True)
        return self._builder.close()


def read_xml(path: Path, file: str) -> ElementTree.Element:
    """The root element of a regular file. file: its name in errors. Raises ScenarioError."""
    content = _content(path, file)
    try:
        return _Reader().read(content)
    except _RefusedError as error:
        advice = "take it out, links need none"
        raise ScenarioError(file, None, f"XML with {error}", advice) from None
    except expat.ExpatError as error:
        reason = printable(str(error))
        raise ScenarioError(file, None, f"not valid XML ({reason})", "mend it there") from None
    except (ValueError, LookupError) as error:  # an encoding that nobody knows
        reason = printable(str(error))
        raise ScenarioError(file, None, f"not readable ({reason})", "save it in UTF-8") from None


def _content(path: Path, file: str) -> bytes:
    advice = "give the path of a URDF, MJCF or SDF file"
    try:
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):
            found = "a directory" if stat.S_ISDIR(mode) else "not a regular file"
            raise ScenarioError(file, None, found, advice)
        with path.open("rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise ScenarioError(file, None, "missing", advice) from None
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise ScenarioError(file, None, f"not readable ({reason})", advice) from None
    except ValueError as error:
        if isinstance(error, ScenarioError):
            raise
        raise ScenarioError(file, None, "not a path", advice) from None
    if len(content) > LARGEST_FILE:
        raise ScenarioError(file, None, f"larger than {LARGEST_FILE:,} bytes", "cut it down")
    return content
