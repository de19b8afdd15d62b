"""The page as plain HTML: whole without script, self-contained, safe whatever the names."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise

import pytest
from synthetic_record import build, metric, scenario_entry, task, with_metrics

from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record, read_record, write_record
from omegadot.reports.record.schema import METRICS, TRAJECTORIES, empty
from omegadot.reports.text.numbers import short

HOSTILE = "<script>alert(1)</script>"


class Outline(HTMLParser):
    """Every tag with its attributes, and the text, scripts and styles apart."""

    def __init__(self, page):
        super().__init__()
        self.tags, self.text, self.inside = [], [], []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag in ("script", "style"):
            self.inside.append(tag)

    def handle_endtag(self, tag):
        if self.inside and tag == self.inside[-1]:
            self.inside.pop()

    def handle_data(self, data):
        if not self.inside:
            self.text.append(data)

    def named(self, tag):
        return [attrs for name, attrs in self.tags if name == tag]


@pytest.fixture(scope="module")
def sound():
    return draw_page(build())


def text_of(page):
    return " ".join(" ".join(Outline(page).text).split())


def with_run(record, **more):
    return replace(record, run={**record.run, **more})


def test_nothing_outside_the_page_is_named(sound):
    assert not re.search(r"https?:|//[\w-]+\.\w", sound)
    outline = Outline(sound)
    links = {a.get("href") for a in outline.named("a")}
    assert all(link.startswith("#") for link in links)
    assert not [a for _, a in outline.tags if "src" in a]
    assert not outline.named("link")
    (policy,) = [a["content"] for a in outline.named("meta") if "http-equiv" in a]
    assert policy.startswith("default-src 'none'")


def test_every_link_of_the_page_has_its_target(sound):
    outline = Outline(sound)
    ids = [a["id"] for _, a in outline.tags if a.get("id")]
    assert len(ids) == len(set(ids))
    assert {a["href"][1:] for a in outline.named("a")} <= set(ids)
    labels = {a["aria-labelledby"] for _, a in outline.tags if "aria-labelledby" in a}
    assert labels <= set(ids)


def test_the_matrix_needs_no_script(sound):
    matrix = re.search(r'<table class="matrix">.*?</table>', sound, re.S).group(0)
    assert matrix.count('class="s-pass"') == 6
    assert matrix.count('href="#scenario-sphere"') == 4
    assert "3.1e-\u206015" in matrix  # on one line
    assert f"{short(0.005**4)} … 0.005" in matrix.replace("\u2060", "")


def test_every_run_has_a_row_in_every_table(sound):
    assert sound.count('<th scope="row">Euler, step 0.005 s') == 2 * 2
    assert sound.count("explained by semi-implicit-euler, to 1.7e-\u206011") == 30


def test_all_head_cells_have_a_scope_and_no_heading_is_skipped(sound):
    outline = Outline(sound)
    assert all(a.get("scope") for a in outline.named("th"))
    levels = [int(tag[1]) for tag, _ in outline.tags if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert max(b - a for a, b in pairwise(levels)) <= 1


def test_every_chart_has_a_text_alternative_and_a_table(sound):
    outline = Outline(sound)
    charts = [a for a in outline.named("div") if a.get("class") == "chart"]
    assert len(charts) == 2 * (1 + 4 + 2)
    assert all(a["role"] == "img" and "table" in a["aria-label"] for a in charts)
    assert sound.count("The numbers behind these charts") == 2


def test_equations_errata_and_limitations_are_stated(sound):
    text = text_of(sound)
    for expected in ("(8)", "(9) is printed without its minus sign", "2.2.1", "Limitations"):
        assert expected in text
    for expected in ("sleeping", "quaternions are (w, x, y, z)", "numpy", "2.0.0", "x86_64"):
        assert expected in text
    assert "omegadot run --out 'a folder'" in text
    assert "example.org/issue/1" in text


def test_hostile_text_stays_text(sound):
    record = build((HOSTILE, '"><img src=x onerror=alert(2)>', "{{ 7*7 }}"))
    tasks = [dict(entry, why=HOSTILE) for entry in record.run["tasks"]]
    tasks[0].update(outcome="raised", reason=HOSTILE, gates={})
    entries = [scenario_entry(e["name"], title=HOSTILE) for e in record.run["scenarios"]]
    for entry in entries:
        entry.update(shows=HOSTILE, source=HOSTILE, definition={HOSTILE: "</pre></script>"})
    engines = [{**e, "links": [HOSTILE, "javascript:alert(3)"]} for e in record.run["engines"]]
    record = with_run(
        record,
        tasks=tasks,
        scenarios=entries,
        engines=engines,
        command=[HOSTILE],
        machine={HOSTILE: HOSTILE},
        versions={"x": HOSTILE},
        created=HOSTILE,
        omegadot=HOSTILE,
    )
    row = metric(HOSTILE, HOSTILE, HOSTILE, 0.1, "model", "model", HOSTILE, 1.0, verdict="fail")
    page = draw_page(with_metrics(record, {**row, "note": HOSTILE, "unit": HOSTILE}))
    outline = Outline(page)
    assert len(outline.named("script")) == len(Outline(sound).named("script"))
    assert not outline.named("img")
    assert not [a for _, a in outline.tags if any(name.startswith("on") for name in a)]
    assert not [a for a in outline.named("a") if not a["href"].startswith("#")]
    assert "alert(1)" not in "".join(re.findall(r"<script>(.*?)</script>", page, re.S))
    assert "{{ 7*7 }}" in text_of(page)
    assert page.count("&lt;script&gt;alert(1)") > 20


def test_names_that_look_alike_keep_their_own_addresses():
    page = draw_page(build(("a b", "a-b", "A_b", "Ω")))
    ids = [a["id"] for a in Outline(page).named("section")]
    assert len(ids) == len(set(ids))
    assert "scenario-3" in ids


def test_the_page_shows_the_source_of_error(sound):
    why = re.search(r'<section id="why".*?</section>', sound, re.S).group(0)
    text = text_of(why)
    assert "mujoco Euler and dart semi-implicit produce identical trajectories" in text
    assert "(both step semi-implicit-euler)" in text
    assert "They do so on all 2 scenarios that tell schemes apart." in text
    assert why.count("6 of 6") == 3
    assert "1.01 (1)" in text
    assert text_of(sound).count("3 runs at step 0.005 s produce 2 different trajectories") == 2
    assert sound.count('data-kind="convergence"') == sound.count('data-kind="cost"') == 2


def test_a_record_from_before_clusters_is_still_drawn(record):
    run = {key: value for key, value in record.run.items() if key != "clusters"}
    page = draw_page(replace(record, run=run))
    assert "identical trajectories (" not in page
    assert 'id="why"' in page


def test_what_did_not_run_is_not_green(record):
    tasks = [dict(entry) for entry in record.run["tasks"]]
    for entry in tasks:
        if entry["engine"] == "dart":
            entry.update(outcome="timeout", reason="no answer in 60 s", gates={})
    page = draw_page(with_run(record, tasks=tasks))
    matrix = re.search(r'<table class="matrix">.*?</table>', page, re.S).group(0)
    assert matrix.count("s-timeout") == 2
    assert matrix.count("s-pass") == 4
    assert "no answer in 60 s" in page


def test_records_with_little_in_them_are_drawn():
    run = {"schema": 1, "engines": [], "scenarios": [], "tasks": []}
    page = draw_page(Record(run, empty(METRICS), empty(TRAJECTORIES)))
    assert "No run was made." in page
    assert len(page) < 100_000  # no chart, no chart library
    tasks = [task("s", "dart", None, None, outcome="not-installed", reason="no dartpy")]
    some = {**run, "scenarios": [{"name": "s"}], "tasks": tasks, "complete": False}
    page = draw_page(Record(some, empty(METRICS), empty(TRAJECTORIES)))
    assert "not installed" in page
    assert "No trajectories" in page
    assert "Partial record" in page


def test_the_same_record_gives_the_same_page_from_disk_too(tmp_path, record, sound):
    write_record(record, tmp_path / "run", sound)
    assert draw_page(read_record(tmp_path / "run")) == sound


def test_the_page_is_small():
    # Plotly takes 2 MB of the 5 and three.js 0.2; 45 runs of 120 points in four charts must be
    # little.
    record = build(("a", "b", "c"), samples=200)
    assert len(draw_page(record).encode()) < 2.5e6


def test_an_order_is_no_relative_error(record):
    add = ["sphere", "dart", "semi-implicit", 0.01, "scheme", "omega", "observed_order"]
    page = draw_page(with_metrics(record, metric(*add, 1.02, verdict="info")))
    assert '<th scope="col">observed order</th>' in page
    assert '<th scope="col">drift full, relative</th>' in page
