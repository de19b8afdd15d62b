"""What flows between the harness and one worker, each stream on a thread of its own.

No stream can then block another, whatever the worker does: it may flood standard error, stop
reading its requests, write what is no answer, or leave children behind that hold its pipes open.
A worker's family is ended with it.
"""

from __future__ import annotations

import contextlib
import queue
import subprocess
import threading
from dataclasses import dataclass
from typing import Any

from omegadot.workers.frame_reader import read_frame
from omegadot.workers.harness_end.family import GUARD, ask_to_end, end_family
from omegadot.workers.wire import encode_frame, one_line

STDERR_BYTES_KEPT = 4000
SECONDS_TO_DRAIN = 1.0


@dataclass(frozen=True)
class Lost:
    """There will be no more answers. how: why, where it is not for the process's death."""

    how: str = ""


class Pipes:
    """The streams of one process, from its start to its end. mark: what its family bears.

    ended_here: whether it lived until the harness ended it, which is no death.
    """

    def __init__(self, process: subprocess.Popen[bytes], mark: str) -> None:
        self.process, self._mark = process, mark
        self.ended_here = False
        self._tail = b""
        self._requests: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        self.answers: queue.Queue[dict[str, Any] | Lost] = queue.Queue()
        self._start(self._feed)
        self._collector = self._start(self._collect)
        self._listener = self._start(self._listen)
        self._start(self._watch)

    @staticmethod
    def _start(call: Any) -> threading.Thread:
        thread = threading.Thread(target=call, daemon=True)
        thread.start()
        return thread

    def send(self, message: dict[str, Any]) -> None:
        """Have a request written, as soon as the worker reads it."""
        self._requests.put(encode_frame(message))

    def close_requests(self) -> None:
        """End the requests: the worker sees the end of its input."""
        self._requests.put(None)

    def last_output(self) -> str:
        """Three lines of what an ended process wrote last to standard error: the last, with the
        last that names an error.
        """
        self._listener.join(SECONDS_TO_DRAIN)
        written = self._tail.decode(errors="replace").strip().splitlines()
        lines, named = written[-3:], [line for line in written[:-3] if "Error" in line]
        if named and not any("Error" in line for line in lines):
            lines = [named[-1], *lines[-2:]]  # Node.js writes its version after it
        return one_line(" | ".join(line.strip() for line in lines), 400)

    def _feed(self) -> None:
        stream = self.process.stdin
        assert stream is not None
        with contextlib.suppress(OSError, ValueError):  # a dead worker reads nothing more
            while (frame := self._requests.get()) is not None:
                stream.write(frame)
                stream.flush()
        with contextlib.suppress(OSError, ValueError):
            stream.close()

    def _collect(self) -> None:
        """Move answers from the pipe to the queue; what is no answer ends it."""
        stream = self.process.stdout
        assert stream is not None
        try:
            while True:
                self.answers.put(read_frame(stream))
        except (EOFError, OSError):
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.process.wait(SECONDS_TO_DRAIN)
                return  # it died, which `_watch` reports when all answers are in
            self.answers.put(Lost("it closed the channel of its answers"))
        except Exception as error:  # garbage can fail to be read in many ways
            self.answers.put(Lost(f"its answer cannot be read: {one_line(str(error), 100)}"))

    def _listen(self) -> None:
        """Keep the last lines of standard error and drop the rest, however much comes."""
        stream = self.process.stderr
        assert stream is not None
        with contextlib.suppress(OSError, ValueError):
            while chunk := stream.read1(1 << 16):  # type: ignore[attr-defined]
                self._tail = (self._tail + chunk)[-STDERR_BYTES_KEPT:]

    def end(self) -> None:
        """End the process and everything it started, at once."""
        ask_to_end(self.process)
        end_family(self.process.pid, self._mark)
        self.process.wait()

    def _watch(self) -> None:
        """See the process's end even where a child of it still holds the pipe open."""
        self.process.wait()
        end_family(self.process.pid, self._mark)
        GUARD.forget(self.process.pid)
        self.close_requests()
        self._collector.join(SECONDS_TO_DRAIN)
        self.answers.put(Lost())
