"""``FILE#LINK`` to a body: which format the file is in, and which link is meant."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from omegadot.scenarios.errors import ScenarioError, describe, printable
from omegadot.scenarios.links import mjcf, sdf, urdf
from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.safe_xml import read_xml
from omegadot.scenarios.refusals import nearest
from omegadot.scenarios.toml_file import read_toml

MOST_NAMED = 12
FORMATS: dict[str, tuple[str, Callable[[Element], dict[str, list[Element]]]]] = {
    "robot": ("link", urdf.links),
    "sdf": ("link", sdf.links),
    "mujoco": ("body", mjcf.links),
}


@dataclass(frozen=True)
class NamedBody:
    """name: the link's, or the file's.  body: the keys of a scenario's [body]."""

    name: str
    body: dict[str, Any]

    @property
    def kebab(self) -> str:
        """The name as a scenario may have it."""
        plain = re.sub(r"[^a-z0-9]+", "-", self.name.lower()).strip("-")[:64].strip("-")
        return plain or "body"


def body_of_word(term: str) -> NamedBody:
    """The body in ``FILE.toml`` or ``FILE#LINK``. Raises ScenarioError, one sentence."""
    path, separator, link = term.rpartition("#")
    if not separator:
        path, link = term, ""
    file = printable(path)
    if path.lower().endswith(".toml"):
        return _of_toml(path, file)
    root = read_xml(Path(path), file)
    if root.tag not in FORMATS:
        found = f"XML with the root <{printable(root.tag)}>"
        raise ScenarioError(file, None, found, "give a URDF, an MJCF or an SDF")
    kind, links = FORMATS[root.tag]
    return _of_link(root, kind, links(root), link, file)


def _of_toml(path: str, file: str) -> NamedBody:
    data = read_toml(Path(path), file)
    body = data.get("body")
    if not isinstance(body, dict):
        found = "missing" if body is None else describe(body)
        raise ScenarioError(file, "body", found, "write it as a table [body]")
    name = data.get("name")
    return NamedBody(name if isinstance(name, str) else Path(path).stem, body)


def _of_link(
    root: Element, kind: str, links: dict[str, list[Element]], name: str, file: str
) -> NamedBody:
    names = [n for n in links if n]
    if not names:
        more = "; expand its includes first" if root.find(".//include") is not None else ""
        raise ScenarioError(file, None, f"without a named {kind}", f"name one in it{more}")
    if not name:
        one = f"{file}#{names[0]}"
        found = f"given without a {kind}"
        raise ScenarioError(file, None, found, f"write {printable(one)}, {_listed(kind, names)}")
    if name not in links:
        near = nearest(name, names)
        advice = f"write {printable(near)}, " if near else "give another, "
        if root.find(".//include") is not None:
            advice += "or expand the file's includes first, "
        raise ScenarioError(file, f"{kind} {name!r}", "missing", advice + _listed(kind, names))
    if len(links[name]) > 1:
        found = f"the name of {len(links[name])}"
        raise ScenarioError(file, f"{kind} {name!r}", found, "give every one a name of its own")
    place = Place(file, f"{kind} {name!r}")
    element = links[name][0]
    if root.tag == "mujoco":
        return NamedBody(name, mjcf.body(element, place, root))
    return NamedBody(name, (urdf if root.tag == "robot" else sdf).body(element, place))


def _listed(kind: str, names: list[str]) -> str:
    """Which names there are, not too many."""
    shown = ", ".join(printable(name) for name in names[:MOST_NAMED])
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    many = {"link": "links", "body": "bodies"}[kind]
    return f"its {kind if len(names) == 1 else many}: {shown}{more}"
