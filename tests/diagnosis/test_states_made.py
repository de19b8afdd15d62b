"""States that read back as another product of the same vectors, or about the same axes.

What these tests catch: a formula that is fitted to one of its states, that is named where the
attitude itself is off, or that stands for all attitudes where some come back right.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_misread_state import FREE, Made, causes
from wrong_equations import CASES

from omegadot.gates.case import Case
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import conjugate, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, State

PIVOTED = [case for case in CASES if case.system.load.pivot is not None]


def pivoted(field: str, values: Callable[[State, Array], Array]) -> Made:
    """One quantity of a pivoted body of its state and its lever; a free body is right."""

    def made(case: Case, s: State) -> State:
        if case.system.load.pivot is None:
            return s
        return replace(s, **{field: values(s, lever(case.system))})

    return made


def free(field: str, more: Callable[[State, Array], Array]) -> Made:
    """One quantity of a free body has more in it, of its state and its centre of mass."""

    def made(case: Case, s: State) -> State:
        if case.system.load.pivot is not None:
            return s
        added = more(s, np.asarray(case.system.body.center_of_mass))
        return replace(s, **{field: getattr(s, field) + added})

    return made


PLACES: dict[str, tuple[Made, str]] = {
    "omega-in-body-axes": (
        pivoted(
            "linear_velocity", lambda s, r: cross(s.angular_velocity, rotate(s.orientation, r))
        ),
        "the linear velocity of a pivoted body reads back as omega x (R r), where",
    ),
    "omega-turned-back": (
        pivoted(
            "linear_velocity",
            lambda s, r: cross(rotate_inverse(s.orientation, s.angular_velocity), r),
        ),
        "reads back as (R^T omega) x r, where",
    ),
    "wrong-sign": (
        pivoted(
            "linear_velocity", lambda s, r: rotate(s.orientation, cross(r, s.angular_velocity))
        ),
        "reads back as -(R omega) x (R r), where",
    ),
    "turned-back": (
        pivoted("position", lambda s, r: rotate_inverse(s.orientation, r)),
        "the position of a pivoted body reads back as R^T r, where R r is due",
    ),
    "free-not-turned": (
        free("linear_velocity", lambda s, c: cross(s.angular_velocity, c)),
        "the linear velocity of a free body reads back as v + omega x c, where v was set",
    ),
    "free-position": (
        free("position", lambda s, c: np.broadcast_to(-c, s.position.shape)),
        "the position of a free body reads back as x - c, where x was set",
    ),
}


@pytest.mark.parametrize("name", PLACES)
def test_the_formula_of_a_place_is_named(name: str) -> None:
    made, text = PLACES[name]
    found = [one for one in causes(made, CASES) if one]
    assert found
    assert all(len(one) == 1 and text in one[0] for one in found)


def test_two_quantities_have_a_formula_each() -> None:
    position, velocity = PLACES["turned-back"][0], PLACES["omega-turned-back"][0]
    found = causes(lambda case, s: velocity(case, position(case, s)), PIVOTED)
    for (text,) in found:
        assert "the position of a pivoted body reads back as R^T r" in text
        assert "and the linear velocity of a pivoted body reads back as (R^T omega) x r" in text


def test_a_place_by_the_transposed_rotation_has_one_sentence() -> None:
    def transposed(case: Case, s: State) -> State:
        turned = place_on_pivot(case.system, replace(s, orientation=conjugate(s.orientation)))
        return replace(turned, orientation=s.orientation)

    found = [one for one in causes(transposed, CASES) if one]
    assert found
    assert all(one[0].startswith("the rotation looks transposed in the place") for one in found)


def test_a_formula_that_one_scenario_contradicts_is_not_named() -> None:
    made, _ = PLACES["omega-turned-back"]

    def but_one(case: Case, s: State) -> State:
        other = made(case, s)
        spoilt = case.name == PIVOTED[0].name
        return replace(other, linear_velocity=1.01 * other.linear_velocity) if spoilt else other

    assert causes(but_one, PIVOTED) == [[]] * len(PIVOTED)


def rotated(q: Array, vectors: Callable[[Array], Array]) -> Array:
    """An attitude by another rotation vector of half its length, (3,)."""
    half = np.arctan2(np.linalg.norm(q[1:]), q[0])
    made = Rotation.from_rotvec(vectors(2.0 * half * q[1:] / np.linalg.norm(q[1:])))
    return np.roll(made.as_quat(), 1)


def of_attitude(change: Callable[[Array], Array]) -> Made:
    return lambda _, s: replace(s, orientation=rotated(s.orientation, change))


ATTITUDES: dict[str, tuple[Made, str]] = {
    "rotation-vector-as-mrp": (
        of_attitude(lambda v: 4.0 * np.arctan(np.linalg.norm(v)) * v / np.linalg.norm(v)),
        "attitudes are taken as the rotation vector and put together as modified Rodrigues",
    ),
    "rodrigues-as-rotation-vector": (
        of_attitude(lambda v: np.tan(np.linalg.norm(v) / 2.0) * v / np.linalg.norm(v)),
        "are taken as Rodrigues parameters and put together as the rotation vector",
    ),
    "half-the-turn": (
        of_attitude(lambda v: v / 2.0),
        "attitudes come back as half the turn about their own axes",
    ),
    "half-a-turn": (
        of_attitude(lambda v: np.pi * v / np.linalg.norm(v)),
        "attitudes come back as half turns about their own axes",
    ),
}


@pytest.mark.parametrize("name", ATTITUDES)
def test_the_chart_of_an_attitude_is_named(name: str) -> None:
    made, text = ATTITUDES[name]
    for found in causes(made, FREE):
        assert len(found) == 1
        assert text in found[0]
        assert "but only where" not in found[0]


def test_the_branch_of_a_chart_is_a_condition() -> None:
    """Right where the scalar part is not negative, half a turn elsewhere."""
    half, _ = ATTITUDES["half-a-turn"]
    found = causes(lambda c, s: half(c, s) if s.orientation[0] < 0.0 else s, FREE)
    wrong = [one for one in found if one]
    assert 1 < len(wrong) < len(found)
    for (text,) in wrong:
        assert "half turns about their own axes" in text
        assert "only where the scalar part of the quaternion that is set is negative" in text


def test_an_attitude_that_is_noise_has_no_chart() -> None:
    draw = np.random.default_rng(3)

    def noise(_: Case, s: State) -> State:
        q = s.orientation + 0.01 * draw.normal(size=4)
        return replace(s, orientation=q / np.linalg.norm(q))

    assert causes(noise, FREE) == [[]] * len(FREE)
