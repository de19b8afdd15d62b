"""MuJoCo's integrators, which change their mathematics from version to version.

What each version does is stated in MuJoCo's changelog and was confirmed against the reference's
schemes to rounding. A body without jointed children on a free joint ("standalone") is treated
apart by some versions; a body on a ball joint never is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import takewhile
from typing import Any

from omegadot.adapters.protocol import Integrator

_ROTATION = ("omega", "attitude", "energy", "angular_momentum")
_TRANSLATION = ("linear_momentum", "position")

_NAMES = ("Euler", "RK4", "implicit", "implicitfast", "discrete")

_MIDPOINT_NOTE = "I (ω₁ - ω₀) = dt (τ₀ - ω_m × I ω_m), ω_m = (ω₀ + ω₁)/2, q₁ = q₀ exp(dt ω_m)"


@dataclass(frozen=True)
class Case:
    """What the choice of scheme, and its orders, depend on.

    pivoted: on a ball joint.  offset: free, with the centre of mass off the body's origin.
    falls: gravity acts.  damped: the body has damping.  euler_damps: it is implicit in ``Euler``.
    turns_torque: a torque that depends on the attitude acts.
    """

    version: tuple[int, ...]
    pivoted: bool = False
    offset: bool = False
    falls: bool = False
    damped: bool = False
    euler_damps: bool = False
    turns_torque: bool = False


def _orders(rotation: int, translation: int) -> dict[str, int]:
    return {**dict.fromkeys(_ROTATION, rotation), **dict.fromkeys(_TRANSLATION, translation)}


def version_of(text: str) -> tuple[int, ...]:
    """``"3.8.1"`` to ``(3, 8, 1)``; a suffix such as ``.dev1`` is dropped."""
    return tuple(int(part) for part in takewhile(str.isdigit, text.split(".")))


def explicit(name: str, damping_is_implicit: bool) -> Integrator:
    """The gyroscopic term is taken at the step's start; damping may be implicit."""
    scheme = "implicit-damping-euler" if damping_is_implicit else "semi-implicit-euler"
    return Integrator(name, scheme, _orders(1, 1))


def _midpoint(name: str, case: Case) -> Integrator:
    """Of order 2 in rotation, unless a torque changes within the step.

    The energy has a part of order 1 where the fall, or the velocity of an origin, takes part.
    """
    order = 1 if case.damped or case.turns_torque else 2
    orders = _orders(order, 1)
    if case.offset or case.falls:
        orders["energy"] = 1
    scheme = "body-axes-midpoint" if case.offset else "frozen-torque-midpoint"
    return Integrator(name, scheme, orders, note=_MIDPOINT_NOTE)


def rk4(case: Case) -> Integrator:
    """Of order 4 from MuJoCo 4 on; before, the mean of the stages' omegas turns the body."""
    if case.version >= (4,):
        return Integrator("RK4", "munthe-kaas-rk4", _orders(4, 4))
    orders = _orders(2, 2)
    if not case.turns_torque:
        orders["omega"] = 4
        orders["energy"] = 2 if case.offset else 4
    return Integrator("RK4", "lie-rk4-naive", orders)


def _declared(name: str, case: Case) -> Integrator:
    version, midpoint = case.version, False
    match name:
        case "RK4":
            return rk4(case)
        case "Euler":
            return explicit(name, case.damped and case.euler_damps)
        case "implicit":
            midpoint = (3, 7) <= version < (3, 8, 1) and not case.pivoted
        case "implicitfast" if case.pivoted or version < (3, 7):
            return explicit(name, case.damped)
        case "implicitfast":
            midpoint = version < (3, 11)
        case "discrete" if case.pivoted:
            return explicit(name, case.damped)
    if midpoint:
        return _midpoint(name, case)
    return Integrator(name, "linearly-implicit-euler", _orders(1, 1))


def integrator_flag(mujoco: Any, name: str) -> int | None:
    """The number of ``opt.integrator``, or None where the installed version has no such one."""
    flag = getattr(mujoco.mjtIntegrator, f"mjINT_{name.upper()}", None)
    return None if flag is None or name not in _NAMES else int(flag)


def declared_integrators(mujoco: Any, case: Case) -> tuple[Integrator, ...]:
    """The installed version's integrators, with what each does in this case.

    A free joint's position is the body origin's, so that is what every one of them steps.
    """
    return tuple(
        replace(_declared(name, case), coordinates="origin-world")
        for name in _NAMES
        if integrator_flag(mujoco, name) is not None
    )
