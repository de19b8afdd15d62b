"""``FILE#LINK`` to a body: which format the file is in, and which link is meant."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from omegadot.scenarios.errors import ScenarioError, describe, printable
from omegadot.scenarios.files import read_toml
from omegadot.scenarios.links import sdf, urdf
from omegadot.scenarios.links.link import Link, link_of
from omegadot.scenarios.links.place import Place
from omegadot.scenarios.links.xml_file import parsed, read_text, root_name

FORMATS = {"robot": urdf.links, "sdf": sdf.links}
MjcfReader = Callable[[Path, str], Sequence[Link]]


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


def body_of_argument(argument: str, bodies_of_mjcf: MjcfReader) -> NamedBody:
    """The body in ``FILE.toml`` or ``FILE#LINK``. Raises ScenarioError.

    bodies_of_mjcf: path and its name in errors to the bodies that MuJoCo's compiler finds.
    """
    path, separator, name = argument.rpartition("#")
    if not separator:
        path, name = argument, ""
    file = printable(path)
    if path.lower().endswith(".toml"):
        return _of_toml(path, file)
    text = read_text(Path(path), file)
    kind, remark = "link", ""
    if root_name(text) == "mujoco":
        kind, links = "body", bodies_of_mjcf(Path(path), file)
    else:
        root = parsed(text, file)
        if any(e.tag.startswith("xacro:") or "${" in e.get("name", "") for e in root.iter()):
            remark = "expand it with xacro first"
        elif root.find(".//include") is not None:
            remark = "expand its includes first"
        if root.tag not in FORMATS:
            found = f"XML with the root <{printable(root.tag)}>"
            advice = remark or "give a URDF, an MJCF or an SDF"
            raise ScenarioError(file, None, found, advice)
        links = FORMATS[root.tag](root)
    link = link_of(links, name, file, kind, remark)
    return NamedBody(name, link.body(Place(file, f"{kind} {name!r}")))


def _of_toml(path: str, file: str) -> NamedBody:
    data = read_toml(Path(path), file)
    body = data.get("body")
    if not isinstance(body, dict):
        found = "missing" if body is None else describe(body)
        raise ScenarioError(file, "body", found, "write it as a table [body]")
    name = data.get("name")
    return NamedBody(name if isinstance(name, str) else Path(path).stem, body)
