"""What XLA compiles: many steps in one loop, and the dynamics of many states at once.

The numbers of a model are arguments. Its structure is fixed in a program, which is kept by it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.mjx.model import Engine
from omegadot.adapters.mujoco.model import BODY
from omegadot.adapters.xla_loop import in_batches, logged_steps, rows_of_run
from omegadot.reference_impl.system import Array, Load


class Programs:
    """The programs of one engine, each compiled when it is first called, and never again."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self.compiled: dict[tuple[str, Any], Any] = {}

    def of(self, kind: str, structure: Any, arguments: tuple[Any, ...]) -> Any:
        """The program of a kind, for arguments of these shapes: one of ``KINDS``' integrators,
        "forward" or "inverse".
        """
        key = (kind, structure)
        if key not in self.compiled:
            own = {"forward": self._forward, "inverse": self._inverse}
            made = own[kind](structure) if kind in own else self._steps(structure, kind)
            self._engine.begin_program()
            self.compiled[key] = made.lower(*arguments).compile()
        return self.compiled[key]

    def _data(self, model: Any, applied: Any, qpos: Any, qvel: Any) -> Any:
        """`mjx.Data` with torques (6,), in body axes and in world axes, as MuJoCo's adapter."""
        data = self._engine.mjx.make_data(model)
        return data.replace(
            qpos=qpos,
            qvel=qvel,
            qfrc_applied=data.qfrc_applied.at[-3:].set(applied[:3]),
            xfrc_applied=data.xfrc_applied.at[BODY, 3:].set(applied[3:]),
        )

    def _steps(self, structure: Any, kind: str) -> Any:
        """``(numbers, applied, row, timestep, counts)`` to the rows and the last of `logged_steps`.

        A row is qpos and qvel. They are all that a step hands on, and XLA leaves out what of
        `mjx.Data` they do not need.
        """
        jax, mjx = self._engine.jax, self._engine.mjx

        def program(numbers: Any, applied: Any, start: Any, h: Any, counts: Any) -> Any:
            model = jax.tree.unflatten(structure, numbers)
            integrator = mjx.IntegratorType[kind]
            model = model.tree_replace({"opt.timestep": h, "opt.integrator": integrator})

            def step(row: Any) -> Any:
                data = self._data(model, applied, row[: model.nq], row[model.nq :])
                data = mjx.step(model, data)
                return jax.numpy.concatenate((data.qpos, data.qvel))

            return logged_steps(jax, step, lambda row: row, start, counts)

        return jax.jit(program)

    def _forward(self, structure: Any) -> Any:
        """``(numbers, applied, qpos, qvel)``, of STATES states, to qacc."""
        jax, mjx = self._engine.jax, self._engine.mjx

        def program(numbers: Any, applied: Any, qpos: Any, qvel: Any) -> Any:
            model = jax.tree.unflatten(structure, numbers)
            return mjx.forward(model, self._data(model, applied, qpos, qvel)).qacc

        return jax.jit(jax.vmap(program, (None, None, 0, 0)))

    def _inverse(self, structure: Any) -> Any:
        """``(numbers, applied, qpos, qvel, qacc)``, of STATES states, to generalised forces.

        MJX subtracts passive forces, which are damping; they are added, as the protocol has it.
        """
        jax, mjx = self._engine.jax, self._engine.mjx

        def program(numbers: Any, applied: Any, qpos: Any, qvel: Any, qacc: Any) -> Any:
            model = jax.tree.unflatten(structure, numbers)
            data = self._data(model, applied, qpos, qvel).replace(qacc=qacc)
            data = mjx.inverse(model, data)
            return data.qfrc_inverse + data.qfrc_passive

        return jax.jit(jax.vmap(program, (None, None, 0, 0, 0)))


class Loaded:
    """A model that is loaded: its numbers on the device, and the programs of its structure."""

    def __init__(self, engine: Engine, programs: Programs, model: Any, load: Load) -> None:
        self._engine, self._programs, self.places = engine, programs, int(model.nq)
        self._called: dict[str, Any] = {}
        torques = np.concatenate((np.broadcast_to(load.torque_body, 3), load.torque_world))
        with engine.active():
            leaves, self._structure = engine.jax.tree.flatten(model)
            self._numbers = tuple(map(engine.jax.numpy.asarray, leaves))
            self._applied = engine.jax.numpy.asarray(self.rounded(torques))

    def rounded(self, values: Any) -> Any:
        """An array in the engine's precision."""
        return np.asarray(values, self._engine.precision)

    def _call(self, kind: str, *arguments: Any) -> Any:
        given = (self._numbers, self._applied, *arguments)
        if kind not in self._called:  # to look for a structure takes a millisecond
            self._called[kind] = self._programs.of(kind, self._structure, given)
        return self._called[kind](*given)

    def _in_batches(self, kind: str, *columns: Array) -> Array:
        with self._engine.active():
            own = [self.rounded(column) for column in columns]
            return in_batches(lambda *batch: self._call(kind, *batch), *own)

    def forward(self, qpos: Array, qvel: Array) -> Array:
        """``qacc`` of `mjx.forward` at n states, (n, nv)."""
        return self._in_batches("forward", qpos, qvel)

    def inverse(self, qpos: Array, qvel: Array, qacc: Array) -> Array:
        """Generalised forces of `mjx.inverse` at n states and accelerations, (n, nv)."""
        return self._in_batches("inverse", qpos, qvel, qacc)

    def run(self, start: Array, kind: str, timestep: float, steps: int, every: int) -> list[Any]:
        """Rows (qpos, qvel) at the start, each `every`-th step and the last."""
        row, h = self.rounded(start), self.rounded(timestep)
        with self._engine.active():
            return [
                row[None],
                *rows_of_run(lambda at, counts: self._call(kind, at, h, counts), row, steps, every),
            ]
