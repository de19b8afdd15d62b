"""Engines with a reader of URDF of their own: the project's reader, sound or with a fault."""

from __future__ import annotations

import re
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from omegadot.adapters.body_files import urdf_of
from omegadot.adapters.protocol import Description, Format, UnsupportedError
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.system import Body, System
from omegadot.scenarios.links.body_file import body_of_argument


def read_urdf(text: str) -> Body:
    """The body of a URDF's one link."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "robot.urdf")
        path.write_text(text, encoding="utf-8")
        found = body_of_argument(f"{path}#body", lambda *_: []).body
    numbers = (found["mass"], found["center_of_mass"], found["inertia"])
    return Body(*(np.array(value, dtype=float) for value in numbers))


class SoundImporter(ReferenceAdapter):
    @property
    def description(self) -> Description:
        found = super().description
        few = tuple(i for i in found.integrators if i.name == "semi-implicit-euler")
        return replace(found, importers=("urdf",), integrators=few)

    def load_file(self, system: System, via: Format) -> None:
        if via != "urdf":
            raise UnsupportedError("URDF alone")
        body = read_urdf(self.misread(urdf_of(system, np.zeros(3))))
        self.load(replace(system, bodies=(body,)))

    def misread(self, text: str) -> str:
        return text


class IgnoresRotation(SoundImporter):
    """It takes the tensor for one in body axes."""

    def misread(self, text: str) -> str:
        return re.sub(r'rpy="[^"]*"', 'rpy="0 0 0"', text)
