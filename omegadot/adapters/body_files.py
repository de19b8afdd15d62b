"""A system's body as the text of a URDF or an MJCF, for engines that read such files themselves.

Every number is written so that it reads back as the same double. The inertial frame is turned, so
that a reader which ignores its rotation holds another tensor. Of the loads the pivot alone is in
the file; an adapter sets the others as it does in a model of its own making.
"""

from __future__ import annotations

import math

import numpy as np

from omegadot.adapters.mujoco.model import principal_frame
from omegadot.adapters.native_axes import TURNED, TURNED_QUATERNION
from omegadot.reference_impl.system import Array, System

NAME = "body"
# Roll, pitch and yaw of the inertial frame in rad. The first exchange the axes, x to y to z: a
# diagonal tensor stays so, no entry is rounded, and the moments of a flat body still add up.
EXCHANGED = (math.pi / 2, 0.0, math.pi / 2)
SLANTED = (0.3, -0.5, 0.7)
UPPER = ([0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2])  # xx, xy, xz, yy, yz, zz


def origin_at_pivot(system: System) -> Array:
    """The pivot (3,), from the body's origin, body axes; zero for a free body."""
    return np.zeros(3) if system.load.pivot is None else np.array(system.load.pivot, float)


def urdf_of(system: System, origin: Array, joint: str = "") -> str:
    """The body as the one link of a robot, or as one on a joint of this type to a link "world".

    origin: (3,) m, where the link's frame stands, from the body's origin; its axes are the body's.
    joint: "floating", or a type of the reader's own; a URDF has no ball joint.
    """
    body, diagonal = system.body, _is_diagonal(system)
    angles = EXCHANGED if diagonal else SLANTED
    turned = TURNED if diagonal else _roll_pitch_yaw(*SLANTED)
    tensor = turned.T @ np.array(body.inertia, float) @ turned
    entries = zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), tensor[UPPER], strict=True)
    inertia = " ".join(f'{name}="{_text(value)}"' for name, value in entries)
    ends = f'<parent link="world"/><child link="{NAME}"/>'
    held = f'<link name="world"/>\n<joint name="joint" type="{joint}">{ends}</joint>\n'
    return f"""<?xml version="1.0"?>
<robot name="robot">
{held if joint else ""}<link name="{NAME}"><inertial>
  <origin xyz="{_text(body.center_of_mass - origin)}" rpy="{_text(angles)}"/>
  <mass value="{_text(body.mass)}"/>
  <inertia {inertia}/>
</inertial></link>
</robot>
"""


def mjcf_of(system: System) -> str:
    """The body on a free joint, or on a ball joint at its pivot, its compiler at its defaults.

    A diagonal tensor is given by moments and a quaternion. Of others, those of free bodies are
    given as they are, and those of pivoted ones by principal moments and axes.
    """
    body, pivot = system.body, origin_at_pivot(system)
    free, tensor = system.load.pivot is None, np.array(body.inertia, float)
    if _is_diagonal(system):
        inertia = _moments(np.diagonal(TURNED.T @ tensor @ TURNED), TURNED_QUATERNION)
    elif free:
        full = [tensor[at] for at in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
        inertia = f'fullinertia="{_text(full)}"'
    else:
        inertia = _moments(*principal_frame(tensor))
    joint = "<freejoint/>" if free else f'<joint type="ball" pos="{_text(pivot)}"/>'
    center = f'pos="{_text(body.center_of_mass)}" mass="{_text(body.mass)}"'
    return f"""<mujoco model="robot">
<worldbody><body name="{NAME}" pos="{_text(-pivot)}">
  {joint}
  <inertial {center} {inertia}/>
</body></worldbody>
</mujoco>
"""


def _moments(moments: object, quaternion: object) -> str:
    return f'quat="{_text(quaternion)}" diaginertia="{_text(moments)}"'


def _is_diagonal(system: System) -> bool:
    tensor = np.asarray(system.body.inertia)
    return not np.any(tensor - np.diag(np.diagonal(tensor)))


def _roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Array:
    """``Rz(yaw) Ry(pitch) Rx(roll)``, as wiki.ros.org/urdf/XML/link defines rpy."""
    (a, b, c), (s, t, u) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, a, -s], [0.0, s, a]])
    about_y = np.array([[b, 0.0, t], [0.0, 1.0, 0.0], [-t, 0.0, b]])
    about_z = np.array([[c, -u, 0.0], [u, c, 0.0], [0.0, 0.0, 1.0]])
    found: Array = about_z @ about_y @ about_x
    return found


def _text(values: object) -> str:
    """The shortest decimals that read back as the same doubles."""
    return " ".join(repr(float(value)) for value in np.ravel(np.asarray(values, dtype=float)))
