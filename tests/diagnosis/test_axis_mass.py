"""Another mass in the parallel-axis theorem, and what is left out of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import BODY_TORQUE, CASES, GRAVITY, PIVOT, WORLD_TORQUE, case

from omegadot.diagnosis.equations.axis_mass import axis_mass
from omegadot.diagnosis.equations.evidence import Evidence, of_forward_dynamics
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia, parallel_axis
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

Added = Callable[[float, Array], Array]  # by mass and lever, what stands for the theorem's
BOTH, SOLVE, SPIN = ("solve", "spin"), ("solve",), ("spin",)
TOP = {"gravity": GRAVITY, "pivot": PIVOT}
LIGHT = (
    case("light", TOP, 0.412381),
    case("lighter", {"pivot": [0.1, -0.5, 0.3], "torque": WORLD_TORQUE}, 0.0312943),
    case("heavy", {"pivot": [0.7, 0.35, -0.3], "torque": BODY_TORQUE}, 5.31772),
)
EVERY = (*CASES, *LIGHT)  # others are of 0.9, 1.7 and 2 kg


def using(added: Added, parts: tuple[str, ...] = BOTH) -> Any:
    """The equation with something else added to the inertia for the pivot."""

    def found(system: System, states: State) -> Acceleration:
        w, right = states.angular_velocity, np.asarray(moving_inertia(system))
        made = right
        if system.load.pivot is not None:
            more = added(float(system.body.mass), np.asarray(lever(system)))
            made = np.asarray(system.body.inertia) + more
        solve, spin = (made if part in parts else right for part in BOTH)
        due = torque(system, states) - cross(w, apply(spin, w))
        angular = np.linalg.solve(solve, due[..., None])[..., 0]
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))

    return found


def of_mass(mass: Callable[[float], float]) -> Added:
    return lambda m, r: parallel_axis(mass(m), r)


WHERE = {BOTH: "", SOLVE: ", where omega-dot is solved for", SPIN: ", in the gyroscopic term"}


@pytest.mark.parametrize("parts", WHERE)
@pytest.mark.parametrize(
    ("mass", "how"),
    [
        (lambda m: max(m, 0.93), "held above 0.93 kg"),
        (lambda m: min(m, 1.8364), "limited to 1.8364 kg"),
    ],
)
def test_a_limit_of_the_mass_in_the_parallel_axis_theorem_is_named(
    mass: Callable[[float], float], how: str, parts: tuple[str, ...]
) -> None:
    """Caught: six numbers of each body, or one factor of each."""
    causes = causes_over(using(of_mass(mass), parts), EVERY)
    due = f"the mass in the parallel-axis theorem is {how}{WHERE[parts]}"
    assert len(causes) > 1
    assert set(causes.values()) == {due}, causes


ALONE = ", as far as one scenario shows it"


def test_a_limit_that_one_body_reaches_is_said_to_be_of_one() -> None:
    """Caught: a factor of one body that is no factor."""
    causes = causes_over(using(of_mass(lambda m: max(m, 0.5))), (*CASES, LIGHT[0]))
    assert causes == {"light": f"the mass in the parallel-axis theorem is held above 0.5 kg{ALONE}"}


def evidence(found: Any, cases: Any) -> list[Evidence]:
    states = [random_states(one, 40, [1]) for one in cases]
    return [
        of_forward_dynamics(one.system, x, found(one.system, x))
        for one, x in zip(cases, states, strict=True)
    ]


@pytest.mark.parametrize(
    "mass",
    [
        lambda m: 2.5 * m if m == 0.412381 else m,  # a simple factor of one body
        lambda m: 1.03724 if m == 0.412381 else m,  # of one body, no simple number
        lambda m: 1.0 if m in (0.412381, 1.7) else m,  # not 0.9 kg, between them
        lambda m: 0.5,  # of all bodies
        lambda m: 3.0 * m if m < 1.0 else m,
        lambda m: 0.0 if m < 1.0 else m,
    ],
)
def test_what_is_no_limit_of_the_mass_is_not_named_so(mass: Callable[[float], float]) -> None:
    assert not axis_mass(evidence(using(of_mass(mass)), EVERY))


def test_without_weight_a_limit_may_be_of_the_mass_in_the_dynamics_as_well() -> None:
    """Caught: one of two that nothing decides between."""
    found = using(of_mass(lambda m: max(m, 0.2)))
    text = axis_mass(evidence(found, (*LIGHT[1:], CASES[-2])))
    parts = "parallel-axis theorem", "dynamics"
    due = [f"the mass in the {part} is held above 0.2 kg{ALONE}" for part in parts]
    assert text == "either " + ", or ".join(due)


def test_free_bodies_that_are_wrong_have_another_cause() -> None:
    every = evidence(using(of_mass(lambda m: max(m, 0.93))), EVERY)
    free = next(one for one in every if one.system.load.pivot is None)
    free.found.angular[:] *= 1.001
    assert not axis_mass(every)


def without(*places: tuple[int, int]) -> Added:
    def added(m: float, r: Array) -> Array:
        made = parallel_axis(m, r)
        for i, j in places:
            made[i, j] = made[j, i] = 0.0
        return made

    return added


LEFT_OUT: dict[str, Added] = {
    "the moment of inertia yy": without((1, 1)),
    "the numbers xx, xy, xz of the inertia": without((0, 0), (0, 1), (0, 2)),
    "the numbers xz, yz, zz of the inertia": without((0, 2), (1, 2), (2, 2)),
}


@pytest.mark.parametrize("cases", [EVERY, LIGHT[:2]], ids=("many", "two"))
@pytest.mark.parametrize(
    ("parts", "where"),
    [
        (BOTH, "in the dynamics"),
        (SOLVE, "where omega-dot is solved for"),
        (SPIN, "in the gyroscopic term"),
    ],
)
@pytest.mark.parametrize("what", LEFT_OUT)
def test_an_axis_that_the_parallel_axis_theorem_leaves_out_is_named(
    what: str, parts: tuple[str, ...], where: str, cases: Any
) -> None:
    """Caught: of two bodies the moment that it makes, scaled."""
    causes = causes_over(using(LEFT_OUT[what], parts), cases)
    assert causes
    assert set(causes.values()) == {f"{where}, the parallel-axis theorem adds nothing to {what}"}


@pytest.mark.parametrize(
    ("factor", "text"),
    [
        (0.5, "what the parallel-axis theorem adds to the inertia for the pivot is scaled by 0.5"),
        (2.0, "in the dynamics, the inertia is moved to the pivot twice"),
    ],
)
def test_a_scaled_term_is_still_named_by_its_factor(factor: float, text: str) -> None:
    causes = causes_over(using(of_mass(lambda m: factor * m)), EVERY)
    assert len(causes) > 3
    assert set(causes.values()) == {text}
