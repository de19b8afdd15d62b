"""States that do not read back: what is made of them, on its way in or out, over scenarios.

What these tests catch: a convention that fits one state by its sign alone, and one that is named
where another scenario contradicts it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from wrong_equations import CASES

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.models.misread_state import known_state, state_causes
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Case
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import at_point, place_on_pivot
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse, rotation_matrix
from omegadot.reference_impl.stepping import stack
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State

Made = Callable[[Case, State], State]
FREE = [case for case in CASES if case.system.load.pivot is None]


def set_states(case: Case, number: int) -> State:
    draw = np.random.default_rng(number)
    q = normalize(draw.normal(size=4))
    return place_on_pivot(case.system, State(q, *(draw.normal(size=3) for _ in range(3))))


def causes(made: Made, cases: list[Case], count: int = 0) -> list[list[str]]:
    """What is named on each scenario, held against all of them.

    count: from how many states steps of no length are known.
    """
    across = across_of(made, cases, count)
    rounds = [(case, across.scenes[case.name].states) for case in cases]
    return [state_causes(across, case, *states, EPS) for case, states in rounds if states]


def across_of(made: Made, cases: list[Case], count: int = 0) -> Across:
    """Each scenario with a state that was set, and what is made of it."""
    across = Across()
    for number, case in enumerate(cases):
        requested = set_states(case, number)
        features = features_of(case.system, case.initial)
        states = (requested, made(case, requested))
        scene = Scene(case.name, case.system, features, {}, states=states)
        if count:
            many = [set_states(case, 100 + k) for k in range(count)]
            scene.limits.append((stack(many), stack([made(case, one) for one in many])))
        across.add(scene)
    return across


def turned(field: str, turn: Callable[[object, object], object]) -> Made:
    def made(_: Case, state: State) -> State:
        return replace(state, **{field: turn(state.orientation, getattr(state, field))})

    return made


def at_origin(case: Case, state: State) -> State:
    return at_point(state, case.system.body.center_of_mass)


MADE: dict[str, tuple[Made, str]] = {
    "velocity-in-body": (turned("linear_velocity", rotate), "taken as one in body axes when it is"),
    "position-in-body": (turned("position", rotate), "position is taken as one in body axes"),
    "velocity-reported-in-body": (
        turned("linear_velocity", rotate_inverse),
        "the linear velocity looks like body axes",
    ),
    "of-origin": (at_origin, "are taken as those of the body's origin when they are set"),
    "degrees": (
        lambda _, s: replace(s, angular_velocity=np.deg2rad(s.angular_velocity)),
        "degrees per second when it is set",
    ),
    "momentum": (
        lambda c, s: replace(
            s, angular_velocity=apply(inverse(moving_inertia(c.system)), s.angular_velocity)
        ),
        "omega is taken as the angular momentum when it is set",
    ),
    "single": (
        lambda _, s: replace(s, position=s.position.astype(np.float32).astype(float)),
        "the position is kept in single precision",
    ),
    "nothing": (
        lambda _, s: replace(s, linear_velocity=0.0 * s.linear_velocity),
        "the linear velocity reads back as zero",
    ),
}


@pytest.mark.parametrize("name", MADE)
def test_what_is_made_of_a_state_is_named(name: str) -> None:
    made, text = MADE[name]
    for found in causes(made, FREE):
        assert len(found) == 1
        assert text in found[0]


def test_a_sound_engine_has_no_cause() -> None:
    assert causes(lambda _, state: state, CASES[:4]) == [[]] * 4


def test_a_lost_sign_is_no_transposed_rotation() -> None:
    """Of a negative scalar part |w| is the inverse rotation, of a positive one the right one."""

    def unsigned(_: Case, state: State) -> State:
        q = state.orientation.copy()
        q[0] = abs(q[0])
        return replace(state, orientation=q)

    signs = {bool(set_states(case, k).orientation[0] < 0.0) for k, case in enumerate(FREE)}
    assert signs == {True, False}
    found = [texts for texts in causes(unsigned, FREE) if texts]
    assert {text for texts in found for text in texts} == {
        "the quaternion's scalar part is read back without its sign"
    }


def test_what_holds_of_free_bodies_alone_is_stated_of_these() -> None:
    def made(case: Case, state: State) -> State:
        free = case.system.load.pivot is None
        return turned("linear_velocity", rotate)(case, state) if free else state

    found = {text for texts in causes(made, list(CASES)) for text in texts}
    assert len(found) == 1
    assert next(iter(found)).endswith("R v reads back, but only where the body is free")


def test_a_limit_on_what_is_set_is_one_law_of_all_scenarios() -> None:
    """Caught: "omega is scaled by 0.3", by another number on each scenario."""

    def held(case: Case, state: State) -> State:
        w = state.angular_velocity
        short = w * min(1.0, 1.2 / float(np.linalg.norm(w)))
        return place_on_pivot(case.system, replace(state, angular_velocity=short))

    found = [texts for texts in causes(held, list(CASES)) if texts]
    assert len(found) > 2
    text = "the size of omega is limited to 1.2 rad/s as a state is set or read back"
    assert {one for texts in found for one in texts} == {text}


@pytest.mark.parametrize(
    ("number", "texts"),
    [(0.597571, []), (2.5, ["omega is scaled by 2.5"])],
)
def test_a_factor_of_one_state_alone_has_few_digits(number: float, texts: list[str]) -> None:
    """Caught: "omega is scaled by 0.59757", where 79 rad/s were cut to 47.1 on one scenario."""

    def scaled(case: Case, state: State) -> State:
        less = replace(state, angular_velocity=number * state.angular_velocity)
        return place_on_pivot(case.system, less)

    (found,) = causes(scaled, FREE[:1])
    assert [text for text in found if "is scaled" in text] == found[: len(texts)]
    assert all(text.startswith(due) for text, due in zip(found, texts, strict=True))
    on_all = {text for own in causes(scaled, FREE) for text in own}
    assert len(on_all) == 1
    assert next(iter(on_all)).startswith("omega is scaled by")


def test_numbers_that_are_others_on_each_scenario_name_nothing() -> None:
    """Caught: a factor of one state, stated of all."""

    def scaled(_: Case, state: State) -> State:
        return replace(state, linear_velocity=state.linear_velocity * (2.0 + state.position[0]))

    assert [texts for texts in causes(scaled, FREE) if texts] == []


def test_a_condition_of_the_state_that_is_set_is_named() -> None:
    """Caught: "transposed" of an engine that conjugates where it is to negate."""

    def conjugated(_: Case, state: State) -> State:
        q = state.orientation
        return replace(state, orientation=q * [1, -1, -1, -1] if q[0] < 0.0 else q)

    texts = {one for found in causes(conjugated, FREE) for one in found}
    (text,) = texts
    assert text.startswith("the rotation looks transposed")
    where = "but only where the scalar part of the quaternion that is set is negative"
    assert text.endswith(where)


def by_attitude(change: Callable[[Array], Array]) -> Made:
    """The attitude alone comes back otherwise; what is pivoted is where that puts it."""

    def made(case: Case, state: State) -> State:
        turned = replace(state, orientation=change(state.orientation))
        held = case.system.load.pivot is not None
        return place_on_pivot(case.system, turned) if held else turned

    return made


def angles_of(order: str, other: str, change: Callable[[Array], Array] = lambda a: a) -> Made:
    """Taken by one order and put together by another; capital letters for axes of the body."""

    def through(q: Array) -> Array:
        angles = Rotation.from_quat(np.roll(q, -1)).as_euler(order)
        return np.roll(Rotation.from_euler(other, change(angles)).as_quat(), 1)

    return by_attitude(through)


def through_matrix(q: Array) -> Array:
    """With R_xy typed 2 (x y + s z)."""
    s, x, y, z = q
    matrix = np.array(rotation_matrix(q))
    matrix[0, 1] = 2 * (x * y + s * z)
    w = np.sqrt(max(0.0, 1 + np.trace(matrix))) / 2
    sides = matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]
    return normalize(np.array([w, *(np.array(sides) / (4 * w))]))


ANGLES = "attitudes go through Euler angles of two conventions: the angles a, b, c of"
ATTITUDES: dict[str, tuple[Made, str]] = {
    "last to first": (
        angles_of("ZYX", "zyx"),
        f"{ANGLES} R_z(a) R_y(b) R_x(c) are put together as R_x(c) R_y(b) R_z(a)",
    ),
    "other axes": (
        angles_of("ZYX", "XYZ"),
        f"{ANGLES} R_z(a) R_y(b) R_x(c) are put together as R_x(a) R_y(b) R_z(c)",
    ),
    "fixed axes": (angles_of("xyz", "XYZ"), "are put together as R_x(c) R_y(b) R_z(a)"),
    "proper": (angles_of("ZXZ", "ZYX"), "R_z(a) R_x(b) R_z(c) are put together as R_z(a) R_y(b)"),
    "relabelled": (
        angles_of("ZXZ", "ZYZ"),
        "the quaternion's vector part is another: x, y, z hold -y, x, z",
    ),
    "exchanged": (
        angles_of("ZYX", "ZYX", lambda a: a[[1, 0, 2]]),
        f"{ANGLES} R_z(a) R_y(b) R_x(c) are put together as R_z(b) R_y(a) R_x(c)",
    ),
    "one negative": (
        angles_of("ZYX", "ZYX", lambda a: a * [1, -1, 1]),
        f"{ANGLES} R_z(a) R_y(b) R_x(c) are put together as R_z(a) R_y(-b) R_x(c)",
    ),
    "matrix": (
        by_attitude(through_matrix),
        "attitudes go through a matrix that has one entry wrong: R_xy is 2 (q_x q_y + q_w q_z), "
        "where 2 (q_x q_y - q_w q_z) is right",
    ),
}


@pytest.mark.parametrize("name", ATTITUDES)
def test_an_attitude_that_goes_through_other_numbers_is_named(name: str) -> None:
    made, text = ATTITUDES[name]
    found = causes(made, list(CASES))
    assert len(found) == len(CASES)
    assert all(len(one) == 1 and text in one[0] for one in found), found


def part_way(q: Array) -> Array:
    """Some of the turn from the identity: of no convention."""
    return normalize(q + np.array([0.7, 0.0, 0.0, 0.0]))


def test_an_attitude_of_no_convention_has_no_cause() -> None:
    assert causes(by_attitude(part_way), list(CASES)) == [[]] * len(CASES)


def test_what_is_seen_of_states_is_stated_where_no_cause_fits() -> None:
    """Caught: "no cause found" of states of which much is known."""
    across = across_of(by_attitude(part_way), FREE)
    text = known_state(across, FREE[0], EPS)
    assert text.startswith("none is known; the attitude that reads back is not the one set")
    assert f"at every attitude that is set, on all {len(FREE)} scenarios" in text
    assert "omega, the position and the linear velocity read back right" in text
    assert known_state(across_of(lambda _, state: state, FREE), FREE[0], EPS) == ""


def by_matrix(matrix: Callable[[Case], Array]) -> Made:
    """Omega is this matrix times the one that is set, and a pivoted body's velocity follows."""

    def made(case: Case, state: State) -> State:
        w = matrix(case) @ state.angular_velocity
        return place_on_pivot(case.system, replace(state, angular_velocity=w))

    return made


def moving(case: Case) -> Array:
    return np.asarray(moving_inertia(case.system))


@pytest.mark.parametrize(
    ("matrix", "text"),
    [
        (
            lambda c: inverse(moving(c)) @ c.system.body.inertia,
            "omega reads back as M^-1 I omega (",
        ),
        (
            lambda c: inverse(c.system.body.inertia) @ moving(c),
            "omega reads back as I^-1 M omega (",
        ),
        (
            lambda c: c.system.body.inertia @ inverse(moving(c)),
            "omega reads back as I M^-1 omega (",
        ),
        (
            lambda c: inverse(np.diag(np.diag(c.system.body.inertia))) @ c.system.body.inertia,
            "omega reads back as D^-1 I omega (",
        ),
    ],
)
def test_an_omega_turned_by_two_inertias_is_named(
    matrix: Callable[[Case], Array], text: str
) -> None:
    """Caught: no cause of an omega that is kept as a momentum by one inertia, and not by it."""
    found = [texts for texts in causes(by_matrix(matrix), list(CASES)) if texts]
    assert found
    assert all(one[0].startswith(text) for one in found)


@pytest.mark.parametrize(
    ("matrix", "text"),
    [
        (2.5 * np.eye(3), "omega is scaled by 2.5"),
        (np.eye(3)[[1, 0, 2]], "omega has other axes: x, y, z hold y, x, z of what was requested"),
        (np.diag([1.0, -1.0, 1.0]), "x, y, z hold x, -y, z of what was requested"),
    ],
)
def test_an_omega_in_other_axes_is_named_where_a_place_follows_it(matrix: Array, text: str) -> None:
    """Caught: no cause on a pivot, where the velocity that reads back is that of this omega."""
    for (found,) in causes(by_matrix(lambda _: matrix), list(CASES)):
        assert f"{text} as a state is set or read back" in found


def test_an_unknown_matrix_is_stated_and_no_turn_is_one() -> None:
    """Caught: a matrix that is fitted to states at one attitude alone."""
    shear = np.array([[1.0, 0.25, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]])
    (text, *others) = [one for (one,) in causes(by_matrix(lambda _: shear), FREE, count=8)]
    assert text.startswith("omega reads back as a matrix times the one that is set: on ")
    assert text.endswith("as (1, 0.25, 0); (0, 1, 0); (0, 0, 0.5)")
    assert set(others) == {text}

    def turned_back(case: Case, state: State) -> State:
        w = shear @ rotate(state.orientation, state.angular_velocity)
        return place_on_pivot(case.system, replace(state, angular_velocity=w))

    def squared(case: Case, state: State) -> State:
        w = state.angular_velocity * (1.0 + 0.1 * state.angular_velocity[0])
        return place_on_pivot(case.system, replace(state, angular_velocity=w))

    for wrong in (turned_back, squared):
        assert [texts for texts in causes(wrong, FREE, count=8) if texts] == []
    assert [texts for texts in causes(by_matrix(lambda _: shear), FREE, count=4) if texts] == []
