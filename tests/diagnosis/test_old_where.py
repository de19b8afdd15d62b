"""An old number that steps take on the scenarios of one kind alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import Step, euler, kept
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, WORLD_TORQUE, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

NAME = "semi-implicit-euler"
IN_WORLD = {"torque": WORLD_TORQUE}
CASES = (
    case("driven", {"torque": BODY_TORQUE}, 1.3),
    case("driven-in-world", IN_WORLD),
    case("driven-and-damped", IN_WORLD | {"damping": 0.2}, 1.7),
    case("driven-light", IN_WORLD | {"gravity": GRAVITY}, 0.4),
    case("top-driven", IN_WORLD | {"pivot": PIVOT, "gravity": GRAVITY}, 0.9),
    case("top-driven-heavy", IN_WORLD | {"pivot": [0.1, -0.5, 0.3]}, 3.4),
    case("top-driven-damped", IN_WORLD | {"pivot": PIVOT, "damping": 0.3}, 2.1),
    case("top", {"gravity": GRAVITY, "pivot": PIVOT}),
)
PLANS = ((0.02, 1), (0.009, 2))
START, BEFORE = "the run's start", "the step before"


def of_attitude(where: str, acts: Callable[[System], bool]) -> Step:
    """A torque in world axes that is turned into the body by an old attitude."""
    places: list[Array] = []

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        places[:] = [*(places if n else []), q[-4:]]
        old = places[0] if where == START else places[max(n - 1, 0)]
        world, back = system.load.torque_world, inverse(moving_inertia(system))
        more = rotate_inverse(old, world) - rotate_inverse(q[-4:], world)
        return euler(motion, q, v, h, float(acts(system)) * apply(back, more))

    return step


def causes(where: str, acts: Callable[[System], bool]) -> list[str]:
    runs = [kept(one, of_attitude(where, acts), h, every) for one in CASES for h, every in PLANS]
    by = SchemeOf(SCHEMES[NAME], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", NAME, dict.fromkeys(CHANNELS, 1)), runs)


def pivoted(system: System) -> bool:
    return system.load.pivot is not None


@pytest.mark.parametrize("where", [START, BEFORE])
@pytest.mark.parametrize(
    ("acts", "condition"),
    [(pivoted, "the body is pivoted"), (lambda s: not pivoted(s), "the body is free")],
)
def test_an_old_attitude_of_one_kind_of_scenarios_is_named_with_it(
    where: str, acts: Callable[[System], bool], condition: str
) -> None:
    """Caught: nothing, where the sound runs of the others would show it as well."""
    text = f"in each step the torque in world axes is taken at the attitude of {where}"
    assert causes(where, acts) == [f"{text}, but only where {condition}"]


def test_where_it_acts_on_all_there_is_no_condition() -> None:
    text = f"in each step the torque in world axes is taken at the attitude of {START}"
    assert causes(START, lambda system: True) == [text]


def test_scenarios_that_no_condition_sorts_show_none() -> None:
    """Caught: a cause that others contradict."""
    chosen = {id(one.system) for one in CASES if one.name in {"driven-light", "top-driven-heavy"}}
    assert causes(START, lambda system: id(system) in chosen) == []
