"""Engines whose answers and declarations have the right types, and numbers that are none."""

from __future__ import annotations

import json
import os
import struct
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parent))
from faulty import FAULTY_ENGINES, Faulty

from omegadot.adapters.protocol import Description, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.system import Array, State


def _with(trajectory: Trajectory, **fields: Array) -> Trajectory:
    return replace(trajectory, state=replace(trajectory.state, **fields))


class TimesAreNotNumbers(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return replace(trajectory, time=trajectory.time * np.nan)


class TimesAreInfinite(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return replace(trajectory, time=trajectory.time + np.inf)


class TimesAreHuge(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return replace(trajectory, time=trajectory.time + 1e308)


class TimesBeginEarly(Faulty):
    """A clock that begins a millisecond before the run."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        return replace(trajectory, time=trajectory.time - 1e-3)


class StartAlone(Faulty):
    """Whatever is requested, only the first sample comes back."""

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = ReferenceAdapter.run(self, initial, integrator, timestep, steps, every)
        first = integrator == FAULTY_ENGINES
        return Trajectory(found.time[:1], found.state[:1]) if first else found


class CoarseClock(Faulty):
    """Its own clock has not moved; nothing else is wrong."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        return replace(trajectory, seconds=0.0)


class InfinitePosition(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with(trajectory, position=trajectory.state.position + np.inf)


class HugeQuaternion(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with(trajectory, orientation=trajectory.state.orientation * 1e308)


class TinyQuaternion(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with(trajectory, orientation=trajectory.state.orientation * 1e-320)


class HugeOmega(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with(trajectory, angular_velocity=trajectory.state.angular_velocity * 1e300)


class Noise(Faulty):
    """Omega has noise in it, which is another in every run, the first sample's included."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        omega = trajectory.state.angular_velocity
        noise = np.random.default_rng().normal(size=omega.shape)
        return _with(trajectory, angular_velocity=omega + 1e-3 * noise)


class Forges(Faulty):
    """Writes a frame of another kind into the channel of answers."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        header = json.dumps({"body": [1], "shapes": []}).encode()
        for number in range(3, 12):
            try:
                os.write(number, struct.pack(">Q", len(header)) + header)
            except OSError:
                continue
        return trajectory


class _Declares(Faulty):
    order: int = 1

    @property
    def description(self) -> Description:
        whole = super().description
        first = replace(whole.integrators[0], orders={"omega": self.order})
        return replace(whole, integrators=(first, *whole.integrators[1:]))


class OrderTrue(_Declares):
    order = True


class OrderOfManyDigits(_Declares):
    order = 10**400
