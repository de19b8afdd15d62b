"""A system as a Pinocchio model of one joint, built by its API or read by its own importers."""

from __future__ import annotations

import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from omegadot.adapters.body_files import mjcf_of, origin_at_pivot, urdf_of
from omegadot.adapters.protocol import Format
from omegadot.reference_impl.system import System

JOINT = 1  # joint 0 is Pinocchio's world
READERS: dict[Format, str] = {"urdf": "buildModelFromXML", "mjcf": "buildModelFromMJCF"}


def importers(pin: ModuleType) -> tuple[Format, ...]:
    """The formats for which the installed version has a reader; it may be built without."""
    return tuple(via for via, reader in READERS.items() if hasattr(pin, reader))


def _joint(pin: Any, system: System) -> Any:
    free = system.load.pivot is None
    return pin.JointModelFreeFlyer() if free else pin.JointModelSpherical()


def build_model(pin: Any, system: System) -> Any:
    """The model, its joint at the body's origin or at the pivot."""
    body, model = system.body, pin.Model()
    joint = model.addJoint(0, _joint(pin, system), pin.SE3.Identity(), "body")
    lever = np.array(body.center_of_mass, float) - origin_at_pivot(system)
    inertia = np.array(body.inertia, float)
    model.inertias[joint] = pin.Inertia(float(body.mass), lever, inertia)
    return model


def read_model(pin: Any, system: System, via: Format) -> Any:
    """The model by Pinocchio's own reader.

    In a URDF the root link stands on the joint that the reader is given, in an MJCF on the file's.
    """
    reader = getattr(pin, READERS[via])
    if via == "urdf":
        return reader(urdf_of(system, origin_at_pivot(system)), _joint(pin, system))
    with tempfile.TemporaryDirectory() as folder:  # that reader takes files alone
        file = Path(folder, "body.xml")
        file.write_text(mjcf_of(system), encoding="utf-8")
        return reader(str(file))
