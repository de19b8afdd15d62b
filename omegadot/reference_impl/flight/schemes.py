"""The integrators of flight simulators, which traces are compared with: they are no engine's here.

All step the vector ``y = (place, attitude, velocity, ω)`` as one, ``ẏ = f(y)``. The attitude is a
quaternion with ``q̇ = ½ q (0, ω)``, made unit after each step, or three Euler angles with their own
kinematic equations (Stevens, Lewis, Johnson, Aircraft Control and Simulation (2016), 1.3).

Adams-Bashforth methods (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993),
III.1) begin as if the first rate had held before: the first step is one of explicit Euler.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

import numpy as np

from omegadot.reference_impl.arithmetic.components import formulas_of
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.flight.euler_angles import (
    Angles,
    angle_rates,
    angles_of,
    quaternion_of,
)
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Array, State, System

Rate = Callable[[list[float]], list[float]]
Advance = Callable[[Rate, list[float], float, "deque[list[float]]"], list[float]]
WEIGHTS = {
    1: (1.0,),
    2: (1.5, -0.5),
    3: (23 / 12, -16 / 12, 5 / 12),
    4: (55 / 24, -59 / 24, 37 / 24, -9 / 24),
}


@dataclass(frozen=True)
class FlightScheme:
    """A named integrator.

    advance: y after a step, of the rate, y, the step and the rates of earlier steps, newest first.
    angles: whether the attitude is stepped as Euler angles.
    """

    name: str
    title: str
    advance: Advance
    angles: bool = False


def _adams_bashforth(order: int) -> Advance:
    def advance(rate: Rate, y: list[float], h: float, past: deque[list[float]]) -> list[float]:
        past.appendleft(rate(y))
        while len(past) < order:
            past.append(past[-1])
        terms = list(zip(WEIGHTS[order], past, strict=False))
        return [own + h * sum(w * f[i] for w, f in terms) for i, own in enumerate(y)]

    return advance


def _moved(y: list[float], h: float, f: list[float]) -> list[float]:
    return [own + h * slope for own, slope in zip(y, f, strict=True)]


def _heun(rate: Rate, y: list[float], h: float, _: deque[list[float]]) -> list[float]:
    first = rate(y)
    second = rate(_moved(y, h, first))
    return [own + 0.5 * h * (a + b) for own, a, b in zip(y, first, second, strict=True)]


def _midpoint(rate: Rate, y: list[float], h: float, _: deque[list[float]]) -> list[float]:
    return _moved(y, h, rate(_moved(y, 0.5 * h, rate(y))))


def _kutta(rate: Rate, y: list[float], h: float, _: deque[list[float]]) -> list[float]:
    a = rate(y)
    b = rate(_moved(y, 0.5 * h, a))
    c = rate(_moved(y, 0.5 * h, b))
    d = rate(_moved(y, h, c))
    return [
        own + h / 6.0 * (p + q + q + r + r + s)
        for own, p, q, r, s in zip(y, a, b, c, d, strict=True)
    ]


_METHODS: dict[str, tuple[str, Advance]] = {
    "explicit-euler": ("Explicit Euler", _adams_bashforth(1)),
    "adams-bashforth-2": ("Adams-Bashforth 2 with an Euler start", _adams_bashforth(2)),
    "adams-bashforth-3": ("Adams-Bashforth 3 with an Euler start", _adams_bashforth(3)),
    "adams-bashforth-4": ("Adams-Bashforth 4 with an Euler start", _adams_bashforth(4)),
    "heun": ("Runge-Kutta 2 (Heun)", _heun),
    "midpoint": ("Runge-Kutta 2 (midpoint)", _midpoint),
    "rk4": ("Runge-Kutta 4", _kutta),
}
FLIGHT_SCHEMES: dict[str, FlightScheme] = {}
for _name, (_title, _advance) in _METHODS.items():
    if _name != "rk4":  # on the quaternion it is a scheme of the engines': rk4-quaternion
        FLIGHT_SCHEMES[_name] = FlightScheme(_name, _title, _advance)
    _own = f"{_name}-euler-angles"
    FLIGHT_SCHEMES[_own] = FlightScheme(_own, f"{_title} on Euler angles", _advance, angles=True)


def step_flight(
    scheme: FlightScheme,
    system: System,
    initial: State,
    dt: float,
    steps: int,
    every: int,
    angles: Angles | None = None,
) -> State:
    """The states of step 0, each `every`-th and the last, (n, ...).

    One that diverges, or whose Euler angles reach their singularity, goes on as NaN.
    """
    chart = angles or Angles()
    q, v = to_coordinates(system, initial, "com-world")
    place = q[:-4]
    attitude = angles_of(normalize(q[-4:]), chart) if scheme.angles else q[-4:]
    y = [*place.tolist(), *attitude.tolist(), *v.tolist()]
    rate = _rate(system, len(place), chart if scheme.angles else None)
    past: deque[list[float]] = deque(maxlen=4)
    kept, found, broken = set(kept_steps(steps, every)), [y], [float("nan")] * len(y)
    for number in range(1, steps + 1):
        try:
            y = scheme.advance(rate, y, dt, past)
            if not scheme.angles:
                _make_unit(y, len(place))
        except (OverflowError, ValueError, ZeroDivisionError):
            rest = sum(k >= number for k in kept)
            found += [broken] * rest
            break
        if number in kept:
            found.append(y)
    return _states(system, np.array(found), len(place), chart if scheme.angles else None)


def _make_unit(y: list[float], at: int) -> None:
    w, a, b, c = y[at : at + 4]
    size = sqrt(w * w + a * a + b * b + c * c)
    y[at : at + 4] = [w / size, a / size, b / size, c / size]


def _rate(system: System, at: int, chart: Angles | None) -> Rate:
    """``ẏ`` in components: the places' velocities, the attitude's rate, the accelerations."""
    motion = body_motion(system)
    formulas = formulas_of(motion.coordinate_rate, motion.acceleration, motion.normalize)
    if formulas is None:  # all of a body's are made of components
        raise TypeError("the motion is not written in components")
    coordinate_rate, acceleration, unit = formulas
    split = at + (3 if chart else 4)
    if chart is None:

        def of_quaternion(y: list[float]) -> list[float]:
            q, v = y[:split], y[split:]
            return [*coordinate_rate(q, v), *acceleration(unit(q), v)]

        return of_quaternion
    turning = angle_rates(chart)

    def of_angles(y: list[float]) -> list[float]:
        e, v = y[at:split], y[split:]
        q = quaternion_of(e, chart)
        return [*v[:-3], *turning(e, v[-3:]), *acceleration([*y[:at], *q], v)]

    return of_angles


def _states(system: System, y: Array, at: int, chart: Angles | None) -> State:
    split = at + (3 if chart else 4)
    attitude = y[:, at:split]
    if chart is not None:
        finite = np.all(np.isfinite(y), axis=-1)
        whole = np.full((len(y), 4), np.nan)
        whole[finite] = [quaternion_of(e, chart) for e in attitude[finite].tolist()]
        attitude = whole
    q = np.concatenate((y[:, :at], attitude), axis=-1)
    return from_coordinates(system, q, y[:, split:], "com-world")
