"""Moments of inertia with a limit: what it goes with is found over several bodies."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, case

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import (
    FORWARD,
    INVERSE,
    Evidence,
    of_forward_dynamics,
    of_inverse_dynamics,
)
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.limited_inertia import limited_inertia
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.states.equation import random_acceleration, random_states
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

ROUND = [0.4, 0.41, 0.6]
Change = Callable[[System], Array]  # by what the moving inertia is more
BOTH, SOLVE, SPIN = ("solve", "spin"), ("solve",), ("spin",)


def full(*moments: float) -> list[list[float]]:
    return (np.diag(moments) + 0.04 * min(moments) * (1.0 - np.eye(3))).tolist()


EVERY = (
    case("least-xx", {"torque": BODY_TORQUE}, 2.0, full(0.01, 1.2, 1.204)),
    case("least-yy", {"damping": 0.4}, 3.7, full(0.5, 0.017, 0.505)),
    case("least-two", {}, 9.1, full(0.02, 0.04, 0.05)),
    case("pivoted", {"gravity": GRAVITY, "pivot": PIVOT}, 1.3, full(0.9, 0.898, 0.004)),
    case("large", {"torque": BODY_TORQUE}, 1.0, full(1.3, 1.6, 2.1)),
)


def by_diagonal(limit: Callable[[System, Array], float], hold: object = np.maximum) -> Change:
    assert callable(hold)

    def more(system: System) -> Array:
        tensor = np.asarray(system.body.inertia, dtype=float)
        kept = np.diag(tensor)
        return np.diag(hold(kept, limit(system, tensor)) - kept)

    return more


def by_moments(limit: Callable[[System, Array], float]) -> Change:
    def more(system: System) -> Array:
        tensor = np.asarray(system.body.inertia, dtype=float)
        moments, axes = np.linalg.eigh(tensor)
        held = np.maximum(moments, limit(system, tensor))
        return np.asarray((axes * held) @ axes.T - tensor)

    return more


def of_pivot(share: float) -> Change:
    """The diagonal of the whole inertia about the pivot, by its trace."""

    def more(system: System) -> Array:
        whole = np.asarray(moving_inertia(system), dtype=float)
        return np.diag(np.maximum(np.diag(whole), share * np.trace(whole)) - np.diag(whole))

    return more


def wrong(more: Change, parts: tuple[str, ...]) -> Callable[[System, State], Acceleration]:
    def found(system: System, x: State) -> Acceleration:
        w, inertia = x.angular_velocity, np.asarray(moving_inertia(system))
        solve, spin = (inertia + (more(system) if p in parts else 0.0) for p in BOTH)
        due = torque(system, x) - cross(w, apply(spin, w))
        angular = np.linalg.solve(solve, due[..., None])[..., 0]
        if system.load.pivot is None:
            return Acceleration(angular, forward_dynamics(system, x).linear)
        return Acceleration(angular, center_of_mass_acceleration(system, x, angular))

    return found


def evidence(more: Change, parts: tuple[str, ...] = BOTH) -> list[Evidence]:
    made, found = list[Evidence](), wrong(more, parts)
    for one in EVERY:
        x = random_states(one, 30, [1])
        made.append(of_forward_dynamics(one.system, x, found(one.system, x)))
    return made


@pytest.mark.parametrize(
    ("more", "parts", "text"),
    [
        (
            by_diagonal(lambda s, t: 0.03 * float(s.body.mass)),
            BOTH,
            "in the dynamics, the diagonal of the inertia is held above 0.03 m^2 times the mass",
        ),
        (
            by_diagonal(lambda s, t: 0.06),
            SOLVE,
            "where omega-dot is solved for, the diagonal of the inertia is held above 0.06 kg m^2",
        ),
        (
            by_moments(lambda s, t: 0.05 * np.max(np.linalg.eigvalsh(t))),
            SPIN,
            "in the gyroscopic term, every principal moment of inertia is held above 0.05 times "
            "the largest principal moment",
        ),
        (
            by_diagonal(lambda s, t: 0.4 * np.trace(t), np.minimum),
            BOTH,
            "in the dynamics, the diagonal of the inertia is limited to 0.4 times the trace",
        ),
        (
            of_pivot(0.2),
            BOTH,
            "in the dynamics, the diagonal of the inertia about the pivot is held above 0.2 times "
            "the trace",
        ),
    ],
)
def test_a_limit_is_named_with_what_it_goes_with(
    more: Change, parts: tuple[str, ...], text: str
) -> None:
    """Caught: six other numbers on each body."""
    assert limited_inertia(evidence(more, parts)) == text


def test_a_sphere_without_a_torque_shows_no_number() -> None:
    """It does not turn otherwise, whatever its moment is: the others show the law."""
    more = by_diagonal(lambda s, t: 0.03 * float(s.body.mass), np.minimum)
    bodies = [EVERY[3], *(case(f"sphere-{k}", {}, 0.5 * k, ROUND) for k in (1, 2))]
    bodies.append(case("driven", {"torque": BODY_TORQUE}, 3.0, ROUND))
    made = list[Evidence]()
    for one in bodies:
        x, found = random_states(one, 30, [1]), wrong(more, BOTH)
        made.append(of_forward_dynamics(one.system, x, found(one.system, x)))
    text = "in the dynamics, the diagonal of the inertia is limited to 0.03 m^2 times the mass"
    assert text in limited_inertia(made)


def test_other_moments_without_a_law_are_no_limit() -> None:
    """Each body's least moment is raised, by as much as no size of it gives."""
    draws = {one.name: k for one, k in zip(EVERY, (1.3, 2.9, 1.1, 4.7, 1.0), strict=True)}
    names = {id(one.system): one.name for one in EVERY}

    def more(system: System) -> Array:
        kept = np.diag(np.asarray(system.body.inertia, dtype=float))
        least = np.where(kept == kept.min(), draws[names[id(system)]] * kept, kept)
        return np.diag(least - kept)

    assert not limited_inertia(evidence(more))
    assert not limited_inertia(evidence(lambda s: np.zeros((3, 3))))


def test_one_body_shows_no_law() -> None:
    assert not limited_inertia(evidence(by_diagonal(lambda s, t: 0.06))[:1])


@pytest.mark.parametrize("forward", [True, False])
def test_inverse_dynamics_with_the_same_limit_have_the_same_cause(forward: bool) -> None:
    """Of a sphere without a torque, which they alone show; else they are wrong by themselves."""
    more, across = by_diagonal(lambda s, t: 0.03 * float(s.body.mass)), Across()
    found = wrong(more, BOTH) if forward else forward_dynamics
    for one in EVERY:
        x = random_states(one, 30, [1])
        a = random_acceleration(one.system, x, [2])
        w = x.angular_velocity
        off = apply(more(one.system), a.angular) + cross(w, apply(more(one.system), w))
        answered = inverse_dynamics(one.system, x, a) + off
        known = {
            FORWARD: of_forward_dynamics(one.system, x, found(one.system, x)),
            INVERSE: of_inverse_dynamics(one.system, x, a, answered),
        }
        across.add(Scene(one.name, one.system, features_of(one.system, one.initial), known))
    where = "in the dynamics" if forward else "in inverse dynamics"
    (text,) = across.of_torque("least-two")
    assert text == f"{where}, the diagonal of the inertia is held above 0.03 m^2 times the mass"
