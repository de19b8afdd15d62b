"""The grid of motions on which the closed forms are held against the truth, every regime in it."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np

from omegadot.reference_impl.closed_forms import problem_of
from omegadot.reference_impl.closed_forms.digits import many_digits
from omegadot.reference_impl.closed_forms.euler_poinsot import Constants, constants_of
from omegadot.reference_impl.closed_forms.free_rotation import inertia_and_omega
from omegadot.reference_impl.system import Array, Body, Load, State, System

SLUG_FOOT_SQUARE = (
    14.593902937206364829 * 0.3048**2
)  # kg m^2: pound-force, foot and g by definition


@dataclass(frozen=True)
class Case:
    name: str
    inertia: Array
    omega: tuple[float, float, float]
    times: tuple[float, ...]
    orientation: tuple[float, float, float, float] = (0.5, -0.3, 0.2, 0.7)
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    lever: tuple[float, float, float] | None = None  # None: a free body, of mass 1

    @property
    def system(self) -> System:
        lever = np.zeros(3) if self.lever is None else np.array(self.lever)
        pivot = None if self.lever is None else np.zeros(3)
        body = Body(np.array(1.0), lever, np.array(self.inertia, float))
        return System((body,), Load(gravity=np.array(self.gravity), pivot=pivot))

    @property
    def initial(self) -> State:
        q = np.array(self.orientation)
        return State(q, np.array(self.omega), np.zeros(3), np.zeros(3))


def constants_for(case: Case) -> Constants | None:
    """The constants of a free rotation."""
    problem = problem_of(case.system, case.initial)
    assert problem is not None
    with many_digits():
        return constants_of(*inertia_and_omega(problem.numbers))


def flip_period(case: Case) -> float:
    """``2K/λ`` s between two sign changes of the middle component; infinite without any."""
    c = constants_for(case)
    return float(2 * c.modulus.quarter / c.rate) if c else np.inf


def _tensor(xx: float, xy: float, xz: float, yy: float, yz: float, zz: float) -> Array:
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


# Rotated tensors, as their rounded entries xx, xy, xz, yy, yz, zz stand.
_FULL = _tensor(
    2.1727878392526416,
    0.1887767968294934,
    -0.5297833822347697,
    2.162106434237243,
    -0.2561074492770854,
    1.2651057265101135,
)
_OTHER = _tensor(
    1.1611436323394781,
    0.10135925882350255,
    0.3647595622036811,
    1.305254282554745,
    0.2732340034742986,
    1.8336020851057784,
)
_PROLATE = _tensor(
    1.1697659644164686,
    0.36259715571786805,
    -0.09730767907789638,
    1.8416389937058184,
    0.04249824284589013,
    1.9885950418777145,
)
_BAR = _tensor(
    0.4359670049486816,
    -0.2957869507432664,
    0.3980066472833881,
    0.8448851024716396,
    0.20872036495806937,
    0.7191488925796788,
)
_T = (0.0, 0.13, 1.0, 2.7, 6.1)
_BACK = (-0.4, -3.3)
_DEGREES = tuple(radians(x) for x in (10.0, 20.0, 30.0))
_BRICK = tuple(SLUG_FOOT_SQUARE * x for x in (0.001894220, 0.006211019, 0.007194665))


def _diagonal(*moments: float) -> Array:
    return np.diag(moments)


FREE = [
    Case("about-least", _diagonal(1, 2, 3), (1.0, 0.1, 0.2), _T),
    Case("about-greatest", _diagonal(1, 2, 3), (0.2, 0.1, 1.0), _T),
    Case("about-least-negative", _diagonal(1, 2, 3), (-1.0, -0.2, 0.3), _T),
    Case("about-greatest-negative", _diagonal(1, 2, 3), (0.3, -1.0, -1.2), _T),
    Case("order-231", _diagonal(2, 3, 1), (0.3, 0.7, 1.1), _T),
    Case("order-312", _diagonal(3, 1, 2), (0.3, -0.7, 0.4), _T),
    Case("order-321-back", _diagonal(3, 2, 1), (0.3, 0.5, -0.4), _BACK),
    Case("order-132-back", _diagonal(1, 3, 2), (0.9, 0.5, 0.4), _BACK),
    Case("order-213", _diagonal(2, 1, 3), (-0.9, 0.5, 0.4), _T),
    Case("near-middle", _diagonal(1, 2, 3), (0.01, 2.0, 0.01), _T),
    Case("near-middle-other-side", _diagonal(1, 2, 3), (-0.01, 2.0, 0.003), _T),
    Case("nearer-middle", _diagonal(1, 2, 3), (1e-6, 2.0, -1e-5), _T),
    Case("nearest-middle", _diagonal(1, 2, 3), (1e-9, -2.0, 0.0), (0.0, 5.0, 11.0, 18.0)),
    Case("moderate-nome", _diagonal(1, 2, 3), (0.3, 1.0, 0.08), _T),
    Case("switch-of-series", _diagonal(1, 2, 3), (0.3, 1.0, 0.1285), _T),
    Case("complement-1e-12", _diagonal(1.5, 2, 3), (2.0, 0.5, 1.0 + 1.3e-12), _T),
    Case("separatrix", _diagonal(1.5, 2, 3), (2.0, 0.5, 1.0), _T),
    Case("separatrix-back", _diagonal(3, 2, 1.5), (1.0, 0.5, -2.0), _BACK),
    Case("spin-least", _diagonal(1, 2, 3), (1.3, 0.0, 0.0), _T),
    Case("spin-middle", _diagonal(1, 2, 3), (0.0, 1.3, 0.0), _T),
    Case("spin-greatest", _diagonal(1, 2, 3), (0.0, 0.0, 1.3), _T),
    Case("close-to-least", _diagonal(1, 2, 3), (1.3, 1e-8, 2e-8), _T),
    Case("close-to-greatest", _diagonal(1, 2, 3), (1e-8, 2e-8, 1.3), _T),
    Case("rest", _diagonal(1, 2, 3), (0.0, 0.0, 0.0), _T),
    Case("sphere", _diagonal(2, 2, 2), (0.4, -0.5, 0.6), _T),
    Case("prolate", _diagonal(1, 2, 2), (0.4, -0.5, 0.6), _T),
    Case("oblate", _diagonal(1, 1, 2), (0.4, -0.5, 0.6), _T),
    Case("prolate-z", _diagonal(2, 2, 1), (0.4, -0.5, 0.6), _BACK),
    Case("in-the-equator", _diagonal(1, 1, 2), (0.4, -0.5, 0.0), _T),
    Case("nearly-prolate", _diagonal(1, 2, 2 + 4e-14), (0.4, -0.5, 0.6), _T),
    Case("nearly-oblate", _diagonal(1, 1 + 1e-14, 2), (0.4, -0.5, 0.6), _T),
    Case("nearly-sphere", _diagonal(1, 1 + 1e-13, 1 + 3e-13), (0.4, -0.5, 0.6), _T),
    Case("full-tensor", _FULL, (0.4, -0.5, 0.6), _T),
    Case("full-tensor-back", _OTHER, (-0.4, 0.9, 0.2), _BACK),
    Case("full-tensor-prolate", _PROLATE, (0.4, -0.5, 0.6), _T),
    Case("full-tensor-thin-bar", _BAR, (0.4, -0.5, 0.6), (0.0, 0.01, 0.05)),
    Case("flat-plate", _diagonal(1, 2, 3), (0.7, 0.1, 0.4), _T),
    Case("van-zon-schofield", _diagonal(10, 20, 26), (1.0, 15.0, 1.0), (0.0, 0.2, 1.0)),
    Case("check-case-2", np.diag(_BRICK), _DEGREES, (10.0, 30.0), (1.0, 0.0, 0.0, 0.0)),
    Case("ten-periods", _diagonal(1, 2, 3), (0.5, 0.4, 1.0), (30.0, 60.0), (1.0, 0.0, 0.0, 0.0)),
]


def _tilt(angle: float) -> tuple[float, float, float, float]:
    return cos(angle / 2), sin(angle / 2), 0.0, 0.0


_G = (0.0, 0.0, -9.81)
_UP = (0.0, 0.0, 0.3)
_FAR = (0.0, 0.0, 1.0)
_I = _diagonal(0.91, 0.91, 0.5)
_SPHERE = _diagonal(1, 1, 1)

TOPS = [
    Case("top", _I, (0.1, 0.2, 8.0), _T, _tilt(0.7), _G, _UP),
    Case("top-back", _I, (0.1, 0.2, 8.0), _BACK, _tilt(0.7), _G, _UP),
    Case("no-spin", _I, (0.1, 0.2, 0.0), _T, _tilt(0.7), _G, _UP),
    Case("cusps", _I, (0.0, 0.0, 8.0), _T, _tilt(0.7), _G, _UP),
    Case("low", _I, (1.0, 2.0, -3.0), _T, _tilt(2.7), _G, _UP),
    Case("loops", _I, (0.0, 0.7, -3.0), _T, _tilt(1.0), _G, _UP),
    Case("tilted-gravity", _I, (1.0, 2.0, -3.0), _T, (0.5, -0.3, 0.2, 0.7), (1.0, 2.0, -9.0), _UP),
    Case("through-the-top", _I, (0.1, 0.2, 3.0), _T, (1.0, 0.0, 0.0, 0.0), _G, _UP),
    Case("through-the-bottom", _I, (0.1, 0.2, 3.0), _T, (0.0, 1.0, 0.0, 0.0), _G, _UP),
    Case("sleeping-stable", _I, (0.0, 0.0, 9.0), _T, _tilt(1e-5), _G, _UP),
    Case("sleeping-unstable", _I, (0.0, 0.0, 5.0), _T, _tilt(1e-5), _G, _UP),
    Case("asleep", _I, (0.0, 0.0, 5.0), _T, (1.0, 0.0, 0.0, 0.0), _G, _UP),
    Case("hanging", _I, (0.0, 0.0, 5.0), _T, (0.0, 1.0, 0.0, 0.0), _G, _UP),
    Case("pendulum-over", _I, (5.0, 0.0, 0.0), _T, _tilt(1.0), _G, _UP),
    Case("pendulum", _I, (0.5, 0.0, 0.0), _T, _tilt(1.0), _G, _UP),
    Case("pendulum-from-the-top", _I, (0.5, 0.0, 0.0), _T, (1.0, 0.0, 0.0, 0.0), _G, _UP),
    Case("sphere-top", _SPHERE, (0.5, 0.2, 2.0), _T, _tilt(0.3), _G, _UP),
    Case("sphere-any-lever", _SPHERE, (0.5, 0.2, 2.0), _T, _tilt(0.3), _G, (0.1, 0.2, 0.3)),
    Case("lever-along-x", _diagonal(0.5, 1, 1), (6.0, 0.2, 0.1), _T, _tilt(0.3), _G, (-0.4, 0, 0)),
    Case("critical", _diagonal(3, 3, 0.5), (2.0, 0.0, 0.0), _T, (1, 1, 0, 0), (0, 0, -8), _FAR),
    Case("critical-below", _diagonal(7, 7, 0.5), (2, 0, 0), _T, (0, 1, 0, 0), (0, 0, -8), _FAR),
    Case("steady", _diagonal(15, 15, 0.5), (0.0, 1.0, 0.0), _T, (1, 2, 0, 0), (0, 0, -15), _FAR),
]
