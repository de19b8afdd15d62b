"""Engines that a program serves: the frames from its end, and what is wrong with an answer."""

import io
import shutil
import sys
from importlib.metadata import EntryPoint
from pathlib import Path

import numpy as np
import pytest
from programs import EULER, ONE, SYSTEM, TOY, command_of, ok

from omegadot.adapters import registry
from omegadot.adapters.protocol import UnsupportedError
from omegadot.commands.check.check import check
from omegadot.harness.arguments import adapters_named, engine_choices
from omegadot.harness.engine_target import file_of, target_of
from omegadot.harness.own_engines import known_engines
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.system import Body, Load
from omegadot.scenarios import ScenarioError
from omegadot.workers.engine_end.checked import AnswerError
from omegadot.workers.engine_end.command import CommandAdapter
from omegadot.workers.engine_end.described import description_of
from omegadot.workers.engine_end.operations import OPERATIONS
from omegadot.workers.engine_end.program import ProgramError
from omegadot.workers.frame_reader import read_frame
from omegadot.workers.harness_end.process import WorkerProcess
from omegadot.workers.wire import encode_frame

ROOT = Path(__file__).parents[2]
WORKER = ROOT / "docs" / "examples" / "worker.js"


def test_the_worker_in_the_documents_is_the_one_that_runs() -> None:
    page = (ROOT / "docs" / "worker-protocol.md").read_text(encoding="utf-8")
    assert page.partition("```js\n")[2].partition("```")[0] == WORKER.read_text(encoding="utf-8")


def test_the_exchange_in_the_documents_is_what_is_sent_and_read() -> None:
    page = (ROOT / "docs" / "worker-protocol.md").read_text(encoding="utf-8")
    request, answer = (frame_of(part.partition("```")[0]) for part in page.split("```text\n")[1:])
    body = Body(np.array(2.0), np.zeros(3), np.diag([1.0, 2.0, 2.5]))
    load = Load(gravity=np.array([0.0, 0.0, -9.81]))
    assert request == encode_frame({"operation": "load", "body": body, "load": load})
    assert read_frame(io.BytesIO(answer)) == ok(None)


def frame_of(block: str) -> bytes:
    """The bytes of an exchange as it is printed."""
    lines = (line.partition("   #")[0] for line in block.splitlines())
    return b"".join(line.encode() if line[:1] == "{" else bytes.fromhex(line) for line in lines)


def test_a_worker_in_javascript_passes_every_gate() -> None:
    assert shutil.which("node"), "Node.js is needed, Debian's nodejs"
    found = check(f"js=node {WORKER}", scenarios=["full-tensor", "heavy-top"], shrink=False)
    verdicts = {one.scenario: set[str]() for one in found.by_check}
    for one, result in found.by_check.items():
        verdicts[one.scenario].add(result.verdict)
    assert verdicts == {"full-tensor": {"pass"}, "heavy-top": {"skip"}}
    assert {one.engine for one in found.by_check} == {"js"}


@pytest.mark.parametrize(
    ("description", "reason"),
    [
        (None, "the answer to describe is null; give an object with name, version"),
        ({**TOY, "integrators": 3}, "integrators is the number 3; give a list of objects"),
        ({**TOY, "colour": "red"}, "'colour' is not a key of the answer to describe; its keys"),
        ({"name": "toy", "integrators": []}, "the answer to describe lacks 'version'"),
        (
            {**TOY, "integrators": [{**EULER, "order": 1}]},
            "'order' is not a key of an integrator of the answer to describe",
        ),
        (
            {**TOY, "integrators": [{"name": "euler", "orders": {}}]},
            "an integrator of the answer to describe lacks 'scheme' (null if you do not know it)",
        ),
        ({**TOY, "name": 3}, "the answer to describe: name is the number 3; give a text"),
        ({**TOY, "links": "https://a.b"}, "is the text 'https://a.b'; give a list of texts"),
        ({**TOY, "links": {"home": "a.b"}}, "links is an object; give a list of texts"),
        ({**TOY, "conventions": ["wxyz", 3]}, "conventions has the number 3; give a list of texts"),
        ({**TOY, "licence": None}, "licence is null; give a text"),
        (
            {**TOY, "integrators": [{**EULER, "orders": {"omega": 1.5}}]},
            "orders has the number 1.5; give an object of whole numbers",
        ),
        (
            {**TOY, "integrators": [{**EULER, "orders": {"model": 1}}]},
            "'model'; give one of omega, attitude, energy, angular_momentum, linear_momentum, posi",
        ),
    ],
)
def test_descriptions_are_checked(tmp_path: Path, description: object, reason: str) -> None:
    with pytest.raises(AnswerError) as caught:
        description_of(CommandAdapter(command_of(tmp_path, describe=ok(description))))
    assert reason in str(caught.value)


@pytest.mark.parametrize(
    ("found", "error", "reason"),
    [
        (
            ok({"angular": [[0, 0, 0]], "linear": [[0, 0]]}),
            AnswerError,
            "linear has the shape [1, 2]; give [1, 3]",
        ),
        (ok({"angular": [[0, 0, 0]], "linear": [[1], [2, 3]]}), AnswerError, "no array of numbers"),
        (
            ok({"angular": "fast", "linear": [[0, 0, 0]]}),
            AnswerError,
            "angular is the text 'fast'; give",
        ),
        (
            ok([1, 2]),
            AnswerError,
            "the answer to forward is a list; give an object with angular, linear",
        ),
        ({"outcome": "fine"}, AnswerError, "the outcome is 'fine'; give ok, unsupported or raised"),
        (
            ok({"angle": [[0, 0, 0]], "linear": [[0, 0, 0]]}),
            AnswerError,
            "'angle' is not a key of the answer to forward; its keys are angular, linear, and "
            "'angular' is missing",
        ),
        ({"outcome": "unsupported"}, UnsupportedError, "has no operation forward"),
        (
            {"outcome": "unsupported", "reason": ""},
            UnsupportedError,
            "the program refuses forward and gives no reason",
        ),
        ([1], AnswerError, "forward: the answer has no outcome"),
        ({"outcome": "raised", "reason": "no\n\x1b[1m air"}, ProgramError, "no [1m air"),
    ],
)
def test_answers_are_checked(
    tmp_path: Path, found: object, error: type[Exception], reason: str
) -> None:
    adapter = CommandAdapter(command_of(tmp_path, forward=found))
    with pytest.raises(error) as caught:
        OPERATIONS["forward"](adapter, {"states": vars(ONE[None])})
    assert reason in str(caught.value)


def test_null_stands_for_what_is_not_finite(tmp_path: Path) -> None:
    found = ok({"angular": [[None, 0, 1]], "linear": [[0, 0, 0]]})
    adapter = CommandAdapter(command_of(tmp_path, forward=found))
    answer = OPERATIONS["forward"](adapter, {"states": vars(ONE[None])})
    np.testing.assert_array_equal(answer.angular, [[np.nan, 0.0, 1.0]])


@pytest.mark.parametrize(
    ("found", "reason"),
    [
        (
            "hello, world\n",
            "is no frame: it begins with b'hello, w', where a header's length is due",
        ),
        (11, "ended by signal 11 (SIGSEGV)"),
        (9, "ended by signal 9 (SIGKILL)"),
    ],
)
def test_a_worker_ends_as_its_program_does(tmp_path: Path, found: object, reason: str) -> None:
    worker = WorkerProcess(target_of(command_of(tmp_path, load=found)), "physics", 20.0)
    assert worker.start().ok
    answer = worker.request("load", system=SYSTEM)
    assert answer.outcome == "crashed"
    assert reason in answer.reason


def test_names_of_programs() -> None:
    python = sys.executable
    named = adapters_named([f"{python} -u my_worker.py --fast", f"bolt={python} -u my_worker.py"])
    assert list(named) == ["my_worker", "bolt"]
    assert file_of(named["bolt"]) == Path("my_worker.py")
    assert [c.name for c in engine_choices([f"bolt={python} x.py"])] == ["bolt"]


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ("nosuchprogram worker.js", "there is no program nosuchprogram; install it"),
        ("node 'worker.js", "No closing quotation; correct the quotes."),
    ],
)
def test_programs_that_cannot_be_started(given: str, reason: str) -> None:
    with pytest.raises(UsageError, match=reason):
        target_of(given)


def test_a_file_with_a_space_in_its_name_is_no_program(tmp_path: Path) -> None:
    file = tmp_path / "my engine.py"
    file.write_text("class Toy: ...\n", encoding="utf-8")
    assert target_of(str(file)) == f"{file}:Toy"
    assert target_of(f"{file}:Toy") == f"{file}:Toy"


def test_engines_of_ones_own_have_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    lines = f'[adapters]\nbolt = "{sys.executable} -u bolt.py"\ntoy = "toy.py:Toy"\n'
    Path("omegadot.toml").write_text(lines, encoding="utf-8")
    Path("toy.py").write_text("class Toy: ...\n", encoding="utf-8")
    found = known_engines()
    assert found["bolt"] == f"command:{sys.executable} -u bolt.py"
    assert found["toy"] == "toy.py:Toy"
    assert [choice.target for choice in engine_choices(["toy"])] == ["toy.py:Toy"]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[adapter]\n", "omegadot.toml: key 'adapter' is unknown; write adapters."),
        ("adapters = 3\n", "omegadot.toml: adapters is no table"),
        ("[adapters]\ntoy = 3\n", "omegadot.toml: adapters.toy is 3, which is no text"),
        ('[adapters]\ntoy = " "\n', "omegadot.toml: adapters.toy is empty"),
        ('[adapters]\n"" = "toy.py:Toy"\n', "adapters names an engine '';"),
        ('[adapters]\n"a:b" = "toy.py:Toy"\n', "adapters names an engine 'a:b';"),
        ('[adapters]\n"../x" = "toy.py:Toy"\n', "adapters names an engine '../x';"),
        ('[adapters]\nMuJoCo = "toy.py:Toy"\n', "adapters.MuJoCo: there is an engine of this"),
        ("\ufeff\0", "omegadot.toml is not valid TOML"),
        ('[adapters]\nmujoco = "toy.py:Toy"\n', "adapters.mujoco: there is an engine of this name"),
        ('[adapters]\ntoy = "toy.py:Toy"\n', "adapters.toy: toy.py: no such adapter file"),
    ],
)
def test_a_wrong_omegadot_toml_is_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, reason: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("omegadot.toml").write_text(text, encoding="utf-8")
    with pytest.raises((UsageError, ScenarioError), match=reason):
        known_engines()


def test_an_omegadot_toml_that_leads_nowhere_is_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("omegadot.toml").symlink_to("nowhere")
    with pytest.raises(ScenarioError, match=r"omegadot\.toml is missing"):
        known_engines()


def test_an_entry_point_may_name_a_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "bolt_package.py").write_text("COMMAND = 'node bolt.js'\n", encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    point = EntryPoint("bolt", "bolt_package:COMMAND", registry.ENTRY_POINT_GROUP)
    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: [point])
    assert registry.factory_of(registry.registered()["bolt"]) == "node bolt.js"


def test_the_line_that_names_the_error_is_kept(tmp_path: Path) -> None:
    """Node.js writes a stack, an empty line and its version after it."""
    file = tmp_path / "worker.py"
    lines = ["Error: no such module", "    at a", "    at b", "", "Node.js v20.20.2"]
    file.write_text(f"import sys; sys.exit({chr(10).join(lines)!r})", encoding="utf-8")
    answer = WorkerProcess(target_of(f"{sys.executable} {file}"), "physics", 20.0).start()
    assert answer.outcome == "crashed"
    assert "Error: no such module" in answer.reason


def test_two_engines_of_one_name_are_refused(tmp_path: Path) -> None:
    for name in ("old", "new"):
        (tmp_path / f"{name}.py").write_text("class BoltAdapter: ...\n", encoding="utf-8")
    both = [f"{tmp_path / name}.py" for name in ("old", "new")]
    with pytest.raises(UsageError, match="two engines are called bolt"):
        adapters_named(both)
    assert list(adapters_named([both[0], both[0]])) == ["bolt"]


def test_a_class_that_a_file_has_not_is_wrong_usage(tmp_path: Path) -> None:
    file = tmp_path / "bolt.py"
    file.write_text("import math\nclass BoltAdapter: ...\n", encoding="utf-8")
    with pytest.raises(UsageError, match="there is no class Bolt; choose BoltAdapter"):
        target_of(f"{file}:Bolt")
    file.write_text("def made(): ...\nglobals()['Bolt'] = made\n", encoding="utf-8")
    assert target_of(f"{file}:Bolt") == f"{file}:Bolt"
