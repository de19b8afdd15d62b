"""Colours that can be distinguished and read; dashes that do not repeat within an engine."""

import re
from importlib.resources import files
from itertools import combinations

import pytest
from synthetic_record import INTEGRATORS, engine_entry

from omegadot.reports.charts.palette import COLOURS, INK, colours, dashes
from omegadot.reports.page.page import draw_page

CSS = files("omegadot.reports.page").joinpath("templates", "report.css").read_text()


def themes():
    light, dark = re.findall(r":root \{(.*?)\}", CSS, flags=re.S)[:2]
    return [dict(re.findall(r"--([\w-]+): (#\w+);", block)) for block in (light, dark)]


def linear(colour):
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]


def luminance(colour):
    return sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear(colour), strict=True))


def contrast(one, other):
    """WCAG 2.1, relative contrast."""
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("theme", [0, 1])
def test_text_is_readable(theme):
    found = themes()[theme]
    backs = [found[name] for name in ("page", "panel", "shade")]
    pairs = [(found[name], back) for name in ("ink", "soft", "link") for back in backs]
    pairs += [
        (found[name], found[f"{name}-back"]) for name in ("pass", "fail", "declared", "missing")
    ]
    pairs += [(found["missing"], found["panel"])]
    assert min(contrast(*pair) for pair in pairs) >= 4.5


@pytest.mark.parametrize("theme", [0, 1])
def test_lines_stand_out_from_the_page(theme):
    panel = themes()[theme]["panel"]
    assert min(contrast(pair[theme], panel) for pair in (*COLOURS, INK)) >= 3.0


JUST_NOTICEABLE = 2.3  # CIE76
# Viénot, Brettel and Mollon (1999): linear RGB as a protanope and a deuteranope see it.
SEEN = {
    "protan": ((0.11238, 0.88762, 0.0), (0.11238, 0.88762, 0.0), (0.00401, -0.00401, 1.0)),
    "deutan": ((0.29275, 0.70725, 0.0), (0.29275, 0.70725, 0.0), (-0.02234, 0.02234, 1.0)),
}


def lab(rgb):
    matrix = ((0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505))
    xyz = [
        sum(a * max(0.0, b) for a, b in zip(row, rgb, strict=True)) / white
        for row, white in zip(matrix, (0.9505, 1.0, 1.089), strict=True)
    ]
    x, y, z = (v ** (1 / 3) if v > 0.008856 else 7.787 * v + 16 / 116 for v in xyz)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


@pytest.mark.parametrize("theme", [0, 1])
@pytest.mark.parametrize("kind", SEEN)
def test_the_first_engines_can_be_distinguished_by_every_reader(theme, kind):
    # CIE76: a difference of 2.3 is just noticeable; side by side on thin lines, ten are wanted.
    def seen(colour):
        rgb = linear(colour)
        return lab([sum(a * b for a, b in zip(row, rgb, strict=True)) for row in SEEN[kind]])

    for one, other in combinations([INK[theme], *(pair[theme] for pair in COLOURS[:4])], 2):
        gap = sum((a - b) ** 2 for a, b in zip(seen(one), seen(other), strict=True)) ** 0.5
        assert gap > 10, (one, other)


def test_known_engines_keep_their_colours_and_no_two_share_one():
    some, more = colours(["mujoco", "dart"]), colours(["drake", "mujoco", "reference", "dart", "x"])
    assert some["mujoco"] == more["mujoco"]
    assert some["dart"] == more["dart"]
    assert len(set(more.values())) == 5


@pytest.mark.parametrize("theme", [0, 1])
def test_twenty_engines_can_be_told_apart_and_stand_out_from_the_page(theme):
    """Caught: a palette that begins again, and colours that differ in one theme alone."""
    known = ["reference", "mujoco", "pinocchio", "dart", "drake"]
    found = colours([*known, *(f"engine-{k}" for k in range(15))])
    shades = [pair[theme] for pair in found.values()]
    panel = themes()[theme]["panel"]
    assert min(contrast(shade, panel) for shade in shades) >= 3.0

    for sight in (*SEEN.values(), ((1, 0, 0), (0, 1, 0), (0, 0, 1))):
        places = [
            lab([sum(a * b for a, b in zip(row, linear(shade), strict=True)) for row in sight])
            for shade in shades
        ]
        gaps = [
            sum((a - b) ** 2 for a, b in zip(one, other, strict=True)) ** 0.5
            for one, other in combinations(places, 2)
        ]
        assert min(gaps) > 4 * JUST_NOTICEABLE


def test_a_further_engine_has_its_colour_whichever_of_the_known_are_there():
    few, many = colours(["x", "y"]), colours(["dart", "x", "drake", "mujoco", "y"])
    assert (few["x"], few["y"]) == (many["x"], many["y"])
    assert many["drake"] == COLOURS[3]


def test_a_scheme_is_a_dash_and_an_engine_never_repeats_one():
    engines = [engine_entry(name, own) for name, own in INTEGRATORS.items()]
    engines.insert(0, engine_entry("exact", {"closed-form": 0}))
    engines.append(engine_entry("twins", {"RK4": 4, "Euler": 1, "lie-rk4": 4, "own": 2}))
    found = dashes(engines)
    assert found["mujoco", "Euler"] == found["reference", "semi-implicit-euler"] == ""
    assert found["mujoco", "RK4"] == found["reference", "lie-rk4"] == found["twins", "RK4"]
    assert len({dash for (engine, _), dash in found.items() if engine == "twins"}) == 4


def test_no_label_of_a_picture_is_cut(record):
    """Caught: a tick at the very end of an axis, half of whose label lies outside."""
    page = draw_page(record)
    labels = re.findall(r'<text x="(\d+)" y="\d+">([^<]*)</text>', page)
    assert "10⁻¹³" in {text for _, text in labels}
    # At 11 px a figure is 7 px wide at most, a raised one 5 px.
    widths = {text: sum(5 if c in "⁰¹²³⁴⁵⁶⁷⁸⁹⁻" else 7 for c in text) for _, text in labels}
    assert all(int(x) + widths[text] / 2 <= 440 for x, text in labels)
