"""Findings: the page is what was measured, and one stands only where two ways show the same."""

from __future__ import annotations

import ast
import re
import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from command_line import ENGINES, omegadot

import omegadot as api
from omegadot.adapters.registry import BUILT_IN, OURS
from omegadot.commands.findings.entry import COMMENTS, Entry, entries_of, read_entry
from omegadot.commands.findings.page import AGAIN, anchor, markdown_of
from omegadot.scenarios import builtin_names

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "findings"
PAGE = ROOT / "docs" / "findings.md"
ENTRIES = entries_of(FOLDER)
BRAKED = f"{ENGINES / 'shipped.py'}:BrakedAdapter"
MENDED, RELEASE = 0.0, "1.0"
# 0.05 of omega a second, in steps of 0.01 s for 5 s
LOST = 1.0 - (1.0 - 0.05 * 0.01) ** 500
HEAD = """\
# /// finding
# engine = "braked"
# integrator = "step"
# scenario = "sphere"
# setup = "as-shipped"
# timestep = 0.01
# metric = "trajectory/omega/error_max"
# kind = "default"
# reach = "ordinary"
# title = "Omega is damped"
# what = "A sphere slows down."
# why = "A twentieth of omega is lost a second."
# mends = "damping = 0"
# link = "https://example.org"
# ///
"""


def printing(release: str = RELEASE, figure: object = LOST, mended: object = MENDED) -> str:
    """A script that prints these."""
    pairs = (("release", release), ("figure", figure), ("mended", mended))
    return HEAD + "".join(f'print("{name}", "{value}")\n' for name, value in pairs)


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("record") / "run"
    api.run("sphere", BRAKED, setup="both", out=out)
    return out


@pytest.fixture
def found(record: Path, tmp_path: Path) -> Callable[..., str]:
    def doubt(script: str, *, given: bool = True, timeout: float = 60.0) -> str:
        (tmp_path / "one.py").write_text(script, encoding="utf-8")
        runs = [record] if given else []
        how = {"folder": tmp_path, "reproduce": True, "timeout": timeout}
        return api.findings(runs, **how).findings[0].doubt  # type: ignore[arg-type]

    return doubt


def test_the_page_is_what_was_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    page = PAGE.read_text(encoding="utf-8")
    assert page == markdown_of(api.findings()), f"docs/findings.md is old: {AGAIN}"


def test_every_finding_on_the_page_stands_and_is_linked() -> None:
    page = PAGE.read_text(encoding="utf-8")
    heads = {anchor(title) for title in re.findall(r"^### (.*)$", page, re.MULTILINE)}
    links = re.findall(r"\]\(#([^)]*)\)", page)
    assert heads == set(links)
    assert len(links) == len(heads) == len(ENTRIES)
    rows = [line.count(" | ") for line in page.splitlines() if line.startswith("| ")]
    assert set(rows) == {4}
    assert "None: each finding" in page


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_a_script_stands_alone(entry: Entry) -> None:
    """Caught: a second way that goes through the adapter, and is no second one."""
    text = entry.script.read_text(encoding="utf-8")
    body = text.split(f"{COMMENTS[entry.script.suffix]} ///\n", 1)[1]
    assert not re.search(r"omegadot|worker\.js", body)
    assert "release" in body
    assert bool(entry.mends) == ("mended" in body and "'mended'" in body.replace('"', "'"))
    if entry.script.suffix == ".py":
        ast.parse(body)
    assert entry.engine in OURS
    assert entry.scenario in builtin_names() or (ROOT / entry.scenario).is_file()
    assert entry.timestep in api.scenario(_scenario(entry)).run.timesteps


def _scenario(entry: Entry) -> str:
    return entry.scenario if entry.scenario in builtin_names() else str(ROOT / entry.scenario)


def test_each_scenario_is_of_a_finding() -> None:
    files = {f"docs/findings/{path.name}" for path in FOLDER.glob("*.toml")}
    assert files <= {entry.scenario for entry in ENTRIES}


def test_those_of_engines_that_are_always_there_are_reproduced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a user does: the run, then the script, into a folder without figures."""
    monkeypatch.chdir(ROOT)
    own = [entry for entry in ENTRIES if entry.engine in BUILT_IN]
    assert own
    for entry in own:
        shutil.copy(entry.script, tmp_path)
        out = tmp_path / "records" / entry.name
        engine = f"{entry.engine}:{entry.integrator}"
        api.run(entry.scenario, engine, setup="both", out=out)
        result = api.findings(out, folder=tmp_path, names=entry.name, reproduce=True)
        assert [one.doubt for one in result.findings] == [""]


def test_it_stands_where_both_ways_show_the_same(
    found: Callable[..., str], record: Path, tmp_path: Path
) -> None:
    assert found(printing()) == ""
    assert found(printing(figure=LOST * 1.004)) == ""
    done = omegadot("findings", str(record), "--folder", str(tmp_path), folder=tmp_path)
    assert done.code == 0, done.err
    assert "1 of 1 findings stand." in done.out
    again = omegadot("findings", "--folder", ".", "--format", "markdown", folder=tmp_path)
    assert "omega, 22 % in the record" in again.out
    assert "0 in the setup `physics`" in again.out


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        (printing(figure=LOST * 1.006), "the script's figure is"),
        (printing(figure="nan"), "the script was not run"),
        (printing(figure="much"), "the script was not run"),
        (printing(release="1.1"), "the script ran release 1.1, the record 1.0"),
        (printing(mended=LOST), "what is said to mend it"),
        (printing(mended="x"), "what is said to mend it"),
        (HEAD, "it printed no figure and no release"),
        (HEAD + "raise ValueError('no engine')\n", "ValueError: no engine"),
        (printing().replace('"as-shipped"', '"physics"'), "no gate fails"),
        (printing().replace("omega/error_max", "attitude/unit_length"), "is within the round-off"),
        (printing().replace("omega/error_max", "omega/nothing"), "no record has the run"),
        (printing().replace('"sphere"', '"t-handle"'), "no record has the run"),
        (printing().replace("0.01\n", "0.03\n"), "no record has the run"),
    ],
)
def test_it_does_not_stand(found: Callable[..., str], script: str, reason: str) -> None:
    assert reason in found(script)


def test_it_needs_a_record(found: Callable[..., str]) -> None:
    assert found(printing(), given=False) == "no record has the run"


def test_a_script_that_hangs_is_ended(found: Callable[..., str]) -> None:
    assert "took longer than" in found(HEAD + "import time\ntime.sleep(60)\n", timeout=1.0)


def test_an_order_is_held_as_a_whole_number(found: Callable[..., str]) -> None:
    script = printing(figure=1.3).replace(
        "trajectory/omega/error_max", "scheme/omega/observed_order"
    )
    ordered = script.replace('# mends = "damping = 0"', "# expected = 4.0")
    assert found(ordered).startswith("the script's figure is 1.3")  # it loses omega at order 0
    assert found(ordered.replace('"1.3"', '"0.2"')) == ""
    assert "the expected order" in found(ordered.replace("4.0", "0.0"))


@pytest.mark.parametrize(
    ("head", "reason"),
    [
        (HEAD.replace("# ///\n", ""), "close it with ///"),
        (HEAD.replace("# kind", "# knid"), "unknown key 'knid'; write kind."),
        (HEAD.replace('"default"', '"bug"'), "kind is 'bug'"),
        (HEAD.replace("0.01", '"0.01"'), "timestep is '0.01'; give a number with a point."),
        (HEAD.replace('# link = "https://example.org"\n', ""), "link is None; give a text."),
        (HEAD.replace("trajectory/omega/", ""), "give GATE/CHANNEL/METRIC."),
        (HEAD.replace('"default"', "default"), "not valid TOML"),
        ("print(1)\n", "no script in it declares a finding"),
    ],
)
def test_a_head_that_is_wrong_is_one_sentence(tmp_path: Path, head: str, reason: str) -> None:
    (tmp_path / "one.py").write_text(head, encoding="utf-8")
    done = omegadot("findings", "--folder", str(tmp_path), folder=tmp_path)
    assert done.code == 2
    assert reason in done.err
    assert done.err.count("\n") == 1


@pytest.mark.parametrize(
    "text", ["", "[]", '{"findings": {"one": {"value": "x"}}}', '{"findings": 3}']
)
def test_figures_that_are_damaged_are_one_sentence(tmp_path: Path, text: str) -> None:
    (tmp_path / "one.py").write_text(printing(), encoding="utf-8")
    (tmp_path / "measured.json").write_text(text, encoding="utf-8")
    done = omegadot("findings", "--folder", str(tmp_path), folder=tmp_path)
    assert done.code == 2
    assert "remove it, and measure again." in done.err


def test_the_head_is_toml_in_comments_of_both_languages(tmp_path: Path) -> None:
    script = tmp_path / "one.js"
    script.write_text(re.sub("^#", "//", HEAD, flags=re.MULTILINE), encoding="utf-8")
    entry = read_entry(script)
    assert entry is not None
    table = tomllib.loads("".join(line[2:] for line in HEAD.splitlines(True)[1:-1]))
    assert table == {name: getattr(entry, name) for name in table}
