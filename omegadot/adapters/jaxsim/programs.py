"""What XLA compiles: many steps in one loop, and the dynamics of many states at once.

The numbers of a body and its loads are arguments, so that each program is compiled once.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.jaxsim.coordinates import Coordinates
from omegadot.adapters.jaxsim.integrators import NAMES
from omegadot.adapters.jaxsim.model import Engine, described_model, model_with
from omegadot.adapters.xla_loop import in_batches, logged_steps, rows_of_run
from omegadot.reference_impl.system import Array, Load


class Programs:
    """The programs of one engine, each compiled when it is first called, and never again."""

    def __init__(self, engine: Engine) -> None:
        self._engine, self._described = engine, described_model(engine)
        self.compiled: dict[str, Any] = {}

    def of(self, kind: str, arguments: tuple[Any, ...]) -> Any:
        """The program of a kind: an integrator, "begin", "forward" or "inverse"."""
        if kind not in self.compiled:
            made = self._steps(kind) if kind in NAMES else getattr(self, f"_{kind}")()
            self.compiled[kind] = self._engine.jax.jit(made).lower(*arguments).compile()
        return self.compiled[kind]

    def _model(self, body: Any, gravity: Any, timestep: Any, integrator: str = NAMES[0]) -> Any:
        kind = self._engine.api.model.IntegratorType[integrator]
        return model_with(self._described, body, gravity, timestep, kind)

    def _data(self, model: Any, row: Any) -> Any:
        return self._engine.api.data.JaxSimModelData.build(
            model,
            base_position=row[:3],
            base_quaternion=row[3:7],
            base_linear_velocity=row[7:10],
            base_angular_velocity=row[10:],
            velocity_representation=self._engine.mixed,
        )

    def _row_of(self, data: Any) -> Any:
        parts = (data.base_position, data.base_quaternion, data.base_velocity)
        return self._engine.jax.numpy.concatenate(parts)

    def _forces(self, data: Any, loads: Any) -> Any:
        """The force and torque on the link, (1, 6), of (body, world, damping) torques, (7,)."""
        jnp = self._engine.jax.numpy
        torque = data.base_transform[:3, :3] @ loads[:3] + loads[3:6]
        torque = torque - loads[6] * data.base_velocity[3:]
        return jnp.concatenate((jnp.zeros_like(torque), torque))[None]

    def _begin(self) -> Any:
        """``(body, loads, gravity, row)`` to `JaxSimModelData` and the row that it has."""

        def program(body: Any, _: Any, gravity: Any, row: Any) -> Any:
            data = self._data(self._model(body, gravity, 0.0), row)
            return data, self._row_of(data)

        return program

    def _steps(self, integrator: str) -> Any:
        """``(body, loads, gravity, data, timestep, counts)``, as `logged_steps` has it."""
        jax, api = self._engine.jax, self._engine.api

        def program(body: Any, loads: Any, gravity: Any, start: Any, h: Any, counts: Any) -> Any:
            model = self._model(body, gravity, h, integrator)

            def step(data: Any) -> Any:
                return api.model.step(model, data, link_forces=self._forces(data, loads))

            return logged_steps(jax, step, self._row_of, start, counts)

        return program

    def _forward(self) -> Any:
        """``(body, loads, gravity, row)``, of STATES states, to accelerations."""
        jax, api = self._engine.jax, self._engine.api

        def program(body: Any, loads: Any, gravity: Any, row: Any) -> Any:
            model = self._model(body, gravity, 0.0)
            data = self._data(model, row)
            forces = self._forces(data, loads)
            return api.model.forward_dynamics(model, data, link_forces=forces)[0]

        return jax.vmap(program, (None, None, None, 0))

    def _inverse(self) -> Any:
        """``(body, loads, gravity, row, acceleration)``, of STATES states, to a force and torque.

        Loads are not subtracted.
        """
        jax, api = self._engine.jax, self._engine.api

        def program(body: Any, _: Any, gravity: Any, row: Any, acceleration: Any) -> Any:
            model = self._model(body, gravity, 0.0)
            data = self._data(model, row)
            return api.model.inverse_dynamics(model, data, base_acceleration=acceleration)[0]

        return jax.vmap(program, (None, None, None, 0, 0))


class Loaded:
    """A body that is loaded: its numbers, and the programs that take them."""

    def __init__(
        self, engine: Engine, programs: Programs, body: Any, load: Load, coordinates: Coordinates
    ) -> None:
        self._engine, self._programs = engine, programs
        torques = (load.torque_body, coordinates.to_world(load.torque_world), load.damping)
        applied = np.concatenate([np.atleast_1d(part) for part in torques])
        self._numbers = (body, self.rounded(applied), self.rounded(coordinates.gravity))

    def rounded(self, values: Any) -> Any:
        """An array in the engine's precision."""
        return np.asarray(values, self._engine.precision)

    def _call(self, kind: str, *arguments: Any) -> Any:
        given = (*self._numbers, *arguments)
        return self._programs.of(kind, given)(*given)

    def _in_batches(self, kind: str, *columns: Array) -> Array:
        with self._engine.active():
            own = [self.rounded(column) for column in columns]
            return in_batches(lambda *batch: self._call(kind, *batch), *own)

    def begin(self, row: Array) -> tuple[Any, Array]:
        """`JaxSimModelData` of a row, and the row that it has."""
        with self._engine.active():
            data, held = self._call("begin", self.rounded(row))
            return data, np.array(held, float)

    def forward(self, rows: Array) -> Array:
        """Accelerations by JaxSim's forward dynamics at n rows, (n, 6)."""
        return self._in_batches("forward", rows)

    def inverse(self, rows: Array, accelerations: Array) -> Array:
        """Force and torque by JaxSim's inverse dynamics at n rows and accelerations, (n, 6)."""
        return self._in_batches("inverse", rows, accelerations)

    def run(self, data: Any, kind: str, timestep: float, steps: int, every: int) -> list[Any]:
        """Rows at each `every`-th step and the last."""
        h = self.rounded(timestep)
        with self._engine.active():
            return rows_of_run(
                lambda at, counts: self._call(kind, at, h, counts), data, steps, every
            )
