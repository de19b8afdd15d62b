"""A term that is wrong for some inertias alone: equal moments, the hand of axes, their order."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from wrong_equations import GRAVITY, PIVOT, case, gyroscopic, with_torque

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import FORWARD, of_forward_dynamics
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.wording.features import features_of
from omegadot.diagnosis.wording.inertia_features import inertia_features
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System

TURN = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0


def bodies() -> list[Case]:
    """Free and pivoted, with equal moments in each place, turned and not."""
    draw, found = np.random.default_rng(5), list[Case]()
    for k in range(36):
        a, b, c = np.sort(draw.uniform(1.0, 2.0, 3))
        moments = ((a, a, b), (a, b, b), (a, b, c), (c, a, b))[k % 4]
        turn = np.linalg.qr(draw.normal(size=(3, 3)))[0] if k % 4 > 1 and k % 3 else np.eye(3)
        turn = (
            TURN if k % 4 == 0 and k % 3 == 2 else turn
        )  # two equal principal moments, and no two else
        tensor = turn @ np.diag(moments) @ turn.T
        tensor = 0.5 * (tensor + tensor.T)
        load = {"gravity": GRAVITY, "pivot": PIVOT} if k % 5 == 3 else {}
        found.append(case(f"body-{k}", load, 1.0 + 0.1 * (k % 7), tensor.tolist()))
    return found


BODIES = bodies()


def causes(wrong: Callable[[System], bool], factor: float = 1.0) -> set[str]:
    across, failing = Across(), list[str]()
    for one in BODIES:
        states = random_states(one, 40, [1])
        off = factor * float(wrong(one.system)) * gyroscopic(one.system, states)
        found = with_torque(one.system, states, off)
        evidence = of_forward_dynamics(one.system, states, found)
        features = features_of(one.system, one.initial)
        across.add(Scene(one.name, one.system, features, {FORWARD: evidence}))
        failing += [one.name] if evidence.clear else []
    assert 3 < len(failing) < 33
    return {across.cause(name, FORWARD) for name in failing}


def moves(system: System) -> Array:
    return np.asarray(moving_inertia(system), dtype=float)


def left_handed(system: System) -> bool:
    return bool(np.linalg.det(np.linalg.eigh(moves(system))[1]) < 0.0)


WHERE: dict[str, tuple[Callable[[System], bool], str]] = {
    "equal": (
        lambda s: bool(abs(moves(s)[0, 0] - moves(s)[1, 1]) < 1e-9),
        "Ixx and Iyy about what stays are equal",
    ),
    "left": (
        left_handed,
        "the axes that numpy.linalg.eigh gives of the inertia about what stays are left-handed",
    ),
    "order": (
        lambda s: bool(np.argmax(np.diag(moves(s))) == 0),
        "Ixx is the largest on the diagonal",  # which about either it is on the same bodies
    ),
}


@pytest.mark.parametrize("name", WHERE)
def test_a_condition_on_the_inertia_is_named(name: str) -> None:
    """Caught: "on 5 of the 42 scenarios that would show it"."""
    where, text = WHERE[name]
    assert causes(where) == {f"the gyroscopic term is missing, but only where {text}"}


def test_bodies_chosen_otherwise_have_no_such_condition() -> None:
    """Every third of them, whatever its inertia is."""
    every = {id(one.system): k for k, one in enumerate(BODIES)}
    (text,) = causes(lambda system: every[id(system)] % 3 == 0)
    assert text.startswith("the gyroscopic term is missing, not on ")


def test_equal_moments_off_the_diagonal_have_no_hand() -> None:
    """Rounding chooses their axes."""
    for one in BODIES:
        known = inertia_features(one.system)
        hand = known["the axes that numpy.linalg.eigh gives of the inertia{} are left-handed"][0]
        two, diagonal = (
            known[text][0]
            for text in ("two principal moments{} are equal", "the inertia{} is diagonal")
        )
        assert (hand is None) == (two and not diagonal)
