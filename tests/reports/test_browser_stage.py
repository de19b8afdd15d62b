"""What the 3-D view writes and draws beside the bodies: it is seen, and not cut off."""

import pytest
from synthetic_record import build

from omegadot.reports.page.page import draw_page
from omegadot.reports.page.templating import asset

SCRIPTS = ("unpack", "view_trajectory", "view_shapes", "view_scene", "view_canvas", "view_stage")


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(draw_page(build(("sphere",), steps=(0.01,))), encoding="utf-8")
    return file


def opened(browser, path, **how):
    browser.open(path, height=900, **how)
    browser.wait("document.getElementById('view-box')?.dataset.ready === '1'")
    return browser


def run(page, body):
    code = "\n".join(asset(f"{name}.js") for name in SCRIPTS)
    return page.evaluate(f"(() => {{ {code}\nstartWebgl();\n{body} }})()")


# WCAG 2.2, success criterion 1.4.11: what is needed to understand a picture has a contrast of 3.
CONTRAST = """((one, other) => {
    const part = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    const light = (name) => {
        const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
        const [r, g, b] = [1, 3, 5].map((k) => part(parseInt(hex.slice(k, k + 2), 16) / 255));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05; };
    const [a, b] = [light(one), light(other)];
    return Math.max(a, b) / Math.min(a, b); })"""


@pytest.mark.parametrize("dark", [False, True])
def test_stand_and_ring_are_seen(browser, path, dark):
    opened(browser, path, dark=dark)
    assert browser.evaluate(f"{CONTRAST}('--stand', '--panel')") >= 3.0
    used = run(
        browser,
        """const theme = { mark: "#ffffff", stand: "#123456" };
        const geometry = geometryOf([["box", [1, 1, 1], [0, 0, 0], [1, 0, 0, 0]]]);
        const own = sceneOf({ geometry, pivot: true }, "#00ff00", theme, "#0000ff"), found = [];
        own.scene.traverse(({ material }) => {
          if (material?.color) found.push(material.color.getHexString());
        });
        return found.filter((colour) => colour === "123456").length;""",
    )
    assert used == 2


def test_a_trace_is_hidden_by_what_stands_before_it(browser, path):
    opened(browser, path)
    red = run(
        browser,
        """const theme = { mark: "#00ff00", stand: "#ffffff" };
        const geometry = geometryOf([["box", [1, 1, 1], [0, 0, 0], [1, 0, 0, 0]]]);
        const own = sceneOf({ geometry, pivot: false }, "#ff0000", theme, "#0000ff");
        const canvas = document.createElement("canvas");
        const cell = { x: 0, y: 0, width: 200, height: 200 };
        canvas.width = canvas.height = 200;
        const context = canvas.getContext("2d", { willReadFrequently: true });
        const camera = cameraOf(0, 0, cell), pixels = [];
        for (const points of [[], [[-0.9, -0.2, 0], [-0.9, 0, 0], [-0.9, 0.2, 0]]]) {
          own.set({ q: [1, 0, 0, 0], points, vectors: [] });
          paintScenes(context, 200, 200, [{ cell, camera, scene: own }]);
          pixels.push([...context.getImageData(60, 90, 80, 20).data]);
        }
        return pixels[0].filter((value, k) => value !== pixels[1][k]).length;""",
    )
    assert red == 0


@pytest.mark.parametrize("width", [150, 170, 400])
def test_no_number_below_a_body_is_cut_off(browser, path, width):
    opened(browser, path)
    texts = run(
        browser,
        f"""const context = document.createElement("canvas").getContext("2d"), found = [];
        context.fillText = (text) => found.push(text);
        const cell = {{ x: 0, y: 0, width: {width}, height: 200 }};
        const theme = {{ sans: "sans-serif", ink: "#000000" }};
        title(context, cell, "c02 rk4", "#ff0000", theme, "117° off, diverged at 10.08 s");
        return found;""",
    )
    assert ", ".join(texts[1:]) == "117° off, diverged at 10.08 s"
