"""What stands for a body in the 3-D view: its parts, or a solid of the same inertia."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.reference_impl.from_scenario import body_of_part, system_of
from omegadot.reference_impl.inertia import assemble, moving_inertia
from omegadot.reference_impl.rotations import normalize, rotate, rotation_matrix
from omegadot.reference_impl.system import Body, Load, System
from omegadot.reports.page.view_3d.bodies import look_of
from omegadot.reports.page.view_3d.solids import Solid
from omegadot.scenarios import load_builtin
from omegadot.scenarios.parts import SHAPES

EPS = np.finfo(float).eps
NAMES = {
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "ellipsoid": ("semi_axes",),
}


def body_of(solids, density):
    """The solids as a body of parts, by equation (5)."""
    parts = []
    for solid in solids:
        names = NAMES[solid.shape]
        sizes = [solid.size] if len(names) == 1 else solid.size
        placed = {"position": tuple(solid.position), "orientation": tuple(solid.orientation)}
        values = {
            n: tuple(v) if np.ndim(v) else float(v) for n, v in zip(names, sizes, strict=True)
        }
        parts.append(SHAPES[solid.shape](shape=solid.shape, density=density, **values, **placed))
    return assemble([body_of_part(part) for part in parts])


@settings(derandomize=True, max_examples=30, deadline=None)
@given(
    st.tuples(*[st.floats(0.1, 3.0)] * 3).filter(lambda s: min(np.diff(sorted(s))) > 1e-3),
    st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
)
def test_a_body_known_by_its_inertia_is_drawn_as_a_box_of_that_inertia(sizes, q):
    axes, mass = rotation_matrix(normalize(np.array(q))), 2.5
    squares = np.array(sizes) ** 2
    second = mass * (axes * squares) @ axes.T
    inertia = np.trace(second) * np.eye(3) - second
    system = System((Body(np.array(mass), np.array([0.3, 0.2, 0.1]), inertia),), Load())
    look = look_of(system, {"body": {"mass": 1.0}}, np.array([1.0, 0.0, 0.0]))
    assert "box" in look.description
    found = body_of(look.solids, 1.0)
    # The smallest square comes of a difference of moments: rounding over its share of them.
    slack = 256 * EPS * (max(squares) / min(squares)) ** 2
    assert np.abs(found.inertia * mass / found.mass - inertia).max() <= slack * inertia.max()
    assert not found.center_of_mass.any()


@pytest.mark.parametrize(
    ("moments_given", "name"),
    [((2, 2, 2), "ball"), ((2, 2, 1), "cylinder"), ((1, 1, 1.8), "cylinder"), ((1, 2, 2.5), "box")],
)
def test_alike_moments_are_drawn_round(moments_given, name):
    inertia = np.diag(np.array(moments_given, float))
    system = System((Body(np.array(1.0), np.zeros(3), inertia),), Load())
    look = look_of(system, {}, np.array([0.0, 0.0, 1.0]))
    assert look.description == f"drawn as the homogeneous {name} of its mass and inertia"
    found = body_of(look.solids, 1.0)
    assert np.abs(found.inertia / found.mass - inertia).max() <= 256 * EPS * 2.5


def test_the_t_handle_looks_like_one():
    scenario = load_builtin("t-handle")
    system = system_of(scenario)
    look = look_of(system, scenario.to_dict(), np.array([0.05, 0.05, 9.0]))
    assert look.description == "drawn from its parts"
    crossbar, stem = (
        [solid.height(axis) + solid.height(-axis) for axis in np.eye(3)] for solid in look.solids
    )
    assert np.argmax(crossbar) == 0
    assert np.argmax(stem) == 2
    found = body_of(look.solids, 7800.0)
    assert np.abs(found.center_of_mass).max() <= 64 * EPS * 0.1
    assert found.mass == pytest.approx(float(system.body.mass), rel=64 * EPS)
    slack = 64 * EPS * system.body.inertia.max()
    assert np.abs(found.inertia - system.body.inertia).max() <= slack
    # The first spin is about z: the tip is the stem's end, 0.06 m up less the centre of mass.
    assert look.tip == pytest.approx([0.0, 0.0, 0.06 - system.body.center_of_mass[2]], abs=1e-12)


def test_a_pivoted_body_is_drawn_from_its_pivot():
    system = system_of(load_builtin("heavy-top"))
    solid, rod = look_of(system, {}, np.array([0.2, 0.4, 8.0])).solids
    up = np.array([0.0, 0.0, 1.0])
    assert -solid.height(-up) == pytest.approx(rod.height(up))
    assert rod.height(-up) == pytest.approx(0.0, abs=64 * EPS)
    assert solid.position == pytest.approx([0.0, 0.0, 0.3])


@pytest.mark.parametrize("towards", [(0.3, -0.4, 0.5), (0.0, 0.0, -1.0), (1e-9, 0.0, -1.0)])
def test_the_rod_leads_from_the_pivot_to_the_body(towards):
    centre = np.array(towards)
    body = Body(np.array(1.0), centre, np.diag([2.0, 2.0, 1.0]))
    *_, rod = look_of(
        System((body,), Load(pivot=np.zeros(3))), {}, np.array([0.0, 0.0, 1.0])
    ).solids
    axis = rotate(rod.orientation, np.array([0.0, 0.0, 1.0]))
    assert axis == pytest.approx(centre / np.linalg.norm(centre), abs=64 * EPS)
    assert rod.position == pytest.approx(0.5 * rod.size[1] * axis, abs=64 * EPS)


@pytest.mark.parametrize("shape", NAMES)
def test_a_solid_reaches_as_far_as_its_farthest_point(shape):
    """Against many points of its surface, the farthest of which is at most a step away."""
    turn, polar = np.linspace(0.0, 2 * np.pi, 721), np.linspace(0.0, np.pi, 361)[:, None]
    z = np.cos(polar) + 0 * turn
    ball = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), z], axis=-1)
    ball = ball.reshape(-1, 3)
    rim = np.stack([np.cos(turn), np.sin(turn), 2 + 0 * turn], axis=-1)
    points, size = {
        "box": (np.sign(ball) * [0.05, 0.1, 0.15], [0.1, 0.2, 0.3]),
        "ellipsoid": (ball * [0.1, 0.2, 0.3], [0.1, 0.2, 0.3]),
        "capsule": (0.1 * ball + np.sign(ball) * [0, 0, 0.2], [0.1, 0.4]),
        "cylinder": (0.1 * np.concatenate([rim, rim * [1, 1, -1]]), [0.1, 0.4]),
    }[shape]
    q, place = normalize(np.array([0.8, 0.2, 0.4, 0.4])), np.array([0.1, -0.2, 0.3])
    solid = Solid(shape, np.array(size), place, q)
    for direction in np.random.default_rng(3).normal(size=(20, 3)):
        direction /= np.linalg.norm(direction)
        farthest = np.max(place @ direction + rotate(q, points) @ direction)
        assert farthest - 64 * EPS <= solid.height(direction) <= farthest + 0.3 * np.deg2rad(0.5)


def test_the_inertia_ellipsoid_has_semi_axes_of_one_over_root_i():
    system = system_of(load_builtin("full-tensor"))
    look = look_of(system, {}, np.array([1.0, 2.0, 3.0]))
    shape = look.ellipsoid.T @ moving_inertia(system) @ look.ellipsoid
    assert shape == pytest.approx(2.0 * np.eye(3), abs=64 * EPS * 4.0)


def test_lengths_travel_over_the_bodys_size():
    """An atom and a planet alike: WebGL computes in single precision."""
    system = system_of(load_builtin("t-handle"))
    for size in (1e-30, 1.0, 1e30):
        inertia = system.body.inertia * size**2
        scaled = System(
            (Body(system.body.mass, size * system.body.center_of_mass, inertia),), Load()
        )
        drawn = look_of(scaled, {}, np.array([0.0, 0.0, 1.0])).payload()["body"]
        assert max(abs(x) for _, *numbers in drawn for row in numbers for x in row) == 1.0
