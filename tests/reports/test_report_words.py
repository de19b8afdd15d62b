"""Words of the page: versions, units, names of metrics, and the glossary's own text."""

import re

import pytest
from synthetic_record import build, metric, with_metrics

from omegadot.reports.page.page import draw_page
from omegadot.reports.page.templating import kept, shown
from omegadot.reports.summary.summary import Column
from omegadot.reports.text.engine_version import with_version
from omegadot.reports.text.metric_names import metric_name
from omegadot.reports.text.numbers import engine_name


@pytest.mark.parametrize(
    ("version", "text"),
    [("4.0.0", "mine 4.0.0"), ("1", "mine (version 1)"), ("", "mine"), ("rc1", "mine rc1")],
)
def test_a_version_is_not_read_as_an_index(version, text):
    assert with_version("mine", version) == text
    assert engine_name("mine", version, "physics") == text
    assert Column("mine", version, "physics", "mine").name == text
    assert engine_name("mine", version, "as-shipped") == f"{text} as-shipped"


def test_a_column_that_has_its_version_has_it_once():
    label = with_version("mine", "1")
    assert Column("mine", "1", "physics", label).name == label


def test_units_are_written_in_one_way_on_the_page():
    record = build(("sphere",))
    add = ["sphere", "mujoco", None, None, "trajectory", "omega_dot", "resolvable_floor"]
    found = draw_page(with_metrics(record, metric(*add, 1e-13, unit="rad/s^2", verdict="info")))
    assert "rad/s²" in found
    assert "/s^2" not in found
    assert shown("held to 200 rad/s^2, m/s^2 too") == "held to 200 rad/s², m/s² too"
    assert shown("x/s^2y") == "x/s^2y"


@pytest.mark.parametrize(
    ("text", "whole"),
    [
        ("step 0.005 s", "step 0.005\u00a0s"),
        ("9.4e-14 relative", "9.4e-\u206014 relative"),
        ("2 runs, 3 scenarios", "2 runs, 3 scenarios"),
        ("1 s-shaped", "1 s-shaped"),
    ],
)
def test_a_number_keeps_its_exponent_and_its_unit(text, whole):
    assert kept(text) == whole


def test_metrics_are_named_in_plain_english():
    for metric_of in ("rate_at_no_step", "residual_of_sibling", "residual_alone", "match"):
        assert metric_of.replace("_", " ") not in metric_name(metric_of)
    assert metric_name("drift_full") == "drift full"


def test_the_glossary_of_the_page_has_no_marks_of_a_text_file():
    page = draw_page(build(("sphere",)))
    (own,) = re.findall(r'<section id="glossary".*?</section>', page, re.DOTALL)
    text = re.sub(r"<[^>]+>", "", own)
    assert "`" not in text
    assert "^" not in text
    formulas = re.findall(r'<span class="part">([^<]*)', own)
    labels = {formula.split(":")[0] for formula in formulas}
    assert labels <= {"Formula", "Unit", "Units", "Value", "Values"}
    # What is requested of the machine is not named by the key of a file.
    assert "longdouble_bits" not in re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
