"""Many steps in native code, with memory that does not grow with their number."""

from __future__ import annotations

from contextlib import suppress
from importlib import import_module
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array

CHUNK = 4096  # steps a rollout: the call's cost vanishes, and its buffer stays in the cache
SPARSE = 8  # steps a sample from which a call for each sample costs less than logging every step


class Stepper:
    """Steps one model and keeps the rows requested."""

    def __init__(self, mujoco: Any, model: Any, data: Any) -> None:
        self._mujoco, self._model, self._data = mujoco, model, data
        kinds = mujoco.mjtState
        self._physics = int(kinds.mjSTATE_FULLPHYSICS)
        self._applied = int(kinds.mjSTATE_QFRC_APPLIED) | int(kinds.mjSTATE_XFRC_APPLIED)
        first = mujoco.mj_stateSize(model, int(kinds.mjSTATE_TIME))
        self._kept = slice(first, first + model.nq + model.nv)
        self._rollout: Any = None
        with suppress(ImportError):  # an old version has no native loop
            self._rollout = import_module("mujoco.rollout").Rollout(nthread=0)

    def _vector(self, kind: int) -> Array:
        vector = np.empty(self._mujoco.mj_stateSize(self._model, kind))
        self._mujoco.mj_getState(self._model, self._data, vector, kind)
        return vector

    def run(self, steps: int, every: int) -> Array:
        """Rows (qpos, qvel) at the start, each `every`-th step and the last.

        From the data's present state and applied forces.
        """
        start = self._vector(self._physics)
        rows = np.empty((-(-steps // every) + 1, len(start)))
        rows[0] = start
        native = every < SPARSE and self._rollout is not None
        done = self._run_native(steps, every, rows) if native else 0
        self._run_from_sample_to_sample(done, steps, every, rows)
        return rows[:, self._kept]

    def _run_native(self, steps: int, every: int, rows: Array) -> int:
        """Fill rows chunk by chunk; return the step reached.

        The native loop stops at MuJoCo's first warning (a huge number suffices) and repeats that
        state; the chunk is then left to `_run_from_sample_to_sample`, which goes on as MuJoCo does.
        """
        start, applied = rows[0], self._vector(self._applied)
        chunk = max(1, min(CHUNK // every * every, steps))
        # forces that are not given are none
        control = np.tile(applied, (1, chunk, 1)) if applied.any() else None
        buffer = np.empty((chunk if every > 1 else 0, len(start)))
        for done in range(0, steps, chunk):
            count, first = min(chunk, steps - done), done // every + 1
            log = buffer[:count] if every > 1 else rows[first : first + count]
            self._rollout.rollout(
                self._model,
                self._data,
                start[None],
                None if control is None else control[:, :count],
                control_spec=self._applied,
                nstep=count,
                state=log[None],
            )
            if self._data.warning.number.any():
                self._mujoco.mj_setState(self._model, self._data, start, self._physics)
                self._mujoco.mj_setState(self._model, self._data, applied, self._applied)
                return done
            if every > 1:
                rows[first : first + count // every] = log[every - 1 :: every]
            start = log[-1].copy()
        rows[-1] = start
        return steps

    def _run_from_sample_to_sample(self, done: int, steps: int, every: int, rows: Array) -> None:
        step, log = self._mujoco.mj_step, self._mujoco.mj_getState
        model, data, kind = self._model, self._data, self._physics
        for row in rows[-(-done // every) + 1 :]:
            count = min(every, steps - done)
            step(model, data, count)
            log(model, data, row, kind)
            done += count
