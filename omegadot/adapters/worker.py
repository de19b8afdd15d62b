"""One engine in a process of its own: ``python -m omegadot.adapters.worker TARGET [SETUP]``.

Reads requests from standard input and answers on what was its standard output; whatever the
engine prints goes to standard error instead, so a chatty engine cannot garble an answer. A request
that raises is answered with the exception; the process goes on.
"""

from __future__ import annotations

import os
import sys
import time
import traceback
from typing import Any, BinaryIO, cast

from omegadot.adapters.operations import OPERATIONS
from omegadot.adapters.protocol import Setup, UnsupportedError
from omegadot.adapters.registry import build_adapter
from omegadot.adapters.wire import read_frame, write_frame


def _failure(error: BaseException) -> dict[str, Any]:
    last = traceback.extract_tb(error.__traceback__)[-1:]
    where = f" ({os.path.basename(last[0].filename)}:{last[0].lineno})" if last else ""
    kind = "unsupported" if isinstance(error, UnsupportedError) else "raised"
    text = str(error) if kind == "unsupported" else f"{type(error).__name__}: {error}{where}"
    return {"outcome": kind, "reason": " ".join(text.split())[:500]}


def _private_channel() -> BinaryIO:
    """Keep standard output for answers and send everything printed to standard error."""
    channel = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return channel


def serve(target: str, setup: Setup, requests: BinaryIO, answers: BinaryIO) -> None:
    """Answer requests until the harness closes the channel."""
    try:
        adapter = build_adapter(target, setup)
    except ImportError as error:
        write_frame(answers, {"outcome": "not-installed", "reason": str(error)})
        return
    except Exception as error:
        write_frame(answers, _failure(error))
        return
    write_frame(answers, {"outcome": "ok", "result": adapter.description})
    while True:
        try:
            request = read_frame(requests)
        except EOFError:
            return
        started = time.perf_counter()
        try:
            result = OPERATIONS[request["operation"]](adapter, request)
            answer = {"outcome": "ok", "result": result}
        except Exception as error:
            answer = _failure(error)
        answer["seconds"] = time.perf_counter() - started
        write_frame(answers, answer)


def main() -> None:
    """Serve the adapter that the command line names."""
    setup = cast(Setup, sys.argv[2] if len(sys.argv) > 2 else "physics")
    serve(sys.argv[1], setup, sys.stdin.buffer, _private_channel())


if __name__ == "__main__":
    main()
