"""Faults of a worker, one a class: each strikes where its docstring states and nowhere else.

Those over `Faulty` strike in the runs of its first scheme; its second scheme stays well.
"""

from __future__ import annotations

import atexit
import ctypes
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parent))
from faulty import Faulty

from omegadot.adapters.protocol import Description, Trajectory
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

MEGABYTE = 1 << 20


def _with_omega(trajectory: Trajectory, omega: Array) -> Trajectory:
    return Trajectory(trajectory.time, replace(trajectory.state, angular_velocity=omega))


# Ends of the process.


class KillNine(Faulty):
    """kill -9, as the system does when memory runs out."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.kill(os.getpid(), signal.SIGKILL)
        return trajectory


class Segfault(Faulty):
    """Reads where there is nothing."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        ctypes.string_at(0)
        return trajectory


class Aborts(Faulty):
    """What a failed assertion in native code does, with a last output full of escape codes."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.write(2, b"\x1b[31mAssertion `inertia > 0' failed.\x1b[0m\x00\xff\n")
        os.abort()


class NamelessSignal(Faulty):
    """A real-time signal, which has no name."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.kill(os.getpid(), signal.SIGRTMIN + 1)
        return trajectory


class ExitsWithZero(Faulty):
    """Leaves in the middle as if all were well."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os._exit(0)


class LeavesAChild(Faulty):
    """Dies, and a child that it forked holds the pipes open."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        if os.fork() == 0:
            time.sleep(3600)
        os._exit(9)


class LeavesADaemon(Faulty):
    """Dies, and a child that it forked has made itself a session of its own."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        if os.fork() == 0:
            os.setsid()
            if os.fork() == 0:
                time.sleep(3600)
            os._exit(0)
        time.sleep(0.2)
        os._exit(9)


class ClosesItsChannel(Faulty):
    """Closes every file that it can find."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.closerange(0, 1024)
        return trajectory


class ClosesAndStays(Faulty):
    """Closes every file and does not go."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.closerange(0, 1024)
        time.sleep(3600)
        return trajectory


class WritesIntoTheChannel(Faulty):
    """Prints into every open file, the channel of its answers among them."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        for descriptor in range(3, 64):
            try:
                os.write(descriptor, b"Warning: the contact solver did not converge\n")
            except OSError:
                continue
        return trajectory


# Exceptions.


class Exits(Faulty):
    """sys.exit(0) in the middle of a run."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        sys.exit(0)


class Interrupts(Faulty):
    """Raises what Ctrl-C raises."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        raise KeyboardInterrupt


class Recurses(Faulty):
    """Calls itself without end."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        return self.fail(trajectory)


class EatsMemory(Faulty):
    """Takes memory a little at a time, and keeps it, until there is none."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        self.hoard = []
        while True:
            self.hoard.append(bytearray(MEGABYTE))


class LongMessage(Faulty):
    """An exception with 10 MB of text."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        raise ValueError("no convergence, residuals: " + "0.1 " * (10 * MEGABYTE // 4))


class OddMessage(Faulty):
    """Escape codes, NUL, half of a surrogate pair, and the markup of terminals and pages."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        raise ValueError("\x1b[2J\x07\x00\ud800 [/red] [bold <script>alert(1)</script> {{ x }} ok")


class Speechless(Faulty):
    """An exception that cannot be printed."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        class SilentError(Exception):
            def __str__(self) -> str:
                raise RuntimeError("not even this")

        raise SilentError


# Answers that are none.


class ReturnsNothing(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return None  # type: ignore[return-value]


class WrongShape(Faulty):
    """A quaternion without its scalar."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        short = trajectory.state.orientation[:, 1:]
        return Trajectory(trajectory.time, replace(trajectory.state, orientation=short))


class FewerStatesThanTimes(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        rest = State(*(values[1:] for values in vars(trajectory.state).values()))
        return Trajectory(trajectory.time, rest)


class ComplexNumbers(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with_omega(trajectory, trajectory.state.angular_velocity + 0j)


class Strings(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with_omega(trajectory, trajectory.state.angular_velocity.astype(str))


class RaggedRows(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with_omega(trajectory, [[1.0, 2.0, 3.0], [1.0, 2.0]])  # type: ignore[arg-type]


# Answers that are wrong.


class TooFewSamples(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        rest = State(*(values[:-2] for values in vars(trajectory.state).values()))
        return Trajectory(trajectory.time[:-2], rest)


class NoSamples(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        none = State(*(values[:0] for values in vars(trajectory.state).values()))
        return Trajectory(trajectory.time[:0], none)


class NotANumber(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        omega = trajectory.state.angular_velocity.copy()
        omega[-1] = np.nan
        return _with_omega(trajectory, omega)


class Infinite(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        omega = trajectory.state.angular_velocity.copy()
        omega[-1, 0] = np.inf
        return _with_omega(trajectory, omega)


class Astronomical(Faulty):
    """Finite, and beyond what can be squared."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        return _with_omega(trajectory, 1e300 * trajectory.state.angular_velocity)


# Noise around sound answers.


class Floods(Faulty):
    """150 MB on standard output and as much on standard error."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        line = (b"warning: " + b"x" * 1000)[:1023] + b"\n"
        for descriptor in (1, 2):
            for _ in range(150):
                os.write(descriptor, 1024 * line)
        return trajectory


class Twin(Faulty):
    """Forks, and its child goes on as if it were the worker."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.fork()
        return trajectory


class Reads(Faulty):
    """Reads from the terminal."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        assert sys.stdin.readline() == ""
        return trajectory


class HangsAtExit(Faulty):
    """Sound, and cannot let go."""

    def __init__(self, setup: str = "physics") -> None:
        super().__init__(setup)  # type: ignore[arg-type]
        atexit.register(time.sleep, 3600)

    def fail(self, trajectory: Trajectory) -> Trajectory:
        return trajectory


# Elsewhere than in a run.


class Elsewhere(Faulty):
    """Its runs are well."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        return trajectory


class DiesInInit(Elsewhere):
    def __init__(self, setup: str = "physics") -> None:
        os.abort()


class NoDescription(Elsewhere):
    @property
    def description(self) -> Description:
        return None  # type: ignore[return-value]


class DiesInLoad(Elsewhere):
    def load(self, system: System) -> None:
        os.abort()


class ExitsInLoad(Elsewhere):
    def load(self, system: System) -> None:
        sys.exit("the licence has expired")


class DiesInModel(Elsewhere):
    def model(self) -> tuple[Body, ...]:
        os.abort()


class NoModel(Elsewhere):
    def model(self) -> tuple[Body, ...]:
        return None  # type: ignore[return-value]


class ModelNotANumber(Elsewhere):
    def model(self) -> tuple[Body, ...]:
        return (replace(self.system.body, inertia=np.full((3, 3), np.nan)),)


class DiesInForwardDynamics(Elsewhere):
    def forward_dynamics(self, states: State) -> Acceleration:
        os.abort()


class TorqueOfOneState(Elsewhere):
    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        return super().inverse_dynamics(states, acceleration)[0]


# Hangs.


class Sleeps(Faulty):
    def fail(self, trajectory: Trajectory) -> Trajectory:
        time.sleep(3600)
        return trajectory


class Spins(Faulty):
    """A busy loop."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        while True:
            pass


class IgnoresSignals(Faulty):
    """Sleeps, and does not listen to requests to end."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        for deaf in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            signal.signal(deaf, signal.SIG_IGN)
        time.sleep(3600)
        return trajectory


class StopsItself(Faulty):
    """As Ctrl-Z would."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.kill(os.getpid(), signal.SIGSTOP)
        return trajectory


class HoldsTheLock(Faulty):
    """Sleeps in native code with the interpreter's lock held."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        ctypes.PyDLL(None).sleep(3600)
        return trajectory


class SleepsWithAChild(Faulty):
    """It never answers, nor does a program that it started."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        os.spawnlp(os.P_WAIT, "sleep", "sleep", "3600")
        return trajectory


class SleepsWithADaemon(Faulty):
    """It never answers, and a program that it started is in a session of its own."""

    def fail(self, trajectory: Trajectory) -> Trajectory:
        subprocess.Popen(["sleep", "3600"], start_new_session=True).wait()
        return trajectory


class HangsInLoad(Elsewhere):
    def load(self, system: System) -> None:
        time.sleep(3600)
