"""Engines that do not answer as they should: each fails in the run of its first scheme only."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

import numpy as np

from omegadot.adapters.protocol import Description, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.system import State

FAULTY_ENGINES = "semi-implicit-euler"
WELL = "rk4-quaternion"
MARKS = "OMEGADOT_TEST_MARKS"


class Faulty(ReferenceAdapter):
    """Two schemes of the reference, of which the first is where it goes wrong."""

    @property
    def description(self) -> Description:
        whole = super().description
        kept = tuple(i for i in whole.integrators if i.name in (FAULTY_ENGINES, WELL))
        return Description(type(self).__name__.lower(), "1.0", kept, features=whole.features)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        if integrator == FAULTY_ENGINES and steps > 1:  # the warm-up step is well
            return self.fail(super().run(initial, integrator, timestep, steps, every))
        return super().run(initial, integrator, timestep, steps, every)

    def fail(self, trajectory: Trajectory) -> Trajectory:
        raise NotImplementedError


class Killed(Faulty):
    """Dies as if by kill -9, with a last output."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        print("assertion failed: mass > 0", file=sys.stderr, flush=True)
        os.kill(os.getpid(), signal.SIGKILL)
        return trajectory


class Exits(Faulty):
    """Leaves with an exit code of its own."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os._exit(7)


class Hangs(Faulty):
    """Never comes back; a file in the folder MARKS, where there is one, shows when it hangs."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        if MARKS in os.environ:
            Path(os.environ[MARKS], "hangs").touch()
        time.sleep(3600)
        return trajectory


class Raises(Faulty):
    """Raises an exception of its own."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        raise ArithmeticError("the solver did not converge")


class Diverges(Faulty):
    """Returns NaN from the middle of the run on."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        spoilt = trajectory.state.angular_velocity.copy()
        spoilt[len(spoilt) // 2 :] = np.nan
        state = trajectory.state
        return Trajectory(
            trajectory.time,
            State(state.orientation, spoilt, state.position, state.linear_velocity),
        )


class OneSample(Faulty):
    """Returns the start alone."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        return Trajectory(trajectory.time[:1], trajectory.state[:1])


class EverySampleTwice(Faulty):
    """Returns twice as many samples as were requested."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        twice = np.repeat(np.arange(len(trajectory.time)), 2)
        return Trajectory(trajectory.time[twice], trajectory.state[twice])


class Chatty(Faulty):
    """Floods standard output and error; its answers are sound."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        for stream in (sys.stdout, sys.stderr):
            for _ in range(2000):
                print("warning: " + "x" * 200, file=stream)
        os.write(1, b"\x00" * 100_000)
        return trajectory


class Unsupporting(Faulty):
    """Refuses every system."""

    def load(self, system: object) -> None:
        from omegadot.adapters.protocol import UnsupportedError

        raise UnsupportedError("this engine has no rigid bodies")


class Unstartable(Faulty):
    """Cannot be built."""

    def __init__(self, setup: str = "physics") -> None:
        raise RuntimeError("no licence found")


class Missing(Faulty):
    """Its engine is not installed."""

    def __init__(self, setup: str = "physics") -> None:
        import an_engine_that_is_not_installed  # noqa: F401
