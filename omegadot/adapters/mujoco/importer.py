"""A system's body through MuJoCo's own readers of URDF and MJCF, at their defaults."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.body_files import mjcf_of, origin_at_pivot, urdf_of
from omegadot.adapters.mujoco.model import check_body
from omegadot.adapters.protocol import Format, UnsupportedError
from omegadot.reference_impl.system import Array, System


def read_model(mujoco: Any, system: System, via: Format) -> tuple[Any, Array]:
    """An ``MjModel`` that MuJoCo reads from a file of the body, under the loads of the system.

    With it where the frame of MuJoCo's body stands, (3,) from the body's origin, in body axes.
    Raises UnsupportedError as `build_model` does, and where MuJoCo refuses the file. ``spherical``
    is MuJoCo's own type of joint in a URDF.
    """
    check_body(mujoco, system)
    origin = origin_at_pivot(system) if via == "urdf" else np.zeros(3)
    joint = "floating" if system.load.pivot is None else "spherical"
    text = urdf_of(system, origin, joint) if via == "urdf" else mjcf_of(system)
    try:
        model = mujoco.MjModel.from_xml_string(text)
    except ValueError as error:
        reason = " ".join(str(error).split())
        raise UnsupportedError(f"MuJoCo refuses the {via} of this body: {reason}") from error
    model.dof_damping[-3:] = system.load.damping
    model.opt.gravity[:] = system.load.gravity
    return model, origin
