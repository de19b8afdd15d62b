"""Reports of a program that leaves, stops in an answer, writes too much, or never flushes."""

import sys
from pathlib import Path

import numpy as np
import pytest
from programs import ONE, SYSTEM, command_of, framed, ok, started, with_arrays

from omegadot.harness.engine_target import target_of
from omegadot.reference_impl.system import Body, State
from omegadot.workers.engine_end import program_output
from omegadot.workers.engine_end.checked import AnswerError
from omegadot.workers.engine_end.command import CommandAdapter
from omegadot.workers.engine_end.program import NOT_FLUSHED, ProgramLostError
from omegadot.workers.harness_end import process
from omegadot.workers.harness_end.process import WorkerProcess
from omegadot.workers.wire import encode_frame

BODY = '{"mass": 1, "center_of_mass": [0, 0, 0], "inertia": {"$array": 0}}'


def test_a_program_that_leaves_in_peace_has_not_crashed_with_a_code_of_its_own(
    tmp_path: Path,
) -> None:
    """Caught: "ended with exit code 1" of a program that has called exit(0)."""
    worker = started(tmp_path, load=(b"", 0))
    answer = worker.request("load", system=SYSTEM)
    assert answer.outcome == "crashed"
    assert answer.reason == "the program left (exit code 0) before it answered load"
    assert worker.deaths == [answer.reason]
    assert not worker.started
    target = target_of(command_of(tmp_path, describe=(b"", 0)))
    answer = WorkerProcess(target, "physics", 20.0).start()
    assert answer.reason == "the program left (exit code 0) before it answered describe"
    target = target_of(command_of(tmp_path, describe=(b"", 7)))
    assert WorkerProcess(target, "physics", 20.0).start().reason == "ended with exit code 7"


def test_a_program_that_leaves_within_an_answer(tmp_path: Path) -> None:
    adapter = CommandAdapter(command_of(tmp_path, load=(framed("{}", b"")[:9], 0)))
    with pytest.raises(ProgramLostError, match="in its answer to load: its length promises a head"):
        adapter.load(SYSTEM)


def test_an_answer_that_breaks_off_is_not_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: the whole time limit, once a task."""
    monkeypatch.setattr(program_output, "SECONDS_TO_GO_ON", 0.1)
    answer = with_arrays(BODY, [[3, 3]], bytes(64))
    adapter = CommandAdapter(command_of(tmp_path, load=ok(None), model=(answer, None)))
    adapter.load(SYSTEM)
    with pytest.raises(ProgramLostError) as caught:
        adapter.model()
    assert "the answer to model broke off: its header promises 1 array of 72 bytes, 64 came" in str(
        caught.value
    )


def test_surplus_bytes_are_of_the_answer_before_them(tmp_path: Path) -> None:
    inertia = np.eye(3).tobytes()
    answer = with_arrays(BODY, [[3, 3]], inertia + bytes(8))
    command = command_of(tmp_path, load=ok(None), model=(answer, None), set_state=ok(None))
    adapter = CommandAdapter(command)
    adapter.load(SYSTEM)
    with pytest.raises(ProgramLostError, match=r"answer to model goes on with .* after its end"):
        (adapter.model(), adapter.set_state(ONE))


def test_what_is_no_frame_may_be_the_end_of_the_answer_before(tmp_path: Path) -> None:
    """Caught: the next request alone is named, where surplus bytes come late."""
    adapter = CommandAdapter(command_of(tmp_path, load=(bytes(8), None)))
    with pytest.raises(ProgramLostError) as caught:
        adapter.load(SYSTEM)
    assert "or the answer before it, to describe, wrote more than its shapes say" in str(
        caught.value
    )


def test_a_program_that_does_not_flush_is_told_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    notes: list[str] = []
    CommandAdapter(command_of(tmp_path), waiting=notes.append)
    assert notes == [NOT_FLUSHED]
    frame = encode_frame({"outcome": "waiting", "reason": NOT_FLUSHED})
    script = f"import os, time; os.write(1, {frame!r}); time.sleep(60)"
    command = [sys.executable, "-S", "-c", script]
    monkeypatch.setattr(process, "SECONDS_TO_START", 4.0)
    answer = WorkerProcess("command:none", "physics", 4.0, command).start()
    assert answer.outcome == "timeout"
    assert answer.reason == f"not started within 4 s; the worker was ended; {NOT_FLUSHED}"


def test_a_refusal_without_a_reason_is_no_missing_operation(tmp_path: Path) -> None:
    """`load` was answered before: the program has it."""
    command = command_of(tmp_path, load=ok(None))
    adapter = CommandAdapter(command)
    adapter.load(SYSTEM)
    with pytest.raises(Exception, match="the program refuses load and gives no reason"):
        adapter._program._result("load", {"outcome": "unsupported"})


def big_endian(*values: object) -> bytes:
    return b"".join(np.asarray(value, dtype=">f8").tobytes() for value in values)


def test_big_endian_arrays_are_named(tmp_path: Path) -> None:
    """Caught: "the mass is 3e-319 times what was requested"."""
    keys = [f'"{name}": {{"$array": {i}}}' for i, name in enumerate(vars(SYSTEM.body))]
    body = with_arrays(
        f"{{{', '.join(keys)}}}", [[], [3], [3, 3]], big_endian(1, [0] * 3, np.eye(3))
    )
    keys = [f'"{name}": {{"$array": {i}}}' for i, name in enumerate(vars(ONE))]
    zeros = ([0] * 3, [0] * 3, [0] * 3)
    state = with_arrays(
        f"{{{', '.join(keys)}}}", [[4], [3], [3], [3]], big_endian([1, 0, 0, 0], *zeros)
    )
    adapter = CommandAdapter(
        command_of(
            tmp_path,
            load=ok(None),
            model=(body, None),
            set_state=ok(None),
            get_state=(state, None),
        )
    )
    adapter.load(SYSTEM)
    adapter.set_state(ONE)
    for call, name in ((adapter.model, "model"), (adapter.get_state, "get_state")):
        with pytest.raises(AnswerError) as caught:
            call()
        assert str(caught.value) == (
            f"the arrays of the answer to {name} are big-endian; read and write them little-endian"
        )


def test_what_is_known_to_be_big_endian_is_not_taken_for_physics(tmp_path: Path) -> None:
    adapter = CommandAdapter(command_of(tmp_path, forward=ok({"angular": [], "linear": []})))
    given = SYSTEM.body
    found = Body(*(np.asarray(value).byteswap() for value in vars(given).values()))
    with pytest.raises(AnswerError, match="model are big-endian"):
        adapter._check_order("model", found, given)
    with pytest.raises(AnswerError, match="forward are big-endian"):
        adapter.forward_dynamics(ONE[None])


def test_a_wrong_body_is_for_the_gates_to_judge(tmp_path: Path) -> None:
    found = {"mass": 2, "center_of_mass": [0, 0, 0], "inertia": np.eye(3).tolist()}
    adapter = CommandAdapter(command_of(tmp_path, load=ok(None), model=ok(found)))
    adapter.load(SYSTEM)
    assert isinstance(adapter.model()[0], Body)
    assert adapter.model()[0].mass == 2.0


def test_a_state_of_another_shape_is_named_by_the_answer(tmp_path: Path) -> None:
    found = {name: [[0, 0, 0]] for name in vars(ONE)}
    adapter = CommandAdapter(command_of(tmp_path, get_state=ok(found)))
    with pytest.raises(AnswerError) as caught:
        adapter.get_state()
    sentence = "the answer to get_state: orientation has the shape [1, 3]; give [4]"
    assert str(caught.value) == sentence
    assert isinstance(ONE, State)
