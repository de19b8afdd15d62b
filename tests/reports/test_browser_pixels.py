"""What three.js is given and what it paints: geometry against the solids, pixels against rays."""

import numpy as np
import pytest
from synthetic_record import build

from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.templating import asset
from omegadot.reports.page.view_3d.solids import Solid, solid_of
from omegadot.scenarios.parts import SHAPES
from omegadot.scenarios.solids import volume

SIDES, SIZE, REACH, EYE = 48, 240, 1.3, 6.0
EPS32 = float(np.finfo(np.float32).eps)
STILL = np.array([1.0, 0.0, 0.0, 0.0])
PLACED = {"position": (0.1, -0.2, 0.3), "orientation": (0.8, 0.2, 0.4, 0.4), "density": 2.0}
SIZES = {
    "box": {"size": (0.1, 0.2, 0.3)},
    "cylinder": {"radius": 0.1, "length": 0.5},
    "sphere": {"radius": 0.2},
    "ellipsoid": {"semi_axes": (0.1, 0.2, 0.3)},
    "capsule": {"radius": 0.1, "length": 0.3},
}
COLOURS = ["#ff0000", "#00ff00", "#0000ff"]
SCRIPTS = ("unpack", "view_trajectory", "view_shapes", "view_scene", "view_canvas")
# Solids that cross: no order of whole faces paints them right.
CROSSED = [
    Solid("box", np.array([1.6, 0.3, 0.3]), np.zeros(3), normalize(np.array([0.9, 0.1, 0.3, 0.2]))),
    Solid("box", np.array([0.3, 1.4, 0.4]), np.array([0.1, 0.0, 0.1]), STILL),
    Solid("ellipsoid", np.array([0.3, 0.4, 0.6]), np.array([0.2, -0.1, 0.0]), STILL),
]
# One before the other, as seen from x and y: an order of triangles is enough.
APART = [
    Solid("box", np.full(3, 0.5), np.array([-0.5, -0.5, 0.0]), STILL),
    Solid("ellipsoid", np.full(3, 0.3), np.array([0.0, 0.05, 0.1]), STILL),
    Solid("box", np.array([0.2, 0.2, 0.6]), np.array([0.6, 0.5, 0.0]), STILL),
]


@pytest.fixture(scope="module")
def page(browser, tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(draw_page(build(("sphere",), steps=(0.01,))), encoding="utf-8")
    browser.open(file, height=900)
    browser.wait("document.getElementById('view-box')?.dataset.ready === '1'")
    return browser


def plain(solid):
    numbers = (solid.size, solid.position, solid.orientation)
    return [solid.shape, *(list(map(float, row)) for row in numbers)]


def run(page, body):
    code = "\n".join(asset(f"{name}.js") for name in SCRIPTS)
    return page.evaluate(f"(() => {{ {code}\nstartWebgl();\n{body} }})()")


def triangles(page, solid):
    """(n, 3, 3) corners, (n, 3, 3) normals, (n,) marks."""
    found = run(
        page,
        f"const g = geometryOf([{plain(solid)}]);"
        " return [[...g.position.array], [...g.normal.array], g.marked, g.reach];",
    )
    corners, normals, marked, reach = found
    table = np.array(corners).reshape(-1, 3, 3) * reach
    return table, np.array(normals).reshape(-1, 3, 3), np.array(marked)


@pytest.mark.parametrize("shape", SIZES)
def test_geometry_is_the_part_where_it_stands(page, shape):
    part = SHAPES[shape](shape=shape, **SIZES[shape], **PLACED)
    solid = solid_of(part, np.zeros(3), 0.1)
    corners, normals, marked = triangles(page, solid)
    a, b, c = np.swapaxes(corners - solid.position, 0, 1)
    facing = np.cross(b - a, c - a)
    # Faces look outwards, by their corners and by their normals.
    real = np.linalg.norm(facing, axis=-1) > 0
    assert np.all(np.sum(facing * (a + b + c), axis=-1)[real] > 0)
    assert np.all(np.sum(facing[:, None] * normals, axis=-1)[real] > 0)
    # It lies inside the part and holds the part shrunk by two half steps of its angles.
    shrunk = np.cos(np.pi / SIDES) ** 2 if shape != "box" else 1.0
    size = np.sum(facing * a) / 6
    assert shrunk**3 - 64 * EPS32 <= size / volume(part) <= 1 + 64 * EPS32
    for direction in np.random.default_rng(5).normal(size=(40, 3)):
        direction /= np.linalg.norm(direction)
        own = solid.height(direction) - solid.position @ direction
        reached = np.max((corners.reshape(-1, 3) - solid.position) @ direction)
        assert shrunk * own - 64 * EPS32 <= reached <= own + 64 * EPS32
    assert 0.1 < marked.mean() < 0.9


def test_a_box_looks_another_after_any_half_turn(page):
    corners, _, marked = triangles(
        page, Solid("box", np.array([0.1, 0.2, 0.3]), np.zeros(3), STILL)
    )
    # The middle of a face's two triangles lies on its axis.
    middles = corners.mean(axis=1)
    axes = np.argmax(np.abs(middles) / [0.05, 0.1, 0.15], axis=1)
    sides = {
        (int(axis), bool(middle[axis] > 0)): bool(mark)
        for axis, middle, mark in zip(axes, middles, marked, strict=True)
    }
    assert len(sides) == 6
    assert all(sides[axis, True] != sides[axis, False] for axis in range(3))


def eye_and_axes(azimuth, tilt):
    a, t = np.deg2rad([azimuth, tilt])
    to = np.array([np.cos(t) * np.cos(a), np.cos(t) * np.sin(a), np.sin(t)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return EYE * to, right, np.cross(to, right)


def met(solid, eye, rays):
    """How far along each ray (n, 3) the solid is met; inf where it is not."""
    start = rotate_inverse(solid.orientation, eye - solid.position)
    along = rotate_inverse(np.broadcast_to(solid.orientation, (len(rays), 4)), rays)
    with np.errstate(divide="ignore", invalid="ignore"):
        if solid.shape == "box":
            ends = (np.stack([-0.5 * solid.size, 0.5 * solid.size])[:, None] - start) / along
            near, far = ends.min(axis=0).max(axis=-1), ends.max(axis=0).min(axis=-1)
            return np.where(near <= far, near, np.inf)
        p, d = start / solid.size, along / solid.size
        half, square = np.sum(p * d, axis=-1), np.sum(d * d, axis=-1)
        root = half**2 - square * (p @ p - 1)
        return np.where(root >= 0, (-half - np.sqrt(np.maximum(root, 0))) / square, np.inf)


def seen(solids, eye, right, up, pixels):
    """Which solid each pixel (n, 2) shows, -1 for none."""
    scale = SIZE / (2 * REACH)
    x, y = (pixels[:, [0]] - SIZE / 2) / scale, (SIZE / 2 - pixels[:, [1]]) / scale
    distances = np.array([met(solid, eye, x * right + y * up - eye) for solid in solids])
    return np.where(np.isfinite(distances).any(axis=0), distances.argmin(axis=0), -1)


def painted(page, solids, azimuth, tilt, pixels, webgl):
    bodies = [[colour, plain(solid)] for colour, solid in zip(COLOURS, solids, strict=True)]
    found = run(
        page,
        f"""{"" if webgl else "webgl = null;"} const {{ scene, sun }} = litScene();
        for (const [colour, solid] of {bodies}) {{
          const own = geometryOf([solid]), even = colouredGeometry(own, colour, colour);
          const mesh = new THREE.Mesh(even, new THREE.MeshBasicMaterial({{ vertexColors: true }}));
          mesh.scale.setScalar(own.reach);
          scene.add(mesh);
        }}
        const canvas = document.createElement("canvas");
        canvas.width = canvas.height = {SIZE};
        const context = canvas.getContext("2d", {{ willReadFrequently: true }});
        const cell = {{ x: 0, y: 0, width: {SIZE}, height: {SIZE} }};
        const camera = cameraOf({azimuth}, {tilt}, cell);
        paintScenes(context, {SIZE}, {SIZE}, [{{ cell, camera, scene: {{ scene, sun }} }}]);
        const data = context.getImageData(0, 0, {SIZE}, {SIZE}).data;
        const at = ([x, y]) => [...data.subarray(4 * ({SIZE} * y + x), 4 * ({SIZE} * y + x) + 4)];
        return {pixels.tolist()}.map(at);""",
    )
    table = np.array(found)
    return np.where(table[:, 3] > 127, table[:, :3].argmax(axis=-1), -1)


@pytest.mark.parametrize(
    ("solids", "webgl"), [(CROSSED, True), (APART, True), (APART, False)],
    ids=["webgl, crossed", "webgl, apart", "by triangles, apart"],
)  # fmt: skip
@pytest.mark.parametrize(("azimuth", "tilt"), [(35, 22), (50, -15)])
def test_each_pixel_shows_the_nearest_solid(page, solids, webgl, azimuth, tilt):
    view = eye_and_axes(azimuth, tilt)
    pixels = np.random.default_rng(6).integers(2, SIZE - 2, (3000, 2))
    truth = seen(solids, *view, pixels + 0.5)
    # An edge may lie a pixel off: a round solid has 48 sides, and edges are softened.
    clear = np.all(
        [
            seen(solids, *view, pixels + 0.5 + np.array(step)) == truth
            for step in ((-2, 0), (2, 0), (0, -2), (0, 2))
        ],
        axis=0,
    )
    assert {int(k) for k in truth[clear]} == {-1, 0, 1, 2}
    shown = painted(page, solids, azimuth, tilt, pixels, webgl)
    assert np.array_equal(shown[clear], truth[clear])


def test_bodies_and_arrows_stand_where_attitude_and_vector_put_them(page):
    """The arrow stands out of the body, on both sides of whose middle the body is seen."""
    random = np.random.default_rng(8)
    q = normalize(random.normal(size=4))
    end = rotate(q, np.array([0.0, 0.0, 0.9]))
    found = run(
        page,
        f"""const geometry = geometryOf([["box", [2, 1, 0.2], [0, 0, 0], [1, 0, 0, 0]]]);
        const theme = {{ mark: "#00ff00", stand: "#ffffff" }};
        const own = sceneOf({{ geometry, pivot: false }}, "#00ff00", theme, "#0000ff");
        const cell = {{ x: 0, y: 0, width: {SIZE}, height: {SIZE} }};
        const camera = cameraOf(35, 22, cell);
        const canvas = document.createElement("canvas");
        canvas.width = canvas.height = {SIZE};
        const context = canvas.getContext("2d", {{ willReadFrequently: true }});
        own.set({{ q: {q.tolist()}, points: [], vectors: [[{end.tolist()}, "H"]] }});
        paintScenes(context, {SIZE}, {SIZE}, [{{ cell, camera, scene: own }}]);
        const at = (p) => {{
          const [x, y] = camera.place(p);
          return [...context.getImageData(Math.floor(x), Math.floor(y), 1, 1).data];
        }};
        const corner = rotate({q.tolist()}, [0.8, 0.35, 0]);
        return [at({(0.9 * end).tolist()}), at(corner), at(times(corner, -1)), at([0, 0, 1.1])];""",
    )
    head, one, other, ground = found
    assert (np.argmax(head[:3]), np.argmax(one[:3]), np.argmax(other[:3])) == (2, 1, 1)
    assert ground[3] == 0
