"""A program without NumPy that answers with what it finds in a table of its own."""

import json
import shlex
import struct
import sys
from pathlib import Path

import numpy as np

from omegadot.harness.engine_target import target_of
from omegadot.reference_impl.system import Body, State, System
from omegadot.workers.harness_end.process import WorkerProcess

PROGRAM = """\
import json, os, signal, struct, sys
ANSWERS = {answers!r}
while True:
    length = sys.stdin.buffer.read(8)
    if len(length) < 8: break
    header = json.loads(sys.stdin.buffer.read(struct.unpack(">Q", length)[0]))
    for shape in header["shapes"]:
        count = 1
        for n in shape: count *= n
        sys.stdin.buffer.read(8 * count)
    answer = ANSWERS[header["body"]["operation"]]
    if isinstance(answer, int): os.kill(os.getpid(), answer)
    written, code = answer if isinstance(answer, tuple) else (b"", None)
    if not isinstance(answer, tuple):
        text = json.dumps({{"body": answer, "shapes": []}}).encode()
        written = struct.pack(">Q", len(text)) + text
    if isinstance(answer, str): written = answer.encode()
    sys.stdout.buffer.write(written)
    if code != "unflushed": sys.stdout.buffer.flush()
    if isinstance(code, int): os._exit(code)
"""
EULER = {"name": "euler", "scheme": None, "orders": {}}
TOY = {"name": "toy", "version": "1", "integrators": [EULER], "features": ["forward_dynamics"]}
SYSTEM = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),))
ONE = State(np.array([1.0, 0, 0, 0]), np.zeros(3), np.zeros(3), np.zeros(3))


def ok(result: object) -> dict[str, object]:
    return {"outcome": "ok", "result": result}


def command_of(folder: Path, **answers: object) -> str:
    """A program with these answers, which describes itself as TOY unless they do."""
    file = folder / "program.py"
    file.write_text(PROGRAM.format(answers={"describe": ok(TOY), **answers}), encoding="utf-8")
    return shlex.join([sys.executable, "-S", str(file)])


def framed(text: str, arrays: bytes = b"", order: str = ">") -> bytes:
    """A header and what comes after it. order: of the bytes of its length."""
    return struct.pack(f"{order}Q", len(text.encode())) + text.encode() + arrays


def with_arrays(result: str, shapes: list[list[int]], arrays: bytes) -> bytes:
    """An answer that is well, with its result in JSON."""
    return framed(
        f'{{"body": {{"outcome": "ok", "result": {result}}}, "shapes": {json.dumps(shapes)}}}',
        arrays,
    )


def started(folder: Path, timeout: float = 20.0, **answers: object) -> WorkerProcess:
    """A worker that serves the program with these answers."""
    worker = WorkerProcess(target_of(command_of(folder, **answers)), "physics", timeout)
    assert worker.start().ok
    return worker
