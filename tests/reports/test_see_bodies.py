"""What a body is drawn as: closed convex solids of the right size, place and painting order."""

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.reference_impl.from_scenario import body_of_part, system_of
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.system import Body, Load, System
from omegadot.reports.page.view_3d.bodies import look_of
from omegadot.reports.page.view_3d.depth_order import depth_order
from omegadot.reports.page.view_3d.meshes import (
    Mesh,
    box,
    capsule,
    cylinder,
    ellipsoid,
    mesh_of,
)
from omegadot.scenarios import load_builtin
from omegadot.scenarios.parts import SHAPES
from omegadot.scenarios.solids import volume

EPS = np.finfo(float).eps
SIDES = 24
PLACED = {"position": (0.1, -0.2, 0.3), "orientation": (0.8, 0.2, 0.4, 0.4), "density": 2.0}
SIZES = {
    "box": {"size": (0.1, 0.2, 0.3)},
    "cylinder": {"radius": 0.1, "length": 0.5},
    "sphere": {"radius": 0.2},
    "ellipsoid": {"semi_axes": (0.1, 0.2, 0.3)},
    "capsule": {"radius": 0.1, "length": 0.3},
}
PARTS = [SHAPES[shape](shape=shape, **size, **PLACED) for shape, size in SIZES.items()]


def moments(mesh):
    """Volume, centre and the integral of r r^T about the centre, by tetrahedra from a corner."""
    origin, total, first, second = mesh.vertices[0], 0.0, np.zeros(3), np.zeros((3, 3))
    for face in mesh.faces:
        a, *others = mesh.vertices[list(face)] - origin
        for b, c in pairwise(others):
            size, corners = a @ np.cross(b, c) / 6, np.array([a, b, c])
            whole = corners.sum(axis=0)
            total += size
            first += size * whole / 4
            second += size * (np.outer(whole, whole) + corners.T @ corners) / 20
    centre = first / total
    return total, origin + centre, second - total * np.outer(centre, centre)


def inertia_of(solids, density):
    """Of solids apart from each other, about their common centre of mass."""
    found = [moments(mesh) for mesh in solids]
    volume = sum(v for v, _, _ in found)
    centre = sum(v * c for v, c, _ in found) / volume
    second = sum(s + v * np.outer(c - centre, c - centre) for v, c, s in found)
    return density * (np.trace(second) * np.eye(3) - second), centre, density * volume


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.shape)
def test_solids_are_closed_and_convex_with_faces_outwards(part):
    mesh = mesh_of(part, SIDES, 0.1)
    edges = Counter((f[k], f[(k + 1) % len(f)]) for f in mesh.faces for k in range(len(f)))
    assert set(edges.values()) == {1}
    assert all((b, a) in edges for a, b in edges)
    assert len(mesh.marked) == len(mesh.faces)
    assert 0 < sum(mesh.marked) < len(mesh.faces)
    reach = np.abs(mesh.vertices).max()
    for face in mesh.faces:
        a, b, c = mesh.vertices[list(face[:3])]
        normal = np.cross(b - a, c - a)
        assert np.max((mesh.vertices - a) @ normal) <= 64 * EPS * reach**3


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.shape)
def test_solids_stand_where_their_parts_stand(part):
    # All corners lie on the part, and a face comes no nearer to the middle than by the two
    # half steps of its angles: so the mesh holds the part shrunk by cos^2 of a half step.
    shrunk = np.cos(np.pi / SIDES) ** 2 if part.shape != "box" else 1.0
    size, centre, second = moments(mesh_of(part, SIDES, 0.1))
    assert shrunk**3 <= size / volume(part) * (1 + 64 * EPS)
    assert size / volume(part) <= 1 + 64 * EPS
    assert centre == pytest.approx(np.array(part.position), abs=64 * EPS)
    body = body_of_part(part)
    truth = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    assert np.abs(second * 2.0 - truth).max() <= (1 - shrunk**5 + 64 * EPS) * np.abs(truth).max()


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
    (solid,) = look.solids
    assert "box" in look.reported
    found, centre, _ = inertia_of(look.solids, mass / moments(solid)[0])
    # The smallest square comes of a difference of moments: rounding over its share of them.
    slack = 256 * EPS * (max(squares) / min(squares)) ** 2
    assert np.abs(found - inertia).max() <= slack * np.abs(inertia).max()
    assert np.abs(centre).max() <= slack * np.abs(solid.vertices).max()


@pytest.mark.parametrize(
    ("moments_given", "name"),
    [((2, 2, 2), "ball"), ((2, 2, 1), "cylinder"), ((1, 1, 1.8), "cylinder"), ((1, 2, 2.5), "box")],
)
def test_alike_moments_are_drawn_round(moments_given, name):
    inertia = np.diag(np.array(moments_given, float))
    system = System((Body(np.array(1.0), np.zeros(3), inertia),), Load())
    look = look_of(system, {}, np.array([0.0, 0.0, 1.0]))
    assert look.reported == f"drawn as the homogeneous {name} of its mass and inertia"
    (solid,) = look.solids
    found, _, _ = inertia_of([solid], 1.0 / moments(solid)[0])
    # A prism or a ball of 24 sides is this much lighter at its rim than the round solid.
    assert np.abs(found - inertia).max() <= (1 - np.cos(np.pi / 24) ** 4 + 64 * EPS) * 2.5


def test_the_t_handle_looks_like_one():
    scenario = load_builtin("t-handle")
    system = system_of(scenario)
    look = look_of(system, scenario.to_dict(), np.array([0.05, 0.05, 9.0]))
    assert look.reported == "drawn from its parts"
    crossbar, stem = (np.ptp(mesh.vertices, axis=0) for mesh in look.solids)
    assert np.argmax(crossbar) == 0
    assert np.argmax(stem) == 2
    found, centre, mass = inertia_of(look.solids, 7800.0)
    assert np.abs(centre).max() <= 1e-12
    assert mass == pytest.approx(float(system.body.mass), rel=0.02)
    assert found == pytest.approx(system.body.inertia, abs=0.02 * np.abs(found).max())
    # The first spin is about z: the tip is the stem's end, 0.06 m up less the centre of mass.
    assert look.tip == pytest.approx([0.0, 0.0, 0.06 - system.body.center_of_mass[2]], abs=1e-12)


def test_a_pivoted_body_is_drawn_from_its_pivot():
    system = system_of(load_builtin("heavy-top"))
    solid, rod = look_of(system, {}, np.array([0.2, 0.4, 8.0])).solids
    assert solid.vertices[:, 2].min() == pytest.approx(rod.vertices[:, 2].max())
    assert rod.vertices[:, 2].min() == pytest.approx(0.0)
    assert moments(solid)[1] == pytest.approx([0.0, 0.0, 0.3])


def test_the_inertia_ellipsoid_has_semi_axes_of_one_over_root_i():
    system = system_of(load_builtin("full-tensor"))
    look = look_of(system, {}, np.array([1.0, 2.0, 3.0]))
    shape = look.ball.T @ moving_inertia(system) @ look.ball
    assert shape == pytest.approx(2.0 * np.eye(3), abs=64 * EPS * 4.0)


# Painting. A ray's first solid must be the one painted last along it.
STILL = np.array([1.0, 0.0, 0.0, 0.0])
APART = [
    cylinder(0.2, 2.0, 12).placed(np.zeros(3), np.array([np.sqrt(0.5), 0, np.sqrt(0.5), 0])),
    cylinder(0.2, 1.0, 12).placed(np.array([0.0, 0.0, 0.7]), STILL),
    ellipsoid(np.array([0.3, 0.2, 0.2]), 12).placed(np.array([0.7, 0.0, 0.6]), STILL),
    box(np.full(3, 0.3)).placed(np.array([-0.7, 0.1, -0.5]), STILL),
]
CROSSED = [
    box(np.array([2.0, 0.2, 0.2])),
    box(np.array([0.2, 2.0, 0.3])),
    capsule(0.3, 0.5, 12),
]


def hit(corners, normal, eye, ray):
    """How far along the ray the polygon is met, or None."""
    slope = normal @ ray
    if slope >= 0:
        return None
    along = normal @ (corners[0] - eye) / slope
    turned = np.cross(np.roll(corners, -1, axis=0) - corners, eye + along * ray - corners)
    return along if np.all(turned @ normal > 0) else None


def painted(cell, eye):
    """The pieces in the order in which the page's script paints them."""
    if cell is None:
        return []
    if cell.plane is None:
        assert not cell.mixed or len({piece.solid for piece in cell.pieces}) > 1
        return list(cell.pieces)
    normal, offset = cell.plane
    halves = [painted(cell.behind, eye), painted(cell.before, eye)]
    first, last = halves if normal @ eye > offset else halves[::-1]
    return [*first, *cell.pieces, *last]


def rays(count):
    random = np.random.default_rng(7)
    for _ in range(count):
        eye = random.normal(size=3)
        eye *= 6.0 / np.linalg.norm(eye)
        yield eye, random.uniform(-1.0, 1.0, 3) - eye


def nearest(pieces, eye, ray):
    met = [hit(p.corners, p.normal, eye, ray) for p in pieces]
    return [(p, along) for p, along in zip(pieces, met, strict=True) if along is not None]


def test_what_is_nearest_is_painted_last():
    tree = depth_order(APART)
    alone = [piece for mesh in APART for piece in depth_order([mesh]).pieces]
    seen = 0
    for eye, ray in rays(60):
        if truth := nearest(alone, eye, ray):
            seen += 1
            last = nearest(painted(tree, eye), eye, ray)[-1]
            assert last[1] == pytest.approx(min(along for _, along in truth), rel=1e-9)
    assert seen > 12


def pieces_of(cell):
    return [] if cell is None else [*cell.pieces, *pieces_of(cell.behind), *pieces_of(cell.before)]


def test_no_visible_piece_is_left_out_where_solids_run_through_each_other():
    alone = [piece for mesh in CROSSED for piece in depth_order([mesh]).pieces]
    kept = pieces_of(depth_order(CROSSED))
    assert len(kept) > len(alone)
    for eye, ray in rays(60):
        truth, found = (nearest(pieces, eye, ray) for pieces in (alone, kept))
        assert bool(truth) == bool(found)
        if truth:
            first = min(along for _, along in truth)
            assert min(along for _, along in found) == pytest.approx(first, rel=1e-9)


def test_hidden_pieces_are_left_out():
    inner, outer = box(np.full(3, 0.2)), box(np.full(3, 1.0))
    assert {piece.solid for piece in pieces_of(depth_order([inner, outer]))} == {1}


def test_faces_of_touching_solids_are_all_kept():
    tree = depth_order(APART[:2])
    assert len(pieces_of(tree)) == sum(len(mesh.faces) for mesh in APART[:2])
    assert tree.plane is not None
    assert all(not cell.mixed for cell in (tree.behind, tree.before))


def test_many_bodies_that_cross_stay_few_pieces():
    crowd = [ellipsoid(np.full(3, 0.4), 8).placed(np.full(3, 0.05 * k), STILL) for k in range(12)]
    assert len(pieces_of(depth_order(crowd))) < 4 * sum(len(mesh.faces) for mesh in crowd)


def test_a_body_without_faces_is_refused():
    with pytest.raises(ValueError, match="without a face"):
        depth_order([Mesh(np.zeros((0, 3)), (), ())])


def test_a_box_looks_another_after_any_half_turn():
    mesh = box(np.array([0.1, 0.2, 0.3]))
    sides = [np.sign(mesh.vertices[list(face)].mean(axis=0)) for face in mesh.faces]
    marked = {tuple(side): mark for side, mark in zip(sides, mesh.marked, strict=True)}
    assert len(marked) == 6
    assert all(marked[side] != marked[tuple(-np.array(side))] for side in marked)
