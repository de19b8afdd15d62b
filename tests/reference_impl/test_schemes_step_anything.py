"""One scheme steps whatever moves: vectors, one body, and motions that write over their memory."""

from __future__ import annotations

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reference_cases import DRIVEN, EPS, TOP, start

import omegadot
from omegadot.reference_impl.coordinates import to_coordinates
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.charted import TABLEAUS
from omegadot.reference_impl.stepping import step_through as step_and_time
from omegadot.reference_impl.system import Array

pytestmark = pytest.mark.no_cover  # its lines are covered by others

STIFFNESS = np.array(
    [[3.0, -1.0, 0.0, 0.5], [-1.0, 2.0, -0.7, 0.0], [0, -0.7, 2.5, 0], [0.5, 0, 0, 1]]
)
DAMPING = np.diag([0.1, 0.2, 0.3, 0.4])
PLACE, SPEED = np.array([1.0, -0.5, 0.3, 0.8]), np.array([0.2, 0.4, -1.0, 0.0])
BODIES_ALONE = {  # they turn a body's velocity, and a torque on it
    "body-axes-midpoint",
    "semi-implicit-euler-rescaled-momentum-four-substeps",
}
anything = pytest.mark.parametrize("name", sorted(set(SCHEMES) - BODIES_ALONE))


def step_through(*how: object) -> tuple[Array, Array, Array]:
    found = step_and_time(*how)  # type: ignore[arg-type]
    return found.time, found.q, found.v


def oscillator() -> Motion:
    """Four masses on springs and dampers, ``v̇ = -K q - D v``: a vector space, nothing else."""
    return Motion(lambda q, v: -(STIFFNESS @ q[..., None] + DAMPING @ v[..., None])[..., 0])


def pendulum() -> Motion:
    """``q̈ = -sin q`` of one angle."""
    return Motion(lambda q, v: -np.sin(q))


def exact_oscillation(time: float) -> Array:
    generator = np.block([[np.zeros((4, 4)), np.eye(4)], [-STIFFNESS, -DAMPING]])
    values, vectors = np.linalg.eig(generator)
    start = np.linalg.solve(vectors, np.concatenate((PLACE, SPEED)))
    return np.real(vectors @ (np.exp(values * time) * start))


@anything
def test_a_vector_space_is_stepped_at_the_schemes_order(name: str) -> None:
    """The naive mean is of order 4 here, where there are no rotations to commute."""
    scheme = SCHEMES[name]
    order = 4 if "rk4" in name else scheme.orders["omega"]
    exact, found = exact_oscillation(1.0), []
    for steps in (40, 80, 160):
        _, q, v = step_through(scheme, oscillator(), PLACE, SPEED, 1 / steps, steps, steps)
        found.append(np.max(np.abs(np.concatenate((q[-1], v[-1])) - exact)))
    slope = np.log2(found[1] / found[2])
    assert abs(slope - order) <= 0.15, found


@pytest.mark.parametrize("method", ["semi-implicit-euler", *TABLEAUS])
def test_a_method_is_one_on_a_vector_space_whatever_attitudes_are_stepped_in(method: str) -> None:
    names = [n for n in sorted(set(SCHEMES) - BODIES_ALONE) if is_by(n, method)]
    ends = [
        step_through(SCHEMES[name], oscillator(), PLACE, SPEED, 0.05, 20, 20)[1:] for name in names
    ]
    for q, v in ends[1:]:
        assert np.max(np.abs(q - ends[0][0])) <= 20 * 16 * EPS
        assert np.max(np.abs(v - ends[0][1])) <= 20 * 16 * EPS


def is_by(name: str, method: str) -> bool:
    """Whether a scheme steps this method, by its name; damping is explicit, steps are whole."""
    own = {"lie-rk4", "lie-rk4-naive"} if method == "rk4" else set[str]()
    other = ("rescaled-momentum", "semi-implicit-euler-in-two")
    stem = name.removeprefix("munthe-kaas-")
    begins = stem == method or stem.startswith(f"{method}-")
    return (begins or name in own) and not any(part in name for part in other)


def test_every_method_is_shown_on_several_charts() -> None:
    """Else the test above would compare nothing."""
    shown = {method: [n for n in SCHEMES if is_by(n, method)] for method in TABLEAUS}
    assert len(shown["rk4"]) == 6
    assert sum(len(names) > 1 for names in shown.values()) >= 6


def test_linearly_implicit_euler_is_stable_where_damping_is_stiff() -> None:
    """``v₁ = v₀ / (1 + h d)`` with d of 1e6 1/s and a step of 0.1 s."""
    motion = Motion(lambda q, v: -1e6 * v)
    _, _, v = step_through(
        SCHEMES["linearly-implicit-euler"], motion, np.zeros(2), np.ones(2), 0.1, 1, 1
    )
    assert v[-1] == pytest.approx(np.full(2, 1 / (1 + 1e5)), rel=64 * 1e5 * EPS)


def test_the_midpoint_rule_keeps_a_quadratic_energy() -> None:
    motion = Motion(lambda q, v: -(STIFFNESS @ q[..., None])[..., 0])
    _, q, v = step_through(SCHEMES["implicit-midpoint"], motion, PLACE, SPEED, 0.1, 200, 10)
    energy = 0.5 * np.sum(v * v, -1) + 0.5 * np.einsum("ni,ij,nj->n", q, STIFFNESS, q)
    assert np.max(np.abs(energy / energy[0] - 1)) <= 200 * 16 * EPS


@anything
def test_lanes_of_a_pendulum_are_single_pendulums(name: str) -> None:
    angles, steps = np.array([[0.3], [1.5], [3.0]]), np.array([0.01, 0.02, 0.05])
    still = np.zeros((3, 1))
    _, q, v = step_through(SCHEMES[name], pendulum(), angles, still, steps, 20, 20)
    for lane, dt in enumerate(steps):
        how = (angles[lane], still[lane], float(dt), 20, 20)
        _, alone, speed = step_through(SCHEMES[name], pendulum(), *how)
        assert np.max(np.abs(q[-1, lane] - alone[-1])) <= 20 * 16 * EPS * 3
        assert np.max(np.abs(v[-1, lane] - speed[-1])) <= 20 * 16 * EPS * 3


@pytest.mark.parametrize("name", sorted(SCHEMES))
@pytest.mark.parametrize("on", [DRIVEN, TOP], ids=["free", "pivoted"])
def test_accelerations_may_be_written_over_by_the_next(name: str, on: object) -> None:
    """As an engine's are: a scheme that keeps one without using it up goes astray."""
    motion = body_motion(on)  # type: ignore[arg-type]
    q, v = to_coordinates(on, start([1.0, 2.0, -1.5], [1, 2, 3, 4]), "com-world")  # type: ignore[arg-type]
    memory, slopes = np.empty_like(v), np.empty((len(v), 3))

    def acceleration(q: Array, v: Array) -> Array:
        memory[...] = motion.acceleration(q, v)
        return memory

    def jacobian(q: Array, v: Array, size: Array | None) -> tuple[Array, Array]:
        assert motion.jacobian is not None
        memory[...], slopes[...] = motion.jacobian(q, v, size)
        return memory, slopes

    reused = replace(motion, acceleration=acceleration, jacobian=jacobian)
    kept = step_through(SCHEMES[name], motion, q, v, 0.02, 10, 5)[1:]
    found = step_through(SCHEMES[name], reused, q, v, 0.02, 10, 5)[1:]
    for one, other in zip(kept, found, strict=True):
        assert np.array_equal(one, other)


WRONG_ON_PURPOSE = (
    *("slips", "on_quaternion", "memory", "solved", "acting", "explicit_schemes"),
    *("staged_steps", "iterates", "turn_limits", "mixed_turns", "commutators", "jacobians"),
    "implicit_gyroscopic",
    "tolerances",
)


STEPPING = {"Scheme", "kutta", "step_coupled", "step_in_exponential", "by_tableau", "semi_implicit"}


def test_only_schemes_step() -> None:
    """What moves a configuration is called in `schemes` alone: there is no second copy of any.

    But for files of causes, which step what is wrong on purpose, and for `explicit_schemes`, which
    runs of no declared scheme are held against.
    """
    package = Path(omegadot.__file__).parent
    moving = {"retract", "rate", "rate_to_second_order", "cayley", "coordinate_rate", "turned_by"}
    found = []
    for path in package.rglob("*.py"):
        where = path.relative_to(package).as_posix()
        own = tuple(f"{n}.py" for n in WRONG_ON_PURPOSE)
        if where.startswith("reference_impl/schemes/") or (
            where.startswith("diagnosis/stepping/") and path.name in own
        ):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            called = node.func if isinstance(node, ast.Call) else None
            name = getattr(called, "attr", getattr(called, "id", ""))
            moves = isinstance(called, ast.Attribute) and name in moving
            if moves or name in STEPPING:
                found.append(f"{where}:{getattr(node, 'lineno', 0)} {name}")
    assert found == []
