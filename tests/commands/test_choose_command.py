"""``omegadot choose`` as a user has it, its recommendations measured again another way."""

from __future__ import annotations

import io
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from axe_check import LOOKS, violations
from chromium import Chromium
from command_line import FAULTY, QUICK, Result, omegadot, quick_scenario
from rich.console import Console

from omegadot.adapters.mujoco.adapter import MujocoAdapter
from omegadot.commands.cli import main
from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.rotations import attitude_angle, rotate
from omegadot.reference_impl.solutions.exact_solution import exact_states
from omegadot.reports.choice.page import draw_choice
from omegadot.reports.choice.sentences import headline, missed_text, step_text, variant_lines
from omegadot.reports.choice.tables import narrow, print_choice, ranking
from omegadot.scenarios import load_scenario

ATTITUDE, MOMENTUM = 1e-4, 1e-8
URDF = """<robot name="r"><link name="arm"><inertial><origin xyz="0.1 0 0" rpy="0 0 0.5"/>
 <mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial></link>
</robot>"""


@pytest.fixture(scope="module")
def chosen(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """A choice between MuJoCo's integrators, and the folder it was made in."""
    folder = tmp_path_factory.mktemp("choose")
    arguments = ["--attitude", "1e-4rad", "--momentum-drift", "10ppb", "--engine", "mujoco"]
    scenario = quick_scenario(folder)
    arguments += ["--budget", "0.05", "--format", "json", "--out", "out"]
    return folder, omegadot("choose", scenario, *arguments, folder=folder)


def rows(result: Result, status: str) -> list[dict[str, Any]]:
    (case,) = result.json["scenarios"]
    return [row for row in case["candidates"] if row["status"] == status]


def measured_again(scenario: Any, integrator: str, steps: int) -> tuple[float, float]:
    """The greatest attitude error in rad and the momentum drift, at every step of the horizon."""
    system, initial = system_of(scenario), initial_state_of(scenario)
    timestep = scenario.run.duration / steps
    adapter = MujocoAdapter()
    adapter.load(system)
    run = adapter.run(initial, integrator, timestep, steps, 1)
    _, exact = exact_states(system, initial, run.time)
    angle = attitude_angle(run.state.orientation, exact.orientation)
    spin = rotate(run.state.orientation, run.state.angular_velocity @ system.body.inertia)
    drift = np.linalg.norm(spin - spin[0], axis=-1) / np.linalg.norm(spin[0])
    return float(np.max(angle)), float(np.max(drift))


def test_what_is_recommended_holds_and_a_tenth_more_does_not(chosen: tuple[Path, Result]) -> None:
    folder, result = chosen
    assert result.code == 0, result.err
    scenario = load_scenario(folder / "quick.toml")
    qualified = rows(result, "qualifies")
    assert "RK4" in [row["integrator"] for row in qualified]
    for row in qualified:
        steps, step = row["found"]["steps"], row["found"]["timestep"]
        assert scenario.run.duration / steps == pytest.approx(step, rel=1e-12)
        assert 0.99 * step < float(step_text(step)) <= step * (1.0 + 1e-12)
        angle, drift = measured_again(scenario, row["integrator"], steps)
        assert angle <= ATTITUDE
        assert drift <= MOMENTUM
        angle, drift = measured_again(scenario, row["integrator"], math.floor(steps / 1.1))
        assert angle > ATTITUDE or drift > MOMENTUM
        assert row["found"]["passes"]
        assert not row["larger"]["passes"]


def test_those_that_are_out_show_by_how_much(chosen: tuple[Path, Result]) -> None:
    folder, result = chosen
    scenario = load_scenario(folder / "quick.toml")
    out = rows(result, "out")
    assert "Euler" in [row["integrator"] for row in out]
    for row in out:
        worst = row["missed"][0]
        angle, drift = measured_again(scenario, row["integrator"], worst["steps"])
        found = {"attitude": angle / ATTITUDE, "momentum-drift": drift / MOMENTUM}
        assert worst["factor"] == pytest.approx(max(found.values()), rel=1e-3)
        assert worst["factor"] > 1.0


def test_halved_and_doubled_requirements_were_run(chosen: tuple[Path, Result]) -> None:
    _, result = chosen
    (case,) = result.json["scenarios"]
    usual = {f"mujoco:{row['integrator']}": row["found"] for row in rows(result, "qualifies")}
    tried = {f"mujoco:{row['integrator']}": row["tried"] for row in case["candidates"]}
    assert len(case["variants"]) == 4
    for variant in case["variants"]:
        for place in variant["order"]:
            name = place["candidate"]
            (run,) = [t for t in tried[name] if t["steps"] == place["steps"]]
            assert run["errors"][variant["requirement"]]["value"] <= variant["limit"]
            if name in usual and variant["factor"] < 1.0:
                assert place["steps"] >= usual[name]["steps"]


def printed(choice: dict[str, Any], width: int = 100) -> str:
    raw = io.StringIO()
    print_choice(choice, Console(file=raw, width=width))
    return raw.getvalue()


def test_the_answer_is_what_is_printed_first(chosen: tuple[Path, Result]) -> None:
    """Caught: the answer below 45 lines of tables, and a row six lines high on 100 columns."""
    choice = chosen[1].json
    lines = printed(choice).splitlines()
    assert " ".join(lines[:2]).startswith(headline(choice["scenarios"][0])[:90])
    assert "Pareto" not in printed(choice)
    assert "memory" not in printed(choice)
    assert {"memory in MB", "Pareto-optimal"} <= set(ranking(choice, choice["scenarios"][0]).heads)
    narrowed = narrow(ranking(choice, choice["scenarios"][0]))
    assert all(len(row) == len(narrowed.heads) for row in narrowed.rows)


def test_where_nothing_qualifies_no_ranking_is_the_same(chosen: tuple[Path, Result]) -> None:
    """Caught: "the ranking is the same", twice, of an empty ranking."""
    case = chosen[1].json["scenarios"][0]
    nothing = {"left": [], "joined": [], "order": [], "same": True}
    variants = [{**variant, **nothing} for variant in case["variants"]]
    assert list(variant_lines({**case, "variants": variants})) == []


def test_a_step_is_written_in_one_way() -> None:
    """Caught: 0.00000897 in one column and 4.6e-6 in the next."""
    assert [step_text(h) for h in (0.05674, 8.97e-6, 0.002, 12345.0)] == [
        *("0.0567", "8.97e-6", "0.002", "12300"),
    ]


def test_the_page_stands_alone_and_the_json_is_the_one_printed(
    chosen: tuple[Path, Result],
) -> None:
    folder, result = chosen
    assert json.loads((folder / "out" / "choice.json").read_text()) == result.json
    page = (folder / "out" / "choice.html").read_text()
    assert "RK4" in page
    assert "http:" not in page
    assert "https:" not in page
    assert "<script" not in page
    assert not list((folder / "out").glob(".*"))


@LOOKS
def test_axe_finds_nothing_on_the_page(
    chosen: tuple[Path, Result], tmp_path: Path, look: dict[str, Any]
) -> None:
    with Chromium(tmp_path) as browser:
        assert violations(browser, chosen[0] / "out" / "choice.html", **look) == []


def test_the_page_fits_a_phone(chosen: tuple[Path, Result], tmp_path: Path) -> None:
    """Caught: error and factor off the right edge, between tall empty cells, and half a chart."""
    with Chromium(tmp_path) as browser:
        browser.open(chosen[0] / "out" / "choice.html", width=390, height=6000)
        every = "[...document.querySelectorAll('.scroll, .drawn')]"
        assert browser.evaluate(f"{every}.length") >= 2
        assert browser.evaluate(f"{every}.filter(e => e.scrollWidth > e.clientWidth).length") == 0
        high = "Math.max(...[...document.querySelectorAll('.chosen td')].map(e => e.clientHeight))"
        assert browser.evaluate(high) < 120
        heads = browser.evaluate(
            "[...document.querySelectorAll('.chosen td')].map(e => e.dataset.head)"
        )
        assert {"rank", "attitude error", "real-time factor", "misses"} <= set(heads)


def test_a_choice_in_the_folder_of_a_run_is_a_section_of_its_report(tmp_path: Path) -> None:
    scenario = quick_scenario(tmp_path)
    assert omegadot("run", scenario, "--engine", "mujoco:RK4", folder=tmp_path).code == 0
    run = tmp_path / "omegadot-run"
    assert 'id="choice"' not in (run / "report.html").read_text()
    arguments = ["choose", scenario, "--attitude", "1e-3", "--engine", "mujoco:RK4"]
    result = omegadot(*arguments, "--out", run, folder=tmp_path)
    assert result.code == 0, result.err
    assert "report.html" in result.out
    for _ in range(2):
        page = (run / "report.html").read_text()
        assert 'href="#choice"' in page
        assert "Required: attitude error within 1e-3" in page
        omegadot("report", run, folder=tmp_path)
    for broken in ("[]", "{", '{"scenarios": [{}]}', "[" * 100_000):
        (run / "choice.json").write_text(broken)
        result = omegadot("report", run, folder=tmp_path)
        assert result.code == 2, result.err
        assert "choice.json: not a choice" in result.err
        assert result.err.count("\n") == 1


def test_hostile_texts_are_shown_as_they_are(chosen: tuple[Path, Result]) -> None:
    _, result = chosen
    choice = result.json
    choice["scenarios"][0]["title"] = choice["scenarios"][0]["name"] = "<img src=x onerror=1>"
    choice["scenarios"][0]["candidates"][0]["integrator"] = '"><script>'
    page = draw_choice(choice)
    assert "<img" not in page
    assert "<script" not in page
    assert "Below the red line all accuracy limits are met." in page


def test_a_link_in_a_motion_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text(URDF)
    arguments = ["--body", "robot.urdf#arm", "--angular-velocity", "0.3", "-2", "0.1"]
    arguments += ["--duration", "500ms", "--omega", "1mrad/s", "--engine", "mujoco:RK4"]
    result = omegadot("choose", *arguments, folder=tmp_path)
    assert result.code == 0, result.err
    assert "arm, 0.5 s: 1 of 1 integrator qualifies" in result.out


def test_a_body_that_cannot_be_takes_an_option_and_is_named(tmp_path: Path) -> None:
    text = URDF.replace('izz="', 'izz="9')
    (tmp_path / "robot.urdf").write_text(text)
    arguments = ["--body", "robot.urdf#arm", "--angular-velocity", "0.3", "-2", "0.1"]
    arguments += ["--duration", "500ms", "--omega", "1", "--engine", "mujoco:RK4", "--out", "o"]
    result = omegadot("choose", *arguments, folder=tmp_path)
    assert result.code == 2
    assert "--allow-impossible-inertia" in result.err
    result = omegadot("choose", *arguments, "--allow-impossible-inertia", folder=tmp_path)
    assert result.code == 0, result.err
    assert "arm: an impossible inertia, allowed on request" in result.out
    assert (
        "arm: an impossible inertia, allowed on request" in (tmp_path / "o/choice.html").read_text()
    )
    choice = json.loads((tmp_path / "o/choice.json").read_text())
    assert choice["scenarios"][0]["definition"]["body"]["allow_impossible_inertia"] is True


def test_what_is_just_missed_differs_in_its_digits() -> None:
    """It read "1.0e-6, required at most 1.0e-6"."""
    missed = {"requirement": "energy-drift", "found": 1.04e-6, "limit": 1e-6, "factor": 1.04}
    text = missed_text({**missed, "unit": "1"})
    assert text == "energy drift 1.04e-6, required at most 1e-6 (off by 1.04x)"


def test_a_step_is_shown_in_the_digits_that_are_known() -> None:
    """Caught: 0.08080808 of a step that is known to 5 %."""
    assert [step_text(x) for x in (8 / 99, 0.002, 8 / 356769, 0.1, 1.0, 12.0)] == [
        *("0.0808", "0.002", "2.24e-5", "0.1", "1", "12"),
    ]


def test_errors_are_in_the_unit_of_the_requirement(tmp_path: Path) -> None:
    """Caught: 0.5deg required, and 0.0078 rad of error beside it."""
    arguments = ["--attitude", "0.5 °", "--momentum-drift", "1%", "--engine", "mujoco:RK4"]
    arguments += ["--engine", "mujoco:Euler", "--budget", "0.02", "--out", "o"]
    result = omegadot("choose", quick_scenario(tmp_path), *arguments, folder=tmp_path)
    assert result.code == 0, result.err
    assert re.search(r"0\.\d+ deg \(margin", result.out)
    assert re.search(r"0\.\d+ % \(margin", result.out)
    assert "attitude error halved (0.25 deg): " in result.out
    assert re.search(r"fails: [\d.]+ times the limit", result.out)  # of what, it did not say
    assert " rad" not in result.out
    wanted = json.loads((tmp_path / "o/choice.json").read_text())["requirements"]["accuracy"]
    assert wanted[0]["unit"] == "rad"  # as the numbers of the file are
    assert wanted[0]["limit"] == pytest.approx(math.radians(0.5))
    missed = {"requirement": "attitude", "found": math.radians(1.0), "limit": math.radians(0.5)}
    text = missed_text({**missed, "factor": 2.0, "unit": "rad", "shown": wanted[0]["shown"]})
    assert text == "attitude error 1 deg, required at most 0.5 deg (off by 2x)"


def test_nothing_qualifies(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    arguments = ["quick.toml", "--engine", "mujoco:Euler", "--budget", "0.02"]
    result = omegadot("choose", *arguments, "--attitude", "1e-9", folder=tmp_path)
    assert result.code == 1, result.err
    assert "nothing qualifies. The nearest is mujoco" in result.out
    result = omegadot("choose", *arguments, "--attitude", "1e-15", folder=tmp_path)
    assert result.code == 1, result.err
    assert "double precision cannot verify the requested attitude error" in result.out


@pytest.mark.parametrize(("factor", "left_open"), [("0.001", True), ("500", False)])
def test_what_would_be_too_slow_is_not_said_to_qualify_perhaps(
    tmp_path: Path, factor: str, left_open: bool
) -> None:
    """Of order 1, Euler needs runs of minutes: too long for a factor of 500, not for 0.001."""
    quick_scenario(tmp_path)
    arguments = ["quick.toml", "--engine", "mujoco:RK4", "--engine", "mujoco:Euler"]
    arguments += ["--attitude", "1e-7", "--budget", "0.03", "--real-time-factor", factor]
    result = omegadot("choose", *arguments, "--out", "out", folder=tmp_path)
    assert result.code == 0, result.err
    page = (tmp_path / "out" / "choice.html").read_text()
    for text in (result.out, page):
        assert ("1 more might, in runs longer than the budget" in text) is left_open
        assert ("(not verified)" in text) is left_open
        assert ("cannot qualify: at a step of" in text) is not left_open
    assert "required at least 500" in result.out or left_open


def test_a_crash_is_distinguished_from_a_miss(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    arguments = ["quick.toml", "--adapter", f"{FAULTY}:Killed", "--engine", "killed"]
    arguments += ["--attitude", "1e-3", "--budget", "0.2"]
    result = omegadot("choose", *arguments, "--format", "json", folder=tmp_path)
    assert result.code == 3, result.err
    assert [row["integrator"] for row in rows(result, "crashed")] == ["semi-implicit-euler"]
    assert [row["integrator"] for row in rows(result, "qualifies")] == ["rk4-quaternion"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "no accuracy is required"),
        (["--attitude", "1"], "nothing to simulate"),
        (["t-handle", "--attitude", "1 degg"], "write deg"),
        (["t-handel", "--attitude", "1deg"], "t-handle"),
        (["--body", "no.urdf#x", "--attitude", "1deg"], "angular-velocity"),
        (["t-handle", "--body", "no.urdf#x", "--attitude", "1deg"], "missing"),
        (["t-handle", "--attitude", "1deg", "--engine", "mujco"], "mujoco"),
        (["t-handle", "--attitude", "1deg", "--engine", "exact"], "measured by"),
        (["t-handle", "--attitude", "1deg", "--requirements", "no.toml"], "no.toml"),
        (["t-handle", "--attitude", "1deg", "--duration", "-3"], "--duration"),
        (["sphere", "--flip-time", "1ms", "--engine", "mujoco:RK4"], "--flip-time"),
    ],
)
def test_bad_input_is_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    message: str,
) -> None:
    monkeypatch.setattr("sys.argv", ["omegadot", "choose", *arguments])
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 2
    text = capsys.readouterr().err
    assert message in text
    assert text.count("\n") == 1


def test_sets_are_judged_one_by_one_and_together(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    quick_scenario(tmp_path, QUICK.replace('"quick"', '"slow"').replace("2.0, 0.1", "0.2, 0.1"),
                   "slow.toml")  # fmt: skip
    # Of order 1, Euler would need some 1e9 steps for this: no machine takes them in the budget.
    arguments = ["quick.toml", "--scenario", "slow.toml", "--attitude", "1e-9"]
    arguments += ["--engine", "mujoco:RK4", "--engine", "mujoco:Euler", "--budget", "0.2"]
    result = omegadot("choose", *arguments, "--format", "json", folder=tmp_path)
    assert result.code == 0, result.err
    assert [case["name"] for case in result.json["scenarios"]] == ["quick", "slow"]
    (row,) = result.json["everywhere"]
    assert row["candidate"] == "mujoco:RK4"
    assert len(row["timesteps"]) == 2
