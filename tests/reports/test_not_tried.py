"""What a green page says that its scenarios do not have, and that random systems do."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from synthetic_record import metric, with_metrics

from omegadot.harness.arguments import case_of
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record
from omegadot.reports.summary.not_tried import not_tried, pairs_of, parts_of
from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.markdown import markdown_of
from omegadot.reports.text.terminal import print_summary
from omegadot.scenarios import builtin_names, scenario
from omegadot.scenarios.random_systems import BLOCK

ENGINE = {"name": "acme", "argument": "acme.py:Acme"}


def entry_of(name: str) -> dict[str, Any]:
    """A scenario as it stands in a record."""
    case = case_of(scenario(name), ())
    system = {**vars(case.system.body), **vars(case.system.load)}
    numbers = {k: None if v is None else np.asarray(v).tolist() for k, v in system.items()}
    return {"name": name, "definition": case.scenario.to_dict(), "system": numbers}


def said_of(*names: str, engines: tuple[dict[str, Any], ...] = (ENGINE,)) -> str:
    run = {"engines": list(engines), "scenarios": [entry_of(name) for name in names]}
    found = not_tried(run, names)
    return found.sentence if found else ""


def test_the_built_in_scenarios_have_no_pivot_off_the_origin() -> None:
    """Caught: a lever read from the wrong point, which is green on all of them without a word."""
    assert said_of(*builtin_names()) == (
        "Not tested here: a pivot off the origin; gravity off the -z axis; a first quaternion of "
        "negative scalar part; some of the others in one system. omegadot check acme.py:Acme "
        "draws 24 random systems, with all of them among these."
    )


def test_random_systems_have_all_that_is_said_to_be_missing() -> None:
    entries = [entry_of(f"random-0-{k}") for k in range(BLOCK)]
    found = [parts_of(e["system"], e["definition"]["initial"]) for e in entries]
    assert all(any(parts[name] for parts in found) for name in found[0])
    lacking = [p for p in pairs_of(found[0]) if not any(f[p[0]] and f[p[1]] for f in found)]
    assert lacking == []
    assert said_of(*(e["name"] for e in entries)) == ""


def test_one_scenario_lacks_the_most() -> None:
    text = said_of("t-handle")
    assert "a pivot at the origin; a pivot off the origin" in text
    assert "; 7 more. omegadot" in text  # of a free body there are no pairs to miss
    assert "omegadot check ENGINE draws 24 " in said_of("t-handle", engines=(ENGINE, ENGINE))
    assert said_of("t-handle", engines=({"name": "trace"},)) == ""  # no command checks it


def test_it_stands_on_a_green_page_alone(
    record: Record, capsys: pytest.CaptureFixture[str]
) -> None:
    engines = [{**e, "argument": e["name"]} for e in record.run["engines"]]
    green = replace(record, run={**record.run, "engines": engines})
    advice = summarise(green).untried
    assert advice is not None
    assert advice.text.startswith("Not tested here: ")
    page = draw_page(green)
    assert page.index("<h1>") < page.index(advice.text) < page.index("Verdicts")
    # Caught: a command in prose, which one cannot tell from the sentence about it.
    assert f"<code>{advice.command}</code> draws {BLOCK} random systems" in page
    print_summary(green)
    assert advice.sentence in " ".join(capsys.readouterr().out.split())
    assert f"`{advice.command}` draws {BLOCK} random systems" in markdown_of(green)
    row = metric("sphere", "dart", None, None, "model", "model", "mass", 1.0, verdict="fail")
    assert summarise(with_metrics(green, row)).untried is None
