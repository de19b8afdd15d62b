"""Engines that control their error, over SciPy's methods: sound ones, and ones with a fault."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from scipy.integrate import solve_ivp

from omegadot.adapters.protocol import Description, Integrator, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.schemes.scheme import every_channel
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Array, State, System

MANY = 6  # the runs of one sweep, with the finer ones


class ErrorControlled(ReferenceAdapter):
    """A body's quaternion, omega, position and velocity, by one of SciPy's methods."""

    METHOD, ORDER = "DOP853", 8
    FINEST: ClassVar[float] = 0.0
    ENDS_AT_SAMPLES: ClassVar[bool] = False

    @property
    def description(self) -> Description:
        own = Integrator("adaptive", None, every_channel(self.ORDER), "accuracy")
        own = replace(own, finest_accuracy=self.FINEST)
        return replace(super().description, name="adaptive", integrators=(own,))

    def load(self, system: System) -> None:
        super().load(system)
        body, load = system.body, system.load
        self.inertia = np.asarray(moving_inertia(system), dtype=float)
        self.inverse = np.linalg.inv(self.inertia)
        self.lever = np.zeros(3) if load.pivot is None else body.center_of_mass - load.pivot
        self.moves = float(load.pivot is None)

    def rate(self, time: float, y: Array) -> Array:
        """The rates of the 13 numbers."""
        load, mass = self.system.load, float(self.system.body.mass)
        q, w = y[:4], y[4:7]
        turning = 0.5 * np.concatenate(([-q[1:] @ w], q[0] * w + cross(q[1:], w)))
        to_body = rotation_matrix(q / math.sqrt(q @ q)).T
        torque = load.torque_body + to_body @ load.torque_world - load.damping * w
        torque = torque + cross(self.lever, to_body @ (mass * load.gravity))
        angular = self.inverse @ (torque - cross(w, self.inertia @ w))
        return np.concatenate((turning, angular, self.moves * y[10:], self.moves * load.gravity))

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        """The numbers at some times."""
        size = np.repeat([1.0, np.linalg.norm(start[4:7]) or 1.0, 1.0, 1.0], (4, 3, 3, 3))
        how: dict[str, Any] = {"method": self.METHOD, "rtol": accuracy, "atol": accuracy * size}
        if not self.ENDS_AT_SAMPLES:
            span = (0.0, times[-1])
            return np.asarray(solve_ivp(self.rate, span, start, t_eval=times, **how).y.T)
        rows = [start]
        for span in itertools.pairwise(times):
            rows.append(solve_ivp(self.rate, span, rows[-1], **how).y[:, -1])
        return np.array(rows)

    def run(
        self,
        initial: State,
        integrator: str,
        timestep: float,
        steps: int,
        every: int,
        accuracy: float | None = None,
    ) -> Trajectory:
        assert accuracy is not None
        times = timestep * np.array(kept_steps(steps, every))
        start = np.concatenate(tuple(vars(initial).values()))
        y = self.solved(start, times, accuracy)
        q = np.concatenate((y[:1, :4], normalize(y[1:, :4])))
        state = State(q, y[:, 4:7], y[:, 7:10], y[:, 10:])
        return Trajectory(times, place_on_pivot(self.system, state))


class EndsAtSamples(ErrorControlled):
    METHOD, ORDER = "RK45", 5
    ENDS_AT_SAMPLES = True


class DormandPrince(ErrorControlled):
    METHOD, ORDER = "RK45", 5


class Multistep(ErrorControlled):
    METHOD, ORDER = "LSODA", 5


class CoarseAndDeclared(ErrorControlled):
    """It keeps no tolerance below 1e-7, and declares it."""

    FINEST = 1e-7

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        return super().solved(start, times, max(accuracy, self.FINEST))


STAGES = (
    *((1 / 4,), (3 / 32, 9 / 32), (1932 / 2197, -7200 / 2197, 7296 / 2197)),
    *((439 / 216, -8, 3680 / 513, -845 / 4104), (-8 / 27, 2, -3544 / 2565, 1859 / 4104, -11 / 40)),
)
FOURTH = np.array([25 / 216, 0, 1408 / 2565, 2197 / 4104, -1 / 5, 0])
FIFTH = np.array([16 / 135, 0, 6656 / 12825, 28561 / 56430, -9 / 50, 2 / 55])


class Fehlberg(ErrorControlled):
    """Fehlberg's pair. It keeps the fourth order, the estimate is a root mean square, and steps
    end at samples: at 1e-9 these are shorter than the tolerance requires, at 1e-11 hardly longer.
    """

    ORDER, FINEST = 4, 1e-11
    KEPT: ClassVar[Array] = FOURTH

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        size = np.repeat([1.0, np.linalg.norm(start[4:7]) or 1.0, 1.0, 1.0], (4, 3, 3, 3))
        y, rows, step = start, [start], times[-1]
        for begin, end in itertools.pairwise(times):
            left = end - begin
            while left > 1e-13 * (end - begin):
                h = min(step, left)
                k = self.rate(begin, y)[None]
                for row in STAGES:
                    k = np.vstack((k, self.rate(begin, y + h * (row @ k))))
                estimate = h * (FIFTH - FOURTH) @ k / (accuracy * np.maximum(np.abs(y), size))
                off = float(np.sqrt(np.mean(estimate**2))) + 1e-30
                if off <= 1.0:
                    y, left = y + h * (self.KEPT @ k), left - h
                if off > 1.0 or h == step:
                    step = h * min(4.0, max(0.2, 0.9 * off**-0.2))
            rows.append(y)
        return np.array(rows)


SOUND = (ErrorControlled, EndsAtSamples, DormandPrince, Multistep, CoarseAndDeclared, Fehlberg)


class ClampsTolerance(ErrorControlled):
    """The same without a word."""

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        return super().solved(start, times, max(accuracy, 1e-7))


class IgnoresTolerance(ErrorControlled):
    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        return super().solved(start, times, 1e-6)


class Drags(ErrorControlled):
    """A torque that slows the body while it runs; its forward dynamics is sound."""

    def rate(self, time: float, y: Array) -> Array:
        found = super().rate(time, y)
        found[4:7] -= 1e-7 * y[4:7]
        return found


class StartsToDrag(ErrorControlled):
    """The same from the second half of a second on: no short run shows it."""

    def rate(self, time: float, y: Array) -> Array:
        found = super().rate(time, y)
        found[4:7] -= (1e-6 if time > 0.5 else 0.0) * y[4:7]
        return found


class RunsFast(ErrorControlled):
    def rate(self, time: float, y: Array) -> Array:
        return (1.0 + 1e-7) * super().rate(time, y)


class LinearBetweenSteps(ErrorControlled):
    """Samples on straight lines between its own steps."""

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        how: dict[str, Any] = {"method": self.METHOD, "rtol": accuracy, "atol": accuracy}
        found = solve_ivp(self.rate, (0.0, times[-1]), start, **how)
        return np.array([np.interp(times, found.t, row) for row in found.y]).T


class FehlbergIgnores(Fehlberg):
    """Its tolerance is 1e-9 at least."""

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        return super().solved(start, times, max(accuracy, 1e-9))


class FehlbergDrags(Fehlberg, Drags):
    pass


class FehlbergWeights(Fehlberg):
    """One weight is wrong in the eighth digit: its rate is not the equation's."""

    KEPT = FOURTH + np.array([0, 0, 1e-8, 0, 0, 0])


class EulerWhereCoarse(ErrorControlled):
    """Explicit Euler, one step a sample, where hardly any accuracy is requested."""

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        if accuracy < 1e-6:
            return super().solved(start, times, accuracy)
        rows = [start]
        for gap in np.diff(times):
            rows.append(rows[-1] + gap * self.rate(0.0, rows[-1]))
        return np.array(rows)


FAULTY = (
    *(ClampsTolerance, IgnoresTolerance, Drags, StartsToDrag, RunsFast, LinearBetweenSteps),
    *(EulerWhereCoarse, FehlbergIgnores, FehlbergDrags, FehlbergWeights),
)


class EndsInNothing(ErrorControlled):
    """No number comes after the middle of a run."""

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        found = super().solved(start, times, accuracy)
        found[len(times) // 2 :] = np.nan
        return found


class LaterRunsDrag(ErrorControlled):
    """Runs after the first drag."""

    runs = 0

    def solved(self, start: Array, times: Array, accuracy: float) -> Array:
        self.runs += len(times) > 2
        return super().solved(start, times, accuracy)

    def rate(self, time: float, y: Array) -> Array:
        found = super().rate(time, y)
        found[4:7] -= (1e-6 if self.runs > MANY else 0.0) * y[4:7]
        return found


class Fixed(ErrorControlled):
    """An adapter without the parameter: its tolerance is what it is."""

    TOLERANCE = 1e-7

    def run(  # type: ignore[override]
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        return super().run(initial, integrator, timestep, steps, every, self.TOLERANCE)


class FixedTight(Fixed):
    TOLERANCE = 1e-13


class FixedAndDrags(Fixed, Drags):
    pass


class FixedAndRunsFast(Fixed, RunsFast):
    pass
