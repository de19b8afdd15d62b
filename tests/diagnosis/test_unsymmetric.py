"""A tensor of inertia with one triangle, or with one wrong number: in a part of the equation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from test_causes import causes_over
from test_hypotheses import numbers
from wrong_equations import CASES, PIVOT, case

from omegadot.diagnosis.equations.equation_form import form_of
from omegadot.diagnosis.equations.hypotheses import FIXED, wrong_form
from omegadot.diagnosis.equations.hypotheses.unsymmetric import CHANGES, unsymmetric_hypotheses
from omegadot.gates.case import Case
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.system import Acceleration, Array, State, System

PIVOTED = CASES[7::3]
FEW = (CASES[0], CASES[4], *PIVOTED)
PLACES = ("in the dynamics", "where omega-dot is solved for", "in the gyroscopic term")
Change = Callable[[Array], Array]


def one_sign(tensor: Array) -> Array:
    return tensor * np.array([[1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]])


TENSORS: dict[str, Change] = {
    "the lower triangle of the inertia is zero": np.triu,
    "the number xy of the inertia alone has the wrong sign": one_sign,
}


def wrong_by(place: str, tensor: Callable[[System], Array]) -> Callable[..., Acceleration]:
    """An engine with another tensor in the solve, in the gyroscopic term or in both."""

    def found(system: System, states: State) -> Acceleration:
        right, wrong, w = moving_inertia(system), tensor(system), states.angular_velocity
        solve = right if place == "in the gyroscopic term" else wrong
        spin = right if place == "where omega-dot is solved for" else wrong
        parts = (applied_torque, damping_torque, gravity_torque)
        torque = sum(part(system, states) for part in parts) - cross(w, w @ np.asarray(spin).T)
        angular = np.linalg.solve(solve, torque.T).T
        if system.load.pivot is None:
            return Acceleration(angular, 0.0 * w + system.load.gravity)
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))

    return found


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", TENSORS)
def test_a_triangle_or_a_number_of_the_body_s_inertia_is_named(name: str, place: str) -> None:
    """On a pivot the parallel-axis theorem adds the right numbers to it."""

    def tensor(system: System) -> Array:
        own = np.asarray(system.body.inertia)
        return np.asarray(moving_inertia(system) - own + TENSORS[name](own))

    causes = causes_over(wrong_by(place, tensor), FEW)
    assert causes == {one.name: f"{place}, {name}" for one in FEW}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", TENSORS)
def test_a_triangle_or_a_number_of_the_inertia_about_a_pivot_is_named(
    name: str, place: str
) -> None:
    causes = causes_over(wrong_by(place, lambda s: TENSORS[name](moving_inertia(s))), PIVOTED)
    assert causes == {one.name: f"{place}, of what stays, {name}" for one in PIVOTED}


@pytest.mark.parametrize("one", [CASES[0], case("top", {"pivot": PIVOT})], ids=["free", "top"])
def test_each_unsymmetric_tensor_acts_and_is_no_other(one: Case) -> None:
    """Caught: a change of a number that is none, and two places that are one."""
    system = one.system
    known = [*FIXED, *unsymmetric_hypotheses(system)]
    assert len(known) - len(FIXED) == len(CHANGES) * 3 * (2 if system.load.pivot is not None else 1)
    assert len({one.text for one in known[len(FIXED) :]}) == len(known) - len(FIXED)
    right = numbers(form_of(system), 0)
    rows = [numbers(wrong_form([x], system), len(right)) for x in known]
    near = 1e-12 * np.maximum(np.abs(right), 1e-3)
    for k, row in enumerate(rows[len(FIXED) :], len(FIXED)):
        assert np.any(np.abs(row - right) > near), known[k].text
        others = [x.text for x, r in zip(known[:k], rows, strict=False) if _same(r, row, near)]
        assert not others, (known[k].text, others)


def _same(one: Array, other: Array, near: Array) -> bool:
    return bool(np.all(np.abs(one - other) <= near))


def test_an_inertia_without_products_has_no_such_cause() -> None:
    plain = case("plain", {}, tensor=[[1.0, 0.0, 0.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.1]])
    assert not list(unsymmetric_hypotheses(plain.system))
