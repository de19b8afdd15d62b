"""One engine in a process of its own: ``python -m ...engine_end.worker TARGET [SETUP [VIA]]``.

Reads requests from what was its standard input and answers on what was its standard output;
whatever the engine prints goes to standard error instead, so a chatty engine cannot garble an
answer. A request that raises, whatever it raises, is answered with the exception; the process goes
on. After running out of memory it states so and leaves, for what is left of it cannot be relied on.
"""

from __future__ import annotations

import contextlib
import os
import sys
import threading
import time
import traceback
from collections.abc import Callable
from functools import partial
from typing import Any, BinaryIO, cast

from omegadot.adapters.protocol import Adapter, Setup, UnsupportedError
from omegadot.adapters.registry import OURS, AdapterError, build_adapter
from omegadot.reference_impl.solutions.representable import UnrepresentableError
from omegadot.workers.engine_end.checked import AnswerError
from omegadot.workers.engine_end.command import CommandAdapter
from omegadot.workers.engine_end.described import description_of
from omegadot.workers.engine_end.keeper import keep_family
from omegadot.workers.engine_end.memory import MEMORY_VARIABLE, limit_memory
from omegadot.workers.engine_end.operations import OPERATIONS
from omegadot.workers.engine_end.program import ProgramError, ProgramLostError, end_with_parent
from omegadot.workers.frame_reader import read_frame
from omegadot.workers.wire import encode_frame, one_line
from omegadot.written import written

NO_REASON = "the adapter states no reason; give UnsupportedError a sentence that does"
_SECONDS_TO_LOOK = 0.5
# Given back when memory runs out, so that there is some to report it.
_reserve = [bytearray(1 << 22)]


def _text_of(error: BaseException) -> str:
    try:
        return str(error)
    except Exception:  # an exception that cannot even state what it is
        return "it cannot be printed"


def failure(error: BaseException) -> dict[str, Any]:
    """The answer that reports an exception, with its type and the line that raised it."""
    traceback.clear_frames(error.__traceback__)  # what they hold may be all the memory there is
    texts = one_line(_text_of(error))
    if isinstance(error, UnsupportedError):
        return {"outcome": "unsupported", "reason": texts or NO_REASON}
    if isinstance(
        error, AnswerError | ProgramError | UnrepresentableError
    ):  # it states all, and no line of ours helps
        return {"outcome": "raised", "reason": texts}
    frames = traceback.extract_tb(error.__traceback__)
    # Of an import that fails the line that imports, not Python's own machinery.
    last = [frame for frame in frames if not frame.filename.startswith("<frozen ")][-1:]
    where = f" ({os.path.basename(last[0].filename)}:{last[0].lineno})" if last else ""
    reason = f"{type(error).__name__}: {texts}".rstrip(": ") + where
    limit = os.environ.get(MEMORY_VARIABLE)
    if isinstance(error, MemoryError) and limit:
        size = written(int(limit) / 2**30, 3)
        reason += f"; the limit is {size} GiB, omegadot run --memory sets another"
    return {"outcome": "raised", "reason": one_line(reason)}


def answered(call: Callable[[], Any]) -> tuple[bytes, bool]:
    """The frame that answers with what `call` returns or raises, and whether to go on after it."""
    started = time.perf_counter()
    try:
        result = call()
        seconds = time.perf_counter() - started
        return encode_frame({"outcome": "ok", "result": result, "seconds": seconds}), True
    except MemoryError as error:
        _reserve.clear()
        return encode_frame({**failure(error), "leaves": True}), False
    except ProgramLostError as error:
        return encode_frame(_lost(error)), False
    except BaseException as error:
        return encode_frame(failure(error)), True


def _lost(error: ProgramLostError) -> dict[str, Any]:
    return {"outcome": "crashed", "reason": one_line(_text_of(error)), "leaves": True}


def _built(target: str, setup: Setup, via: str, answers: BinaryIO) -> tuple[Adapter | None, bytes]:
    """The adapter, with the frame that holds its description; None where it cannot be built."""

    def waiting(what: str) -> None:
        answers.write(encode_frame({"outcome": "waiting", "reason": what}))
        answers.flush()

    try:
        adapter = build_adapter(target, setup, via, partial(CommandAdapter, waiting=waiting))
    except (AdapterError, ImportError) as error:
        missing = {"outcome": "not-installed", "reason": one_line(_text_of(error))}
        return None, encode_frame(missing)
    except ProgramLostError as error:
        return None, encode_frame(_lost(error))
    except BaseException as error:
        return None, encode_frame(failure(error))
    frame, _ = answered(lambda: description_of(adapter))
    return adapter, frame


def serve(target: str, setup: Setup, via: str, requests: BinaryIO, answers: BinaryIO) -> None:
    """Answer requests until the harness closes the channel."""
    own = os.getpid()
    adapter, frame = _built(target, setup, via, answers)
    going_on = True
    while True:
        if os.getpid() != own:  # a child that the engine forked; the channel is its parent's
            os._exit(0)
        answers.write(frame)
        answers.flush()
        if adapter is None or not going_on:
            return
        try:
            request = read_frame(requests)
        except EOFError:
            return
        operation = partial(OPERATIONS[request["operation"]], adapter, request)
        frame, going_on = answered(operation)


def _private_channels() -> tuple[BinaryIO, BinaryIO]:
    """Keep standard input and output for the harness; the engine gets nothing to read and prints
    to standard error.
    """
    requests, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return requests, answers


def _end_with_harness() -> None:
    """Have this process killed when its parent ends, however busy it is and however that ends.

    Where the system does not do so, a thread looks for a new parent, as long as the engine lets
    other threads run.
    """
    if not end_with_parent() and os.name == "posix":
        threading.Thread(target=_watch, args=(os.getppid(),), daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_SECONDS_TO_LOOK)
    os._exit(0)


def main() -> None:
    """Serve the adapter that the command line names.

    The module of an engine of one's own may stand in the current folder, which comes last.
    """
    keep_family()
    _end_with_harness()
    if sys.argv[1] not in OURS.values():
        with contextlib.suppress(FileNotFoundError):  # a folder that was removed holds no module
            sys.path.append(os.getcwd())
    setup = cast(Setup, sys.argv[2] if len(sys.argv) > 2 else "physics")
    memory = os.environ.get(MEMORY_VARIABLE)
    if memory:
        limit_memory(int(memory))
    via = sys.argv[3] if len(sys.argv) > 3 else ""
    serve(sys.argv[1], setup, via, *_private_channels())


if __name__ == "__main__":
    main()
