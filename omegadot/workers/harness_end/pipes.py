"""What flows between the harness and one worker, each stream on a thread of its own.

No stream can then block another, whatever the worker does: it may flood standard error, stop
reading its requests, write what is no answer, or leave children behind that hold its pipes open.

A worker's family is ended with it: whatever it started, even what left its process group. A child
that has made itself a session of its own is out of the group's reach; it is found by a mark in the
environment that it has inherited.
"""

from __future__ import annotations

import contextlib
import os
import queue
import signal
import subprocess
import threading
from dataclasses import dataclass
from typing import Any

import psutil

from omegadot.workers.wire import encode_frame, one_line, read_frame

STDERR_BYTES_KEPT = 4000
SECONDS_TO_DRAIN = 1.0
VARIABLE = "OMEGADOT_WORKER_MARKS"
# A family that starts new members while it is ended is searched again, so many times.
MOST_SEARCHES = 8


@dataclass(frozen=True)
class Lost:
    """There will be no more answers. how: why, where it is not for the process's death."""

    how: str = ""


class Pipes:
    """The streams of one process, from its start to its end. mark: what its family bears."""

    def __init__(self, process: subprocess.Popen[bytes], mark: str) -> None:
        self.process, self._mark = process, mark
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
        """The last three lines that an ended process wrote to standard error."""
        self._listener.join(SECONDS_TO_DRAIN)
        lines = self._tail.decode(errors="replace").strip().splitlines()[-3:]
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
                self.answers.put(read_frame(stream))  # type: ignore[arg-type]
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
        end_family(self.process, self._mark)
        self.process.wait()

    def _watch(self) -> None:
        """See the process's end even where a child of it still holds the pipe open."""
        self.process.wait()
        end_family(self.process, self._mark)
        self.close_requests()
        self._collector.join(SECONDS_TO_DRAIN)
        self.answers.put(Lost())


def marked(environment: dict[str, str], mark: str) -> dict[str, str]:
    """The environment with one more mark; a worker's own workers bear both."""
    return {**environment, VARIABLE: f"{environment.get(VARIABLE, '')}:{mark}"}


def end_family(process: subprocess.Popen[bytes], mark: str) -> None:
    """Kill the process, its group, and every process of this user that bears the mark."""
    with contextlib.suppress(OSError):
        if psutil.POSIX:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    for _ in range(MOST_SEARCHES):
        if not _kill_marked(mark):
            return


def _kill_marked(mark: str) -> int:
    """How many were killed; psutil kills none that has taken over the number of another."""
    killed = 0
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error, OSError):  # it has ended, or is another user's
            if mark in process.environ().get(VARIABLE, ""):
                process.kill()
                killed += 1
    return killed
