"""MuJoCo stepped through its own Python API: `mj_step` between samples, and `mujoco.rollout`."""

from __future__ import annotations

import mujoco
import numpy as np
from bare import Bare
from mujoco.rollout import Rollout

from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array, State, System

_OFF = ("CONTACT", "CONSTRAINT", "WARMSTART", "EULERDAMP", "AUTORESET")
_STATE = int(mujoco.mjtState.mjSTATE_FULLPHYSICS)
_FORCES = int(mujoco.mjtState.mjSTATE_QFRC_APPLIED) | int(mujoco.mjtState.mjSTATE_XFRC_APPLIED)


def _model(system: System, integrator: str, timestep: float) -> mujoco.MjModel:
    """The body alone, without what a free body has no use for."""
    body, load = system.body, system.load
    spec = mujoco.MjSpec()
    element = spec.worldbody.add_body(name="body")
    if load.pivot is None:
        element.add_joint(type=mujoco.mjtJoint.mjJNT_FREE)
    else:
        element.pos = -np.asarray(load.pivot)
        element.add_joint(type=mujoco.mjtJoint.mjJNT_BALL, pos=load.pivot)
    element.explicitinertial = True
    element.mass, element.ipos = float(body.mass), body.center_of_mass
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.inertia.tolist()
    if xy or xz or yz:
        element.fullinertia = (xx, yy, zz, xy, xz, yz)
    else:  # as it stands the inertial frame is the body's, which MuJoCo makes use of
        element.inertia = (xx, yy, zz)
    model = spec.compile()
    model.dof_damping[-3:] = load.damping
    model.opt.gravity[:] = load.gravity
    model.opt.timestep = timestep
    model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    for name in _OFF:
        model.opt.disableflags |= int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{name}", 0))
    return model


def loops(
    system: System, initial: State, integrator: str, timestep: float, steps: int, every: int
) -> list[Bare]:
    """Both ways; steps is a multiple of every."""
    model = _model(system, integrator, timestep)
    data, load = mujoco.MjData(model), system.load
    loaded = bool(np.any(load.torque_body) or np.any(load.torque_world))
    size = mujoco.mj_stateSize(model, _STATE)
    state, log = np.empty((1, size)), np.empty((1, steps, size))
    control = np.empty((1, steps, mujoco.mj_stateSize(model, _FORCES))) if loaded else None
    rollout = Rollout(nthread=0)

    def start() -> None:
        mujoco.mj_resetData(model, data)
        q, w, arm = initial.orientation, initial.angular_velocity, system.body.center_of_mass
        data.qpos[-4:], data.qvel[-3:] = q, w
        if load.pivot is None:
            data.qpos[:3] = initial.position - rotate(q, arm)
            data.qvel[:3] = initial.linear_velocity - rotate(q, np.cross(w, arm))
        data.qfrc_applied[-3:], data.xfrc_applied[1, 3:] = load.torque_body, load.torque_world
        mujoco.mj_getState(model, data, state[0], _STATE)
        if control is not None:
            mujoco.mj_getState(model, data, control[0, 0], _FORCES)
            control[:] = control[0, 0]

    def roll() -> Array:
        rollout.rollout(model, data, state, control, control_spec=_FORCES, nstep=steps, state=log)
        samples: Array = log[0, every - 1 :: every]
        return samples

    def step() -> list[Array]:
        samples, advance = [], mujoco.mj_step
        keep, qpos, qvel = samples.append, data.qpos.copy, data.qvel.copy
        for _ in range(steps // every):
            advance(model, data, every)
            keep(qpos())
            keep(qvel())
        return samples

    return [
        Bare("rollout", start, roll, lambda: log[0, -1, -3:].copy()),
        Bare("mj_step", start, step, lambda: data.qvel[-3:].copy()),
    ]
