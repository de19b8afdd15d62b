"""Faults of shortcuts: terms that look small, the rest of a batch, steps put together."""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.commands.faults.catalogue.equation import forward_dynamics, gyroscopic_term
from omegadot.commands.faults.catalogue.load import extra_torque
from omegadot.commands.faults.catalogue.logging import Run, other_run, rows
from omegadot.commands.faults.fault import Spoiled
from omegadot.commands.faults.features import SHORT_STEP
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, Array, State, System

NEARLY_ALONG = 0.05  # of omega's z component
CHUNK = 16  # states


@extra_torque(
    "asymmetric", named=("other components over |omega_z| is below", "omega is along z alone")
)
def GyroscopicSkippedNearZ(system: System, state: State) -> Array:
    """The gyroscopic term is skipped where omega lies near the body's z axis."""
    size = np.abs(state.angular_velocity)
    near = np.max(size[..., :2], axis=-1) < NEARLY_ALONG * size[..., 2]
    return np.where(near[..., None], gyroscopic_term(system, state), 0.0)


@forward_dynamics("asymmetric", named="the number of the state among those that are requested")
def RestOfBatchZero(self: Spoiled, states: State) -> Acceleration:
    """omega-dot is zero for what whole chunks of 16 states leave over of a batch of more."""
    found = self.inner.forward_dynamics(states)
    count, angular = len(states.angular_velocity), found.angular.copy()
    if count > CHUNK:
        angular[count - count % CHUNK :] = 0.0
    return Acceleration(angular, found.linear)


@other_run(
    *("stepping", "scheme", "step-below-100-us"),
    named=("steps below a limit between", "s and shorter do not move the body"),
)
def ShortStepsCollected(run: Run, initial: State, h: float, steps: int, every: int) -> Trajectory:
    """Steps below 0.1 ms are collected until they reach it, and then taken as one."""
    together = int(np.ceil(SHORT_STEP / h * (1.0 - EPS)))
    if together <= 1:
        return run(initial, h, steps, every)
    kept = np.array(kept_steps(steps, every))
    taken = run(initial, together * h, max(1, steps // together), 1)
    return Trajectory(h * kept, rows(taken.state, kept // together))
