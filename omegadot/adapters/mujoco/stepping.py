"""Many steps in native code, with memory that does not grow with their number."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Array

CHUNK = 4096  # steps a call: the call's cost vanishes, and its buffer stays in the cache


@contextmanager
def quietly(mujoco: Any) -> Iterator[None]:
    """Keep MuJoCo from printing its warnings and writing them to a file in the current folder."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


class Stepper:
    """Steps one model and keeps the rows asked for."""

    def __init__(self, mujoco: Any, model: Any, data: Any) -> None:
        self._mujoco, self._model, self._data = mujoco, model, data
        kinds = mujoco.mjtState
        self._physics = int(kinds.mjSTATE_FULLPHYSICS)
        self._applied = int(kinds.mjSTATE_QFRC_APPLIED) | int(kinds.mjSTATE_XFRC_APPLIED)
        first = mujoco.mj_stateSize(model, int(kinds.mjSTATE_TIME))
        self._kept = slice(first, first + model.nq + model.nv)
        self._rollout = self._native_rollout()

    def _native_rollout(self) -> Any:
        try:
            from mujoco.rollout import Rollout
        except ImportError:
            return None
        return Rollout(nthread=0)

    def _vector(self, kind: int) -> Array:
        vector = np.empty(self._mujoco.mj_stateSize(self._model, kind))
        self._mujoco.mj_getState(self._model, self._data, vector, kind)
        return vector

    def run(self, steps: int, every: int) -> Array:
        """Rows (qpos, qvel) at `kept_steps`, from the data's present state and applied forces."""
        wanted = np.array(kept_steps(steps, every))
        rows = np.empty((len(wanted), self._kept.stop - self._kept.start))
        rows[0] = self._vector(self._physics)[self._kept]
        with quietly(self._mujoco):
            done = self._run_native(steps, wanted, rows) if self._rollout is not None else 0
            self._run_step_by_step(done, steps, wanted, rows)
        return rows

    def _run_native(self, steps: int, wanted: Array, rows: Array) -> int:
        """Fill rows chunk by chunk; return the step reached.

        The native loop stops at MuJoCo's first warning (a huge number suffices) and repeats that
        state; the chunk is then left to `_run_step_by_step`, which goes on as MuJoCo does.
        """
        start = self._vector(self._physics)
        control = np.tile(self._vector(self._applied), (1, min(CHUNK, steps), 1))
        buffer = np.empty((1, control.shape[1], len(start)))
        done = 0
        while done < steps:
            count = min(CHUNK, steps - done)
            self._rollout.rollout(
                self._model,
                self._data,
                start[None],
                control[:, :count],
                control_spec=self._applied,
                nstep=count,
                state=buffer[:, :count],
            )
            if any(warning.number for warning in self._data.warning):
                self._restore(start, control[0, 0])
                return done
            chosen = slice(*np.searchsorted(wanted, (done, done + count), side="right"))
            rows[chosen] = buffer[0, wanted[chosen] - done - 1, self._kept]
            start = buffer[0, count - 1].copy()
            done += count
        return done

    def _restore(self, physics: Array, applied: Array) -> None:
        self._mujoco.mj_setState(self._model, self._data, physics, self._physics)
        self._mujoco.mj_setState(self._model, self._data, applied, self._applied)

    def _run_step_by_step(self, done: int, steps: int, wanted: Array, rows: Array) -> None:
        step, model, data = self._mujoco.mj_step, self._model, self._data
        row = int(np.searchsorted(wanted, done, side="right"))
        for number in range(done + 1, steps + 1):
            step(model, data)
            if number == wanted[row]:
                rows[row] = self._vector(self._physics)[self._kept]
                row += 1
