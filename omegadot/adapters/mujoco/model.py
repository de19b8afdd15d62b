"""A system as a MuJoCo model: one body on a free joint, or on a ball joint at its pivot."""

from __future__ import annotations

import contextlib
import importlib
import os
from collections.abc import Iterator
from itertools import permutations
from typing import Any

import numpy as np

from omegadot.adapters.protocol import Setup, UnsupportedError, mends
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, Body, System
from omegadot.written import written

BODY = 1  # body 0 is MuJoCo's world

# Flags by name: a version knows only some of them, and what it lacks it cannot do wrong.
DISABLED = {
    "mjDSBL_AUTORESET": "reset to the model's first pose when the state diverges",
    "mjDSBL_EULERDAMP": "implicit treatment of damping in the Euler integrator",
    "mjDSBL_CONTACT": "contacts",
    "mjDSBL_CONSTRAINT": "the constraint solver",
    "mjDSBL_WARMSTART": "warm start of the constraint solver from the step before",
}
SETTINGS = ("mjDSBL_AUTORESET", "mjDSBL_EULERDAMP")  # the others act on contacts and constraints


_WINDOWS = "MUJOCO_GL"  # read by MuJoCo as it is imported


@contextlib.contextmanager
def without_windows() -> Iterator[None]:
    """No OpenGL in what is imported meanwhile, unless the user has chosen one."""
    chosen = _WINDOWS in os.environ
    os.environ.setdefault(_WINDOWS, "disable")
    try:
        yield
    finally:
        if not chosen:
            del os.environ[_WINDOWS]


def import_mujoco() -> Any:
    """MuJoCo, writing no MUJOCO_LOG.TXT into the current folder. Raises ImportError.

    Its own handler of warnings prints them and appends them to that file. Where no other is set,
    they are dropped: what they warn of is seen in the states.
    Where it is imported here first, it draws nothing: what opens windows takes longer to import
    than all the rest. MUJOCO_GL sets another.
    """
    with without_windows():
        mujoco = importlib.import_module("mujoco")
    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(lambda _: None)
    return mujoco


def switched_off(mujoco: Any) -> tuple[str, ...]:
    """What the ``physics`` setup turns off in the installed version, one clause each."""
    known = [what for name, what in DISABLED.items() if hasattr(mujoco.mjtDisableBit, name)]
    return (*known, "sleep, other optional flags and a viscous medium, which are off by default")


def _nearest_to_identity(axes: Array) -> Array:
    """The columns of a (3, 3) orthogonal matrix, reordered and signed to a rotation near 1.

    Over the six orders the sums of ``|diagonal|`` average at least 1, so the greatest exceeds 1;
    made positive it is the trace, and an orthogonal matrix with a trace above 1 is a rotation.
    """
    order = max(permutations(range(3)), key=lambda p: float(abs(axes[range(3), p]).sum()))
    axes = axes[:, order]
    return axes * np.where(np.diagonal(axes) < 0, -1.0, 1.0)


def principal_frame(inertia: Array) -> tuple[Array, Array]:
    """Principal moments (3,) and the quaternion (4,) of their axes in body axes.

    ``I = R diag(moments) Rᵀ``. A diagonal tensor comes back as it is, with the identity.
    """
    axes = _nearest_to_identity(np.linalg.eigh(inertia)[1])
    moments = np.einsum("ji,jk,ki->i", axes, inertia, axes)
    w = 0.5 * np.sqrt(1.0 + np.trace(axes))  # the trace is above 1, so that nothing cancels
    skewed = (axes - axes.T) / (4.0 * w)
    quaternion = np.array([w, skewed[2, 1], skewed[0, 2], skewed[1, 0]])
    return moments, quaternion / np.linalg.norm(quaternion)


def check_body(mujoco: Any, system: System) -> None:
    """Raise UnsupportedError for more than one body, and for one below MuJoCo's least inertia."""
    if len(system.bodies) != 1:
        raise UnsupportedError(f"the MuJoCo adapter takes one body, not {len(system.bodies)}.")
    least = float(getattr(mujoco, "mjMINVAL", 1e-15))
    moments = principal_frame(np.asarray(system.body.inertia, dtype=float))[0]
    smallest = min(float(system.body.mass), float(moments.min()))
    if not smallest > least:
        raise UnsupportedError(
            f"MuJoCo takes no mass or principal moment of {written(least)} or less, and the "
            "smallest "
            f"here is {written(smallest)}; give the body larger units."
        )


def build_model(mujoco: Any, system: System) -> Any:
    """An ``MjModel`` of the system, without geoms.

    The compiler is given the frames and a stand-in for mass and inertia; the true values are
    written into the compiled model. Its own way from a full tensor to principal axes loses up to
    nine digits in old versions, and its triangle check turns away flat bodies by one rounding.
    Raises UnsupportedError as `check_body` does.
    """
    check_body(mujoco, system)
    body, load = system.body, system.load
    axes = principal_frame(np.asarray(body.inertia, dtype=float))[1]
    spec = mujoco.MjSpec()
    element = spec.worldbody.add_body(name="body")
    if load.pivot is None:
        element.add_joint(type=mujoco.mjtJoint.mjJNT_FREE)
    else:
        element.pos = -np.asarray(load.pivot)
        element.add_joint(type=mujoco.mjtJoint.mjJNT_BALL, pos=load.pivot)
    element.explicitinertial = True
    element.mass, element.inertia = 1.0, np.ones(3)
    element.ipos, element.iquat = body.center_of_mass, axes
    model = spec.compile()
    model.dof_damping[-3:] = load.damping  # a free joint's first three are translations
    model.opt.gravity[:] = load.gravity
    write_body(mujoco, model, body)
    return model


def write_body(mujoco: Any, model: Any, body: Body) -> None:
    """Mass, centre of mass and inertia of the body into a compiled model, in place."""
    moments, axes = principal_frame(np.asarray(body.inertia, dtype=float))
    model.body_mass[BODY], model.body_inertia[BODY] = body.mass, moments
    model.body_ipos[BODY], model.body_iquat[BODY] = body.center_of_mass, axes
    mujoco.mj_setConst(model, mujoco.MjData(model))


def apply_setup(mujoco: Any, model: Any, setup: Setup) -> None:
    """Turn off the defaults that disturb the motion, or leave every default of MuJoCo as it is, or
    all but one.
    """
    for name in DISABLED:
        flag = getattr(mujoco.mjtDisableBit, name, None)
        if flag is not None and mends(setup, name):
            model.opt.disableflags |= int(flag)
    if setup == "physics":
        model.opt.enableflags = 0
        model.opt.density = model.opt.viscosity = 0.0


def body_of(model: Any) -> Body:
    """Mass, centre of mass from MuJoCo's body frame, and inertia as the compiled model holds."""
    axes = rotation_matrix(model.body_iquat[BODY])
    return Body(
        mass=np.array(model.body_mass[BODY]),
        center_of_mass=model.body_ipos[BODY].copy(),
        inertia=axes @ np.diag(model.body_inertia[BODY]) @ axes.T,
    )
