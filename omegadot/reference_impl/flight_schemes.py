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
from math import cos, sin, sqrt

import numpy as np
from scipy.spatial.transform import Rotation

from omegadot.reference_impl.body_motion import body_motion
from omegadot.reference_impl.components import Numbers, cross3, formulas_of
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
)
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import Array, State, System

Rate = Callable[[list[float]], list[float]]
Advance = Callable[[Rate, list[float], float, "deque[list[float]]"], list[float]]
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
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


@dataclass(frozen=True)
class Angles:
    """Which Euler angles. sequence: three intrinsic axes.  world, body: quaternions from the axes
    that they are relative to, to the scenario's; None where these are the same.
    """

    sequence: str = "ZYX"
    world: Array | None = None
    body: Array | None = None


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
    attitude = _angles_of(normalize(q[-4:]), chart) if scheme.angles else q[-4:]
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
    turning = _angle_rates(chart)

    def of_angles(y: list[float]) -> list[float]:
        e, v = y[at:split], y[split:]
        q = _quaternion(e, chart)
        return [*v[:-3], *turning(e, v[-3:]), *acceleration([*y[:at], *q], v)]

    return of_angles


def _turn(axis: int, angle: float) -> list[float]:
    found = [cos(0.5 * angle), 0.0, 0.0, 0.0]
    found[1 + axis] = sin(0.5 * angle)
    return found


def _product(a: Numbers, b: Numbers) -> list[float]:
    w, x, y, z = a
    p, q, r, s = b
    return [
        w * p - x * q - y * r - z * s,
        w * q + x * p + y * s - z * r,
        w * r - x * s + y * p + z * q,
        w * s + x * r - y * q + z * p,
    ]


def _axes(chart: Angles) -> list[int]:
    return ["XYZ".index(axis) for axis in chart.sequence]


def _quaternion(e: Numbers, chart: Angles) -> list[float]:
    """world_R_body between the scenario's axes."""
    first, second, third = (_turn(k, a) for k, a in zip(_axes(chart), e, strict=True))
    own = _product(_product(first, second), third)
    if chart.world is not None:
        own = _product(chart.world.tolist(), own)
    return own if chart.body is None else _product(own, conjugate(chart.body).tolist())


def _angle_rates(chart: Angles) -> Callable[[Numbers, Numbers], list[float]]:
    """``ė`` of ω in the scenario's body axes: ``ω = ė₃ k + ė₂ R₃ᵀ j + ė₁ R₃ᵀ R₂ᵀ i``."""
    i, j, k = _axes(chart)
    body = None if chart.body is None else Rotation.from_quat(np.roll(chart.body, -1))
    matrix = None if body is None else body.inv().as_matrix().tolist()
    last = [0.0, 0.0, 0.0]
    last[k] = 1.0

    def back(axis: int, angle: float, vector: Numbers) -> list[float]:
        """The transposed rotation about a coordinate axis."""
        m, n = (axis + 1) % 3, (axis + 2) % 3
        c, s = cos(angle), sin(angle)
        found = list(vector)
        found[m] = c * vector[m] + s * vector[n]
        found[n] = c * vector[n] - s * vector[m]
        return found

    def rates(e: Numbers, w: Numbers) -> list[float]:
        if matrix is not None:
            w = [sum(row[n] * w[n] for n in range(3)) for row in matrix]
        first, second = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        first[i], second[j] = 1.0, 1.0
        second = back(k, e[2], second)
        first = back(k, e[2], back(j, e[1], first))
        normals = cross3(second, last), cross3(last, first), cross3(first, second)
        volume = sum(a * b for a, b in zip(first, normals[0], strict=True))
        return [sum(a * b for a, b in zip(w, n, strict=True)) / volume for n in normals]

    return rates


def _angles_of(q: Array, chart: Angles) -> Array:
    world, body = (NO_TURN if turn is None else turn for turn in (chart.world, chart.body))
    own = quaternion_product(quaternion_product(conjugate(world), q), body)
    found: Array = Rotation.from_quat(np.roll(own, -1)).as_euler(chart.sequence)
    return found


def _states(system: System, y: Array, at: int, chart: Angles | None) -> State:
    split = at + (3 if chart else 4)
    attitude = y[:, at:split]
    if chart is not None:
        finite = np.all(np.isfinite(y), axis=-1)
        whole = np.full((len(y), 4), np.nan)
        whole[finite] = [_quaternion(e, chart) for e in attitude[finite].tolist()]
        attitude = whole
    q = np.concatenate((y[:, :at], attitude), axis=-1)
    return from_coordinates(system, q, y[:, split:], "com-world")
