"""JaxSim behind the protocol: a model of one floating link, by JAX."""

from __future__ import annotations

from importlib.metadata import version
from time import perf_counter
from typing import Literal

import numpy as np

from omegadot.adapters.jaxsim.coordinates import coordinates_of
from omegadot.adapters.jaxsim.integrators import NAMES, declared_integrators
from omegadot.adapters.jaxsim.model import import_engine, link_parameters, read_back
from omegadot.adapters.jaxsim.programs import Loaded, Programs
from omegadot.adapters.protocol import ONE_BODY, Description, Setup, Trajectory, UnsupportedError
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

CONVENTIONS = (
    "quaternions are (w, x, y, z), world-from-body; position and velocity are the body's origin's, "
    "and omega is in world axes: the mixed representation, which is JaxSim's default",
    "a step is taken in the inertial representation: the velocity is that of the point of the body "
    "at the world's origin",
    "gravity is along z alone; the adapter turns the world to have it there",
    "torques and damping are link forces, which JaxSim holds in world axes during a step; it has "
    "no ball joint",
    "importing JaxSim sets JAX to double precision; jaxsim is in double, jaxsim-float32 in single "
    "precision",
    "a run is one loop of XLA, from sample to sample; the first call of each compiles it",
)
SWITCHED_OFF = (
    "rounding by the distance from the world's origin, as JaxSim keeps the velocity of the point "
    "there: the origin is put where the body begins",
)
LINKS = (
    "https://jaxsim.readthedocs.io/",
    "https://github.com/gbionics/jaxsim",
)


class JaxsimAdapter:
    """JaxSim 0.9 in double precision. Raises ImportError when it is not installed."""

    name = "jaxsim"
    precision: Literal["float64", "float32"] = "float64"
    _loaded: Loaded | None = None

    def __init__(self, setup: Setup = "physics") -> None:
        self._engine = import_engine(self.precision)
        self._setup: Setup = setup
        self._programs = Programs(self._engine)
        self._load = Load()

    @property
    def description(self) -> Description:
        """The engine; once a system is loaded, its integrators as they act on that system."""
        return Description(
            name=self.name,
            version=version("jaxsim"),
            integrators=declared_integrators(self._load),
            precision=self.precision,
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            features=(ONE_BODY | {"batch"}) - {"pivot"},
            licence="BSD-3-Clause",
            links=LINKS,
        )

    def load(self, system: System) -> None:
        """Take the body's numbers, forgetting earlier ones. Raises as `link_parameters` does."""
        self._loaded, self._load = None, Load()
        parameters = link_parameters(self._engine, system)
        self._body, self._load = read_back(self._engine, parameters), system.load
        self._coordinates = coordinates_of(self._body.center_of_mass, system.load.gravity)
        self._loaded = Loaded(
            self._engine, self._programs, parameters, system.load, self._coordinates
        )
        nowhere = np.zeros(3)
        self.set_state(State(np.array([1.0, 0.0, 0.0, 0.0]), nowhere, nowhere, nowhere))

    def _own(self) -> Loaded:
        if self._loaded is None:
            raise RuntimeError("no system is loaded: call load() first")
        return self._loaded

    def native(self) -> dict[str, dict[str, str]]:
        """Conventions as measured of the engine itself, and its defaults."""
        from omegadot.adapters.jaxsim.native import conventions, defaults

        return {"conventions": conventions(self._engine), "defaults": defaults(self._engine)}

    def model(self) -> tuple[Body, ...]:
        """Mass, centre of mass and inertia, read back."""
        self._own()
        return (self._body,)

    def _rows_and_places(self, states: State) -> tuple[Array, Array]:
        """Rows (..., 13) and, of each, the place (..., 3) at which JaxSim's world has its origin.

        No motion depends on it but by rounding.
        """
        rows = self._coordinates.of_state(states)
        places = rows[..., :3] * (self._setup == "physics")
        rows[..., :3] -= places
        return rows, places

    def set_state(self, state: State) -> None:
        """Have JaxSim keep the state, as `JaxSimModelData`."""
        row, place = self._rows_and_places(state)
        _, self._row = self._own().begin(row)
        self._row[:3] += place

    def get_state(self) -> State:
        """The state that it has, by its own kinematics."""
        self._own()
        return self._coordinates.to_state(self._row)

    def forward_dynamics(self, states: State) -> Acceleration:
        """By `jaxsim.api.model.forward_dynamics`, the articulated-body algorithm, at n states."""
        found = self._own().forward(self._rows_and_places(states)[0])
        return self._coordinates.to_acceleration(states, found)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """Torque (n, 3) of `jaxsim.api.model.inverse_dynamics`."""
        rows, _ = self._rows_and_places(states)
        wanted = self._coordinates.of_acceleration(states, acceleration)
        return self._coordinates.to_torque(states, self._own().inverse(rows, wanted))

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """`jaxsim.api.model.step` in a loop of XLA. Raises UnsupportedError for what it has not."""
        own, kept = self._own(), kept_steps(steps, every)
        if integrator not in NAMES:
            raise UnsupportedError(f"jaxsim has no integrator {integrator!r} that steps a body.")
        with np.errstate(over="ignore", invalid="ignore"):  # a diverged run is shown as it is
            first, place = self._rows_and_places(initial)
            start, row = own.begin(first)
            began = perf_counter()
            found = own.run(start, integrator, timestep, steps, every)
            seconds = perf_counter() - began
            rows = np.concatenate([row[None], *found], dtype=float)
            rows[:, :3] += place
            state = self._coordinates.to_state(rows)
        return Trajectory(np.array(kept) * timestep, state, seconds)


class JaxsimFloat32Adapter(JaxsimAdapter):
    """JaxSim in single precision, which it calls experimental."""

    name = "jaxsim-float32"
    precision = "float32"
