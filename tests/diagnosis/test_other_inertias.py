"""Another inertia, in the gyroscopic term, in the solve or in both: what it has to do with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, TENSOR, case

from omegadot.diagnosis.models.principal_axes import right_handed
from omegadot.gates.case import Case
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import center_of_mass_acceleration, forward_dynamics
from omegadot.reference_impl.rotations import exp_quaternion, rotation_matrix
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

Change = Callable[[Array], Array]
SPIN, SOLVE = ("spin",), ("solve",)


def using(change: Change, parts: tuple[str, ...]) -> Any:
    """The equation with another inertia, of what moves, in these parts of it."""

    def found(system: System, states: State) -> Acceleration:
        w, inertia = states.angular_velocity, np.asarray(moving_inertia(system))
        spin, solve = (change(inertia) if p in parts else inertia for p in ("spin", "solve"))
        due = torque(system, states) - cross(w, apply(spin, w))
        angular = np.linalg.solve(solve, due[..., None])[..., 0]
        if system.load.pivot is None:
            return Acceleration(angular, forward_dynamics(system, states).linear)
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))

    return found


def merged(limit: float, way: Callable[[float, float], float]) -> Change:
    """Numbers on the diagonal that differ by less are one."""

    def change(tensor: Array) -> Array:
        made = tensor.copy()
        for i, j in ((0, 1), (1, 2), (2, 0)):
            a, b = made[i, i], made[j, j]
            if abs(a - b) < limit * max(a, b):
                made[i, i] = made[j, j] = way(a, b)
        return made

    return change


def principal(limit: float) -> Change:
    def change(tensor: Array) -> Array:
        moments, axes = np.linalg.eigh(tensor)
        for i in (0, 1):
            if moments[i + 1] - moments[i] < limit * moments[i + 1]:
                moments[[i, i + 1]] = np.mean(moments[[i, i + 1]])
        return np.asarray((axes * moments) @ axes.T)

    return change


def sphere(tensor: Array) -> Array:
    moments = np.linalg.eigvalsh(tensor)
    near = moments[2] - moments[0] < 0.01 * moments[2]
    return np.asarray(np.mean(moments) * np.eye(3)) if near else tensor


def top_or_sphere(tensor: Array) -> Array:
    """All three where the outermost are near, two where these are."""
    moments, axes = np.linalg.eigh(tensor)
    for alike in ([0, 1, 2], [0, 1], [1, 2]):
        if moments[alike[-1]] - moments[alike[0]] < 0.01 * moments[alike[-1]]:
            moments[alike] = np.mean(moments[alike])
            break
    return np.asarray((axes * moments) @ axes.T)


def without_small(tensor: Array) -> Array:
    kept = (np.abs(tensor) > 0.12 * np.max(np.diag(tensor))) | np.eye(3, dtype=bool)
    return np.where(kept, tensor, 0.0)


def near(apart: float, products: float) -> list[list[float]]:
    tensor = np.diag([1.3, 1.3 * (1.0 + apart), 2.1]) + products * (np.ones((3, 3)) - np.eye(3))
    return np.asarray(tensor).tolist()


BODIES = tuple(
    case(f"near-{k}", load, 1.0 + k, near(apart, products))
    for k, (apart, products, load) in enumerate(
        (
            (1e-4, 0.003, {"torque": BODY_TORQUE}),
            (-7e-4, 0.2, {"damping": 0.2}),
            (2e-3, 0.001, {"torque": BODY_TORQUE, "damping": 0.1}),
            (3e-2, 0.3, {"gravity": GRAVITY, "torque": BODY_TORQUE}),
            (2e-1, 0.01, {"damping": 1.2}),
        )
    )
)
TURN = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0


def turned(*moments: list[float]) -> tuple[Any, ...]:
    tensors = [(TURN @ np.diag(m) @ TURN.T).tolist() for m in moments]
    return tuple(case(f"t-{k}", {"torque": BODY_TORQUE}, 1.0, t) for k, t in enumerate(tensors))


TURNED = turned([1.0, 1.0002, 1.7], [1.0, 1.4, 1.7], [1.1, 1.7, 1.7008], [1, 1.01, 1.5])
NEAR_SPHERES = turned(
    [1.0, 1.001, 1.003], [1.2, 1.2024, 1.2048], [1.0, 1.03, 1.04], [1.0, 1.006, 1.6]
)
BETWEEN = "a limit between 0.069 and 0.2 %"


@pytest.mark.parametrize(
    ("change", "parts", "cases", "text"),
    [
        (
            merged(1e-3, lambda a, b: 0.5 * (a + b)),
            SPIN,
            BODIES,
            "in the gyroscopic term, numbers on the inertia's diagonal that differ by less than "
            f"{BETWEEN} are taken as equal: each is their mean",
        ),
        (
            merged(1e-3, lambda a, b: a),
            SOLVE,
            BODIES,
            "where omega-dot is solved for, numbers on the inertia's diagonal that differ by less "
            f"than {BETWEEN} are taken as equal: both are the first of the two",
        ),
        (
            principal(1e-3),
            (*SPIN, *SOLVE),
            TURNED,
            "in the dynamics, principal moments that differ by less than a limit between 0.047 and "
            "1 % are taken as equal: each is their mean",
        ),
        (
            sphere,
            (*SPIN, *SOLVE),
            NEAR_SPHERES,
            "in the dynamics, principal moments that differ by less than a limit between 0.39 and "
            "3.9 % are taken as equal: all three are a third of the trace",
        ),
        (
            top_or_sphere,
            (*SPIN, *SOLVE),
            NEAR_SPHERES,
            "in the dynamics, principal moments that differ by less than a limit between 0.96 and "
            "3 % are taken as equal: two are their mean, and all three where the outermost are",
        ),
        (
            without_small,
            SPIN,
            BODIES,
            "in the gyroscopic term, products of inertia that are below a limit, between 9.5 "
            "and 15 % of the largest number on its diagonal here, are dropped",
        ),
    ],
)
def test_numbers_that_are_nearly_equal_or_nothing_are_named_with_their_limit(
    change: Change, parts: tuple[str, ...], cases: Any, text: str
) -> None:
    """Caught: six numbers to compare by eye, and a condition that is chance."""
    causes = causes_over(using(change, parts), cases)
    assert causes
    assert all(one.startswith(text) for one in causes.values()), causes


def without_all(of: Callable[[Array], float]) -> Change:
    def change(tensor: Array) -> Array:
        small = np.max(np.abs(tensor - np.diag(np.diag(tensor)))) < 0.01 * of(tensor)
        return np.diag(np.diag(tensor)) if small else tensor

    return change


@pytest.mark.parametrize("of", [lambda t: float(np.max(np.diag(t))), lambda t: float(np.trace(t))])
def test_a_limit_of_products_is_no_narrower_than_the_bodies_show(
    of: Callable[[Array], float],
) -> None:
    """Caught: 1e-3 of the trace, which fits every body as well as any limit in between."""
    (text,) = set(causes_over(using(without_all(of), (*SPIN, *SOLVE)), BODIES[:4]).values())
    limit = "a limit, between 0.14 and 9.6 % of the largest number on its diagonal here"
    assert text == f"in the dynamics, products of inertia that are below {limit}, are dropped", text


def test_of_two_rules_that_fit_the_limit_is_that_of_either() -> None:
    """Caught: a limit below the true one, of each product by itself where all must be small."""
    uneven = np.array(near(0.1, 0.0)) + np.array([[0, 0.002, 0.1], [0.002, 0, 0], [0.1, 0, 0]])
    cases = (*BODIES[:4], case("uneven", {"torque": BODY_TORQUE}, 1.0, uneven.tolist()))
    change = without_all(lambda t: float(np.max(np.diag(t))))
    (text,) = set(causes_over(using(change, (*SPIN, *SOLVE)), cases[:1] + cases[4:]).values())
    low, high = (float(one) for one in text.split(" between ")[1].split()[:3:2])
    assert low < 1.0 < high, text


def replaced(tensor: Array) -> Array:
    made = tensor.copy()
    made[2, 2] = made[0, 0]
    return made


SIZES = tuple(
    case(f"size-{k}", {"torque": BODY_TORQUE}, 1.0, (s * np.array(TENSOR)).tolist())
    for k, s in enumerate((0.013, 0.37, 5.9))
)


@pytest.mark.parametrize("parts", [SPIN, SOLVE, (*SPIN, *SOLVE)])
@pytest.mark.parametrize(
    ("change", "phrases"),
    [
        (replaced, ("the moment of inertia zz is that of xx",)),
        (
            lambda t: t * (1.0 - 2.0 * np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]])),
            ("the products of inertia xy and yz have the wrong sign",),
        ),
        (
            lambda t: t + np.diag([0.5 * (t[1, 1] - t[0, 0]), 0.5 * (t[0, 0] - t[1, 1]), 0.0]),
            ("the moments of inertia xx and yy are both their mean",),
        ),
        (
            lambda t: np.array([float(f"{x:.2e}") for x in t.ravel()]).reshape(3, 3),
            ("the inertia is rounded to 3 digits",),
        ),
        (
            lambda t: t + np.diag(np.maximum(np.diag(t), 0.6) - np.diag(t)),
            ("the diagonal of the inertia is held above 0.6 kg m^2",),
        ),
    ],
    ids=("replaced", "two signs", "mean", "digits", "floor"),
)
def test_another_tensor_is_said_in_relation_to_the_requested_one(
    change: Change, phrases: tuple[str, ...], parts: tuple[str, ...]
) -> None:
    """Caught: tensors without a word of what makes them."""
    tensors = SIZES if "held above" not in phrases[0] else SIZES[1:2] * 1
    where = {SPIN: "in the gyroscopic term, ", SOLVE: "where omega-dot is solved for, "}
    causes = causes_over(using(change, parts), tensors)
    assert causes
    for text in causes.values():
        assert all(where.get(parts, "in the dynamics, ") + p in text for p in phrases), text


@pytest.mark.parametrize("parts", [SPIN, SOLVE])
def test_of_fitted_numbers_it_is_said_which_are_right(parts: tuple[str, ...]) -> None:
    """Caught: nothing but six numbers where the diagonal of each body is off, as at random."""
    draw = np.random.default_rng(3)
    made: dict[bytes, Array] = {}

    def change(tensor: Array) -> Array:
        more = made.setdefault(tensor.tobytes(), draw.uniform(0.05, 0.2, 3) * np.diag(tensor))
        return np.asarray(tensor + np.diag(more))

    causes = causes_over(using(change, parts), SIZES)
    assert len(causes) == 3
    assert all("its products are the requested ones" in text for text in causes.values()), causes


def test_one_body_shows_no_limit() -> None:
    alone = (case("alone", {"torque": BODY_TORQUE}, 1.0, near(1e-4, 0.2)),)
    change = merged(1e-3, max)
    (text,) = causes_over(using(change, SPIN), alone).values()
    assert "limit" not in text


def put_together(signs: Callable[[Array], Array]) -> Change:
    """V^T D V in place of V D V^T, of the axes by size with these signs."""

    def change(tensor: Array) -> Array:
        moments, axes = np.linalg.eigh(tensor)
        turn = signs(axes)
        return np.asarray(turn.T @ (moments[:, None] * turn))

    return change


def nearest(tensor: Array) -> Array:
    """The same, of the axes that are turned the least from those of the body."""
    moments, axes = np.linalg.eigh(tensor)
    order = np.argmax(np.abs(axes), axis=1)
    turn = axes[:, order] * np.sign(np.diag(axes[:, order]))
    return np.asarray(turn.T @ (moments[order][:, None] * turn))


def tilted(k: int, about: list[float]) -> Case:
    turn = rotation_matrix(exp_quaternion(np.array(about)))
    tensor = (turn @ np.diag([1.0 + 0.3 * k, 1.9, 2.3]) @ turn.T).tolist()
    return case(f"tilted-{k}", {"torque": BODY_TORQUE}, 1.0, tensor)


TILTED = tuple(
    tilted(k, about)
    for k, about in enumerate(([0.3, -0.2, 0.4], [-0.4, 0.3, 0.1], [0.2, 0.5, -0.3]))
)


@pytest.mark.parametrize("change", [nearest, put_together(right_handed)])
def test_principal_axes_are_put_together_the_wrong_way_round(change: Change) -> None:
    """Caught: one order and one sign of axes for all bodies, where an engine chooses for each."""
    found = causes_over(using(change, (*SPIN, *SOLVE)), TILTED)
    transposed = "in the dynamics, the rotation of the inertia's principal axes looks transposed"
    assert {text.rstrip() for text in found.values()} == {transposed}


def single_off_diagonal(tensor: Array) -> Array:
    kept = np.diag(np.diag(tensor))
    return np.asarray(kept + (tensor - kept).astype(np.float32))


def test_products_alone_in_single_precision_are_named() -> None:
    """Caught: moments about other axes, by six numbers."""
    causes = causes_over(of_body(single_off_diagonal), (*SIZES, TOP))
    assert len(causes) == 4
    text = "the products of inertia alone are kept in single precision"
    assert set(causes.values()) == {text}


def of_body(change: Change) -> Any:
    """The right equation of a body with another inertia."""

    def found(system: System, states: State) -> Acceleration:
        body = replace(system.body, inertia=change(np.asarray(system.body.inertia)))
        return forward_dynamics(replace(system, bodies=(body,)), states)

    return found


TOP = case("top", {"gravity": GRAVITY, "pivot": PIVOT}, 1.3)
TOPS = (TOP, case("top-driven", {"torque": BODY_TORQUE, "pivot": [0.1, -0.5, 0.3]}, 0.7))


def interchanged(tensor: Array) -> Array:
    """xz and yz."""
    made = tensor.copy()
    made[0, 2] = made[2, 0] = tensor[1, 2]
    made[1, 2] = made[2, 1] = tensor[0, 2]
    return made


OTHER_ORDER = "are in another order: xy, xz, yz hold xy, yz, xz"


@pytest.mark.parametrize("parts", [SPIN, SOLVE, (*SPIN, *SOLVE)])
def test_products_of_the_whole_inertia_are_told_from_the_bodys_own(parts: tuple[str, ...]) -> None:
    """Caught: no cause on pivoted bodies, whose lever has products as well."""
    where = {SPIN: "in the gyroscopic term", SOLVE: "where omega-dot is solved for"}
    start = where.get(parts, "in the dynamics")
    every = (*SIZES, *TOPS)
    causes = causes_over(using(interchanged, parts), every)
    assert len(causes) == len(every)
    assert set(causes.values()) == {f"{start}, the products of the whole inertia {OTHER_ORDER}"}
    free = causes_over(using(interchanged, parts), SIZES)
    assert set(free.values()) == {f"{start}, the products of inertia {OTHER_ORDER}"}


def test_own_products_are_no_products_of_the_whole_inertia() -> None:
    causes = causes_over(of_body(interchanged), (*SIZES, *TOPS))
    assert set(causes.values()) == {f"in the dynamics, the products of inertia {OTHER_ORDER}"}


def test_bodies_that_would_all_be_spheres_are_no_rule() -> None:
    """A rate of damping without a gyroscopic term, where the least moment happens to be one."""
    tensors = {"damped": (1.0, 1.2, 2.1), "free": (1.1, 1.3, 1.9)}
    loads: dict[str, Any] = {"damped": {"damping": 0.2}, "free": {}}
    cases = [case(n, loads[n], 1.0, np.diag(m).tolist()) for n, m in tensors.items()]

    def wrong(system: System, states: State) -> Acceleration:
        rate = -float(system.load.damping) * states.angular_velocity
        return Acceleration(rate, forward_dynamics(system, states).linear)

    found = causes_over(wrong, tuple(cases))
    assert "taken as equal" not in "".join(found.values())
    assert "omega-dot has -d omega, whatever the inertia" in found["damped"]


def test_products_that_all_have_the_wrong_sign_are_named() -> None:
    """Caught: "-2 P is added to the inertia", with P the inertia without its diagonal."""
    texts = set(causes_over(using(lambda t: 2.0 * np.diag(np.diag(t)) - t, SPIN), SIZES).values())
    assert texts == {"in the gyroscopic term, all products of inertia have the wrong sign"}
