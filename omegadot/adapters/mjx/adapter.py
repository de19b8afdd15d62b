"""MJX behind the protocol: one body on a free joint or pivoted on a ball joint, by JAX.

States, coordinates and the model are those of MuJoCo's adapter; what computes is MJX.
"""

from __future__ import annotations

from importlib.metadata import version
from time import perf_counter
from typing import Literal

import numpy as np

from omegadot.adapters.body_files import origin_at_pivot
from omegadot.adapters.mjx.integrators import KINDS, LIKE, declared_integrators
from omegadot.adapters.mjx.model import import_engine, put_system, read_back, switched_off
from omegadot.adapters.mjx.programs import Loaded, Programs
from omegadot.adapters.mujoco.coordinates import Coordinates
from omegadot.adapters.mujoco.integrators import Case
from omegadot.adapters.protocol import ONE_BODY, Description, Setup, Trajectory, UnsupportedError
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

CONVENTIONS = (
    "models, coordinates and forces are MuJoCo's: quaternions are (w, x, y, z), a free joint's "
    "position and velocity are those of the body's origin in world axes, omega is in body axes",
    "JAX computes in single precision unless jax_enable_x64 is set; mjx is in double, mjx-float32 "
    "in single precision",
    "a run is one loop of XLA, from sample to sample; the first call of each compiles it",
    "an omega of which no component exceeds 1e-8 rad/s does not turn the body",
)
LINKS = (
    "https://mujoco.readthedocs.io/en/stable/mjx.html",
    "https://github.com/google-deepmind/mujoco/tree/main/mjx",
)


class MjxAdapter:
    """MJX 3.17 in double precision. Raises ImportError when it is not installed."""

    name = "mjx"
    precision: Literal["float64", "float32"] = "float64"
    _loaded: Loaded | None = None

    def __init__(self, setup: Setup = "physics") -> None:
        self._engine = import_engine(self.precision)
        self._setup: Setup = setup
        self._programs = Programs(self._engine)
        self._case = Case(LIKE)

    @property
    def description(self) -> Description:
        """The engine; once a system is loaded, its integrators as they act on that system."""
        return Description(
            name=self.name,
            version=version("mujoco-mjx"),
            integrators=declared_integrators(self._case),
            precision=self.precision,
            conventions=CONVENTIONS,
            switched_off=switched_off(self._engine) if self._setup == "physics" else (),
            features=ONE_BODY | {"batch"},
            licence="Apache-2.0",
            links=LINKS,
        )

    def load(self, system: System) -> None:
        """Build the model, forgetting any earlier one. Raises what `put_system` raises."""
        self._loaded, self._case = None, Case(LIKE)
        model, load = put_system(self._engine, system, self._setup), system.load
        pivoted, self._body = load.pivot is not None, read_back(model)
        self._coordinates = Coordinates(
            self._body.center_of_mass - origin_at_pivot(system), pivoted
        )
        self._case = case_of(system.body, load, euler_damps=self._setup == "as-shipped")
        self._loaded = Loaded(self._engine, self._programs, model, load)
        nowhere = np.zeros(3)
        self.set_state(State(np.array([1.0, 0.0, 0.0, 0.0]), nowhere, nowhere, nowhere))

    def _own(self) -> Loaded:
        if self._loaded is None:
            raise RuntimeError("no system is loaded: call load() first")
        return self._loaded

    def native(self) -> dict[str, dict[str, str]]:
        """Conventions as measured of the engine itself, and its defaults."""
        from omegadot.adapters.mjx.native import conventions, defaults

        return {"conventions": conventions(self._engine), "defaults": defaults(self._engine)}

    def model(self) -> tuple[Body, ...]:
        """Mass, centre of mass and inertia, read back from the `mjx.Model`."""
        self._own()
        return (self._body,)

    def set_state(self, state: State) -> None:
        """Keep qpos and qvel as `mjx.Data` has them."""
        own = self._own()
        self._state = tuple(map(own.rounded, self._coordinates.of_state(state)))

    def get_state(self) -> State:
        """The state of qpos and qvel."""
        self._own()
        qpos, qvel = (np.array(values, float) for values in self._state)
        return self._coordinates.to_state(qpos, qvel)

    def forward_dynamics(self, states: State) -> Acceleration:
        """``qacc`` of `mjx.forward` at n states, as ω̇ and the centre of mass's acceleration."""
        found = self._own().forward(*self._coordinates.of_state(states))
        return self._coordinates.to_acceleration(states, found)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """Torque (n, 3) of `mjx.inverse`."""
        accelerations = self._coordinates.of_acceleration(states, acceleration)
        found = self._own().inverse(*self._coordinates.of_state(states), accelerations)
        return self._coordinates.to_torque(states, found)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """`mjx.step` in a loop of XLA. Raises UnsupportedError for what is no integrator of MJX."""
        own, kept = self._own(), kept_steps(steps, every)
        if integrator not in KINDS:
            raise UnsupportedError(f"mjx has no integrator {integrator!r}.")
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            start = np.concatenate(self._coordinates.of_state(initial))
            began = perf_counter()
            found = own.run(start, KINDS[integrator], timestep, steps, every)
            seconds = perf_counter() - began
            rows = np.concatenate(found, dtype=float)
            state = self._coordinates.to_state(rows[:, : own.places], rows[:, own.places :])
        return Trajectory(np.array(kept) * timestep, state, seconds)


class MjxFloat32Adapter(MjxAdapter):
    """MJX in single precision, as JAX computes by default."""

    name = "mjx-float32"
    precision = "float32"


def case_of(body: Body, load: Load, euler_damps: bool) -> Case:
    """What the schemes of MJX's integrators depend on."""
    pivoted, falls = load.pivot is not None, bool(np.any(load.gravity))
    return Case(
        version=LIKE,
        pivoted=pivoted,
        offset=not pivoted and bool(np.any(body.center_of_mass)),
        falls=falls,
        damped=bool(np.any(load.damping)),
        euler_damps=euler_damps,
        turns_torque=bool(np.any(load.torque_world)) or (pivoted and falls),
    )
