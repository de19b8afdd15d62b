"""XML from anybody: read as robot libraries read it, without entities, within a size limit.

Libraries on tinyxml2 take blank lines before the declaration, ``--`` in comments, prefixes without
a namespace, and bytes in whatever encoding, all of which strict XML refuses. Numbers and markup are
ASCII in all of them; what is not UTF-8 is taken as Latin-1, whatever the file declares.
"""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.sax import SAXException
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import AttributesImpl

from defusedxml import DefusedXmlException
from defusedxml.sax import parseString

from omegadot.scenarios.errors import ScenarioError, printable
from omegadot.scenarios.files import read_bytes

LARGEST_FILE = 20_000_000  # bytes; robots are described in a few hundred thousand
DEEPEST = 500

_DECLARATION = re.compile(r"\A\s*<\?xml\b(?:[^?]|\?(?!>))*\?>")
_MARKUP = re.compile(r"""<!--|<!\[CDATA\[|<[^!"'<>]*+(?:"[^"]*+"[^"'<>]*+|'[^']*+'[^"'<>]*+)*+>""")
_ROOT = re.compile(r"\s*(?:<[?!][^>]*>\s*)*<([^\s<>/]+)")
_CLOSING = {"<!--": "-->", "<![CDATA[": "]]>"}
_MARKS = {b"\xef\xbb\xbf": "utf-8", b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}


class _Tree(ContentHandler):
    """Builds the elements, names with their prefixes as they stand."""

    def __init__(self) -> None:
        super().__init__()
        self.builder = TreeBuilder()
        self._depth = 0

    def startElement(self, name: str, attrs: AttributesImpl) -> None:
        self._depth += 1
        if self._depth > DEEPEST:
            raise SAXException(f"elements nested more than {DEEPEST} deep")
        self.builder.start(name, dict(attrs.items()))

    def endElement(self, name: str) -> None:
        self._depth -= 1
        self.builder.end(name)

    def characters(self, content: str) -> None:
        self.builder.data(content)


def read_text(path: Path, file: str) -> str:
    """The text of a regular file, comments taken out. file: its name in errors.

    Raises ScenarioError.
    """
    content = read_bytes(path, file, "URDF, MJCF or SDF", LARGEST_FILE)
    text = decoded(content)
    if found := _DECLARATION.match(text):  # its line ends stay, so that lines keep their numbers
        text = "\n" * found[0].count("\n") + text[found.end() :]
    return _without_comments(text)


def root_name(text: str) -> str:
    """The name of the first element; empty where there is none."""
    found = _ROOT.match(text)
    return found[1] if found else ""


def parsed(text: str, file: str) -> Element:
    """The root element. Raises ScenarioError."""
    tree = _Tree()
    try:
        parseString(text.encode(), tree, forbid_dtd=True)
    except DefusedXmlException:
        found = "XML with a document type declaration"
        raise ScenarioError(file, None, found, "take it out, links need none") from None
    except SAXException as error:
        where = getattr(error, "getLineNumber", lambda: None)()
        reason = printable(error.getMessage()) + (f" in line {where}" if where else "")
        raise ScenarioError(file, None, f"not valid XML ({reason})", "correct it there") from None
    root: Element = tree.builder.close()
    return root


def _without_comments(text: str) -> str:
    """Comments end at the first ``-->``; those within quotes or CDATA are none."""
    pieces, kept, position = [], 0, 0
    while markup := _MARKUP.search(text, position):
        position = markup.end()
        if markup[0] in _CLOSING:
            end = text.find(_CLOSING[markup[0]], position)
            if end < 0:
                break
            position = end + 3
            if markup[0] == "<!--":
                lines = "\n" * text.count("\n", markup.start(), position)
                pieces += [text[kept : markup.start()], lines]
                kept = position
    return "".join([*pieces, text[kept:]])


def decoded(content: bytes) -> str:
    """Text in UTF-8, in UTF-16 where it begins with its mark, in Latin-1 otherwise."""
    for mark, encoding in _MARKS.items():
        if content.startswith(mark):
            return content[len(mark) :].decode(encoding, "replace")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1")
