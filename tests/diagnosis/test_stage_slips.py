"""Terms, rates and operands that are wrong in single stages of a step; and silence."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from test_over_runs import kept
from wrong_equations import CASES

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.explicit_schemes import TABLEAUS, scheme_named
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.coordinates import from_coordinates
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, torque_of
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

KUTTA = (((), (0.5,), (0.0, 0.5), (0.0, 0.0, 1.0)), (1 / 6, 1 / 3, 1 / 3, 1 / 6))
HEUN = TABLEAUS["Heun's method"][1:]
MIDPOINT = TABLEAUS["the explicit midpoint method"][1:]
THREE_EIGHTHS = TABLEAUS["Kutta's 3/8 method"][1:]
Tableau = tuple[Sequence[Sequence[float]], Sequence[float]]
Slope = tuple[Array, Array]


@dataclass
class Engine:
    """Any tableau on the quaternion. more: a change of the torque in body axes, of this engine.

    stage: from 1 on.  stages and before: q, v and slope of this step's, and of those before.
    """

    tableau: Tableau
    more: Callable[[Engine, System, Array, Array], Array] | None = None
    again: Callable[[Engine, Slope], Slope] | None = None
    stages: list[tuple[Array, Array, Slope]] = field(default_factory=list)
    before: list[tuple[Array, Array, Slope]] = field(default_factory=list)

    @property
    def stage(self) -> int:
        return len(self.stages) + 1

    def __call__(
        self, system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        rows, weights = self.tableau
        self.before, self.stages = self.stages if n else [], []
        slopes = list[Slope]()
        for row in rows:
            at_q = q + h * sum(a * k for a, (k, _) in zip(row, slopes, strict=True))
            at_v = v + h * sum(a * k for a, (_, k) in zip(row, slopes, strict=True))
            unit, push = motion.normalize(at_q), np.zeros_like(v)
            if self.more is not None:
                push[-3:] = apply(
                    inverse(moving_inertia(system)), self.more(self, system, unit, at_v)
                )
            slope = motion.coordinate_rate(at_q, at_v), motion.acceleration(unit, at_v) + push
            changed = slope if self.again is None else self.again(self, slope)
            self.stages.append((unit, at_v, slope))
            slopes.append(changed)
        q = q + h * sum(b * k for b, (k, _) in zip(weights, slopes, strict=True))
        return motion.normalize(q), v + h * sum(
            b * k for b, (_, k) in zip(weights, slopes, strict=True)
        )


def causes(engine: Engine, scheme: str, declared: bool = True) -> list[str]:
    plans = ((0.02, 1), (0.009, 2))
    runs = [kept(one, engine, h, every) for one in CASES for h, every in plans]
    known = scheme_named(scheme)
    runs = [replace(run, fails=_is_wrong(run, scheme)) for run in runs]
    own = Integrator("own", scheme if declared else None, known.orders)
    return causes_over_runs(own, runs)


def _is_wrong(run: KeptRun, scheme: str) -> bool:
    return not bool(np.all(run.sound(SchemeOf(scheme_named(scheme), "com-world"))))


def applied(factors: Sequence[float]) -> Callable[[Engine, System, Array, Array], Array]:
    """The applied torque with a factor in each stage."""

    def more(engine: Engine, system: System, q: Array, v: Array) -> Array:
        state = from_coordinates(system, q, v, "com-world")
        return (factors[engine.stage - 1] - 1.0) * applied_torque(system, state)

    return more


def damped_by_the_start(engine: Engine, system: System, q: Array, v: Array) -> Array:
    start = engine.stages[0][1] if engine.stages else v
    return np.asarray(-system.load.damping * (start - v)[-3:])


def spun_backwards(engine: Engine, system: System, q: Array, v: Array) -> Array:
    """The gyroscopic term has the wrong sign in the second stage."""
    w = v[-3:]
    return (2.0 if engine.stage == 2 else 0.0) * cross(w, apply(moving_inertia(system), w))


def solved_at_the_start(engine: Engine, system: System, q: Array, v: Array) -> Array:
    """``I (R^T R0 I^-1 R0^T R - I^-1) (tau - omega x I omega)``, R0 the step's first attitude."""
    inertia, w = moving_inertia(system), v[-3:]
    torque = torque_of(system)(from_coordinates(system, q, v, "com-world"))
    torque = torque - cross(w, apply(inertia, w))
    first, now = engine.stages[0][0][-4:] if engine.stages else q[-4:], q[-4:]
    there = rotate_inverse(first, rotate(now, torque))
    there = apply(inverse(inertia), there)
    return apply(inertia, rotate_inverse(now, rotate(first, there))) - torque


def last_again(engine: Engine, slope: Slope) -> Slope:
    """The first stage is the last one of the step before."""
    return engine.before[-1][2] if engine.stage == 1 and engine.before else slope


def omega_again(engine: Engine, slope: Slope) -> Slope:
    """The third stage moves the attitude as the second one does."""
    if engine.stage != 3:
        return slope
    old = engine.stages[1][2][0][-4:]
    return np.concatenate((slope[0][:-4], old)), slope[1]


@pytest.mark.parametrize(
    ("engine", "scheme", "text"),
    [
        (
            Engine(KUTTA, applied((1.0, 0.0, 0.0, 0.0))),
            "rk4-quaternion",
            "the applied torque acts in the first stage alone",
        ),
        (
            Engine(KUTTA, applied((1.0, 0.0, 1.0, 0.0))),
            "rk4-quaternion",
            "the applied torque does not act in the second and fourth stages",
        ),
        (
            Engine(KUTTA, again=last_again),
            "rk4-quaternion",
            "the first stage is the last one of the step before",
        ),
        (
            Engine(KUTTA, again=omega_again),
            "rk4-quaternion",
            "the attitude's rate in the third stage is that of the stage before",
        ),
        (
            Engine(KUTTA, solved_at_the_start),
            "rk4-quaternion",
            "the inverse inertia is turned into the world by the attitude of the step's start in "
            "every stage",
        ),
        (
            Engine(HEUN, damped_by_the_start),
            "Heun's method on the quaternion",
            "the damping takes the omega of the step's start in every stage",
        ),
        (
            Engine(MIDPOINT, spun_backwards),
            "the explicit midpoint method on the quaternion",
            "the gyroscopic term has the wrong sign in the second stage",
        ),
        (
            Engine(THREE_EIGHTHS, applied((1.0, 2.0, 1.0, 1.0))),
            "Kutta's 3/8 method on the quaternion",
            "the applied torque acts twice in the second stage",
        ),
    ],
)
def test_what_is_wrong_in_some_stages_is_named(engine: Engine, scheme: str, text: str) -> None:
    """Caught: the number of the tableau that vanishing steps show, or the order that is lost."""
    declared = not any(known in scheme for known in TABLEAUS)  # which no adapter may declare
    assert causes(engine, scheme, declared) == [f"in the steps of {scheme}, {text}"]


@pytest.mark.parametrize(
    "engine",
    [
        Engine(KUTTA),
        Engine(KUTTA, applied((1 / 6,) * 4)),
        Engine(KUTTA, applied((0.2, 0.0, 0.0, 0.0))),
        Engine(KUTTA, applied((1.0, 0.0, 0.0, 0.001))),
    ],
)
def test_a_factor_in_every_stage_and_one_that_is_no_slip_are_of_no_stage(engine: Engine) -> None:
    """Caught: a sound scheme accused, and a slip named that is near what is wrong."""
    assert causes(engine, "rk4-quaternion") == []
    assert causes(engine, "rk4-quaternion", declared=False) == []


def test_a_known_slip_and_another_scheme_are_not_called_a_stage() -> None:
    """A third stage from the first slope is the second one again; that has a sentence."""
    rows, weights = KUTTA
    slipped = Engine(((*rows[:2], (0.5, 0.0), rows[3]), weights))
    assert causes(slipped, "rk4-quaternion") == []
    assert causes(Engine((((), (0.0,)), (0.5, 0.5))), "Heun's method on the quaternion") == []
    assert causes(Engine(THREE_EIGHTHS), "rk4-quaternion") == []
