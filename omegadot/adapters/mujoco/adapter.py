"""MuJoCo behind the protocol: one body on a free joint or pivoted on a ball joint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.body_files import origin_at_pivot
from omegadot.adapters.mujoco.coordinates import Coordinates
from omegadot.adapters.mujoco.importer import read_model
from omegadot.adapters.mujoco.integrators import (
    Case,
    declared_integrators,
    integrator_flag,
    version_of,
)
from omegadot.adapters.mujoco.model import (
    BODY,
    SETTINGS,
    apply_setup,
    body_of,
    build_model,
    import_mujoco,
    switched_off,
)
from omegadot.adapters.mujoco.stepping import Stepper
from omegadot.adapters.protocol import (
    ONE_BODY,
    Description,
    Format,
    Setup,
    Trajectory,
    UnsupportedError,
    mends,
)
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

_CONVENTIONS = (
    "quaternions are (w, x, y, z), world-from-body",
    "a free joint's position and linear velocity are those of the body's origin, in world axes",
    "angular velocity and acceleration are in body axes",
    "with the centre of mass off the origin, steps are taken in the origin's velocity",
    "qfrc_applied is in the joint's axes, xfrc_applied in world axes at the centre of mass",
)
_LINKS = (
    "https://mujoco.readthedocs.io/en/stable/computation/index.html#numerical-integration",
    "https://mujoco.readthedocs.io/en/stable/changelog.html",
    "https://github.com/google-deepmind/mujoco",
)


class MujocoAdapter:
    """MuJoCo 3.6 and later. Raises ImportError when MuJoCo is not installed."""

    def __init__(self, setup: Setup = "physics") -> None:
        self._mujoco: Any = import_mujoco()
        self._setup: Setup = setup
        self._load = Load()
        self._model: Any = None

    @property
    def description(self) -> Description:
        """The engine; once a system is loaded, its integrators as they act on that system."""
        mujoco = self._mujoco
        return Description(
            name="mujoco",
            version=mujoco.__version__,
            integrators=declared_integrators(mujoco, self._case()),
            conventions=_CONVENTIONS,
            switched_off=switched_off(mujoco) if self._setup == "physics" else (),
            settings=tuple(n for n in SETTINGS if hasattr(mujoco.mjtDisableBit, n)),
            features=ONE_BODY,
            licence="Apache-2.0",
            links=_LINKS,
            importers=("urdf", "mjcf"),
        )

    def _case(self) -> Case:
        load, pivoted = self._load, self._load.pivot is not None
        offset = self._model is not None and bool(np.any(self._model.body_ipos[BODY]))
        return Case(
            version=version_of(self._mujoco.__version__),
            pivoted=pivoted,
            offset=offset and not pivoted,
            falls=bool(np.any(load.gravity)),
            damped=bool(np.any(load.damping)),
            euler_damps=not mends(self._setup, "mjDSBL_EULERDAMP"),
            turns_torque=bool(np.any(load.torque_world) or (pivoted and np.any(load.gravity))),
        )

    def load(self, system: System) -> None:
        """Build the model, forgetting any earlier one. Raises what `build_model` raises."""
        self._take(system, lambda: (build_model(self._mujoco, system), np.zeros(3)))

    def load_file(self, system: System, via: Format) -> None:
        """The same with a model that MuJoCo reads from a file. Raises what `read_model` raises."""
        self._take(system, lambda: read_model(self._mujoco, system, via))

    def _take(self, system: System, made: Callable[[], tuple[Any, Array]]) -> None:
        mujoco = self._mujoco
        self._model, self._load = None, Load()  # a refused system leaves nothing behind either
        self._model, self._origin = made()
        apply_setup(mujoco, self._model, self._setup)
        self._load = system.load
        self._data = mujoco.MjData(self._model)
        self._stepper = Stepper(mujoco, self._model, self._data)
        arm = self._model.body_ipos[BODY] + (self._origin - origin_at_pivot(system))
        self._coordinates = Coordinates(arm, pivoted=system.load.pivot is not None)
        self._reset()

    def _reset(self, integrator: str = "Euler") -> None:
        """A clean slate: no memory of earlier calls, the loads acting."""
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qfrc_applied[-3:] = self._load.torque_body
        self._data.xfrc_applied[BODY, 3:] = self._load.torque_world
        flag = integrator_flag(self._mujoco, integrator)
        if flag is None:
            raise UnsupportedError(f"MuJoCo {self._mujoco.__version__} has no {integrator!r}.")
        self._model.opt.integrator = flag

    def native(self) -> dict[str, dict[str, str]]:
        """Conventions as measured of the engine itself, and its defaults."""
        from omegadot.adapters.mujoco.native import conventions, defaults

        return {"conventions": conventions(self._mujoco), "defaults": defaults(self._mujoco)}

    def model(self) -> tuple[Body, ...]:
        """Mass, centre of mass and inertia, read back from the compiled model."""
        found = body_of(self._model)
        return (replace(found, center_of_mass=found.center_of_mass + self._origin),)

    def set_state(self, state: State) -> None:
        """Put MuJoCo in a state, its clock at zero."""
        self._reset()
        self._data.qpos[:], self._data.qvel[:] = self._coordinates.of_state(state)

    def get_state(self) -> State:
        """MuJoCo's present state."""
        return self._coordinates.to_state(self._data.qpos, self._data.qvel)

    def forward_dynamics(self, states: State) -> Acceleration:
        """``qacc`` of ``mj_forward`` at n states, as ω̇ and the centre of mass's acceleration.

        The integrator is set to Euler: under ``discrete`` qacc is a step's difference quotient.
        """
        self._reset()
        model, data, forward = self._model, self._data, self._mujoco.mj_forward
        qpos, qvel, qacc = data.qpos, data.qvel, data.qacc
        positions, velocities = self._coordinates.of_state(states)
        found = np.empty(velocities.shape)
        for row in range(len(found)):
            qpos[:] = positions[row]
            qvel[:] = velocities[row]
            forward(model, data)
            found[row] = qacc
        return self._coordinates.to_acceleration(states, found)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """Torque (n, 3) of ``mj_inverse``, to which MuJoCo's passive (damping) forces are added."""
        self._reset()
        model, data, inverse = self._model, self._data, self._mujoco.mj_inverse
        positions, velocities = self._coordinates.of_state(states)
        accelerations = self._coordinates.of_acceleration(states, acceleration)
        found = np.empty(velocities.shape)
        for row in range(len(found)):
            data.qpos[:], data.qvel[:] = positions[row], velocities[row]
            data.qacc[:] = accelerations[row]
            inverse(model, data)
            found[row] = data.qfrc_inverse + data.qfrc_passive
        return self._coordinates.to_torque(states, found)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Step natively. Raises UnsupportedError for an integrator this version lacks."""
        kept = kept_steps(steps, every)
        self._reset(integrator)
        self._model.opt.timestep = timestep
        places = self._model.nq
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            self._data.qpos[:], self._data.qvel[:] = self._coordinates.of_state(initial)
            began = perf_counter()
            rows = self._stepper.run(steps, every)
            seconds = perf_counter() - began
            state = self._coordinates.to_state(rows[:, :places], rows[:, places:])
        return Trajectory(np.array(kept) * timestep, state, seconds)
