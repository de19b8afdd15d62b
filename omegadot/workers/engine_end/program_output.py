"""What a program writes to its standard output, waited for no longer than an answer may pause."""

from __future__ import annotations

import os
import select
from typing import IO

SECONDS_TO_GO_ON = 5.0
"""An answer that has begun and of which no byte has come for so long has broken off."""
_MOST, _SHOWN = 1 << 20, 64


class ProgramOutput:
    """The bytes of a pipe, none of which is read before it is due.

    stalled: whether an answer has broken off, though the program lives. Where the system cannot
    wait for a pipe, as Windows cannot, none is found to, and no surplus either.
    """

    def __init__(self, pipe: IO[bytes]) -> None:
        self._pipe, self._number = pipe, pipe.fileno()
        self._poll = select.poll() if os.name == "posix" else None
        if self._poll is not None:
            self._poll.register(self._number, select.POLLIN)
        self._begun = self.stalled = False

    def expect_answer(self) -> None:
        """Wait for the first byte of the next answer as long as it takes."""
        self._begun = False

    def read(self, count: int, /) -> bytes:
        """So many bytes; fewer where the program has closed the pipe, or the answer broken off."""
        found = bytearray()
        while len(found) < count and self._goes_on():
            part = os.read(self._number, min(count - len(found), _MOST))
            if not part:
                break
            found += part
            self._begun = True
        return bytes(found)

    def surplus(self) -> bytes:
        """The first bytes that are there already, where none is due."""
        there = self._poll is not None and bool(self._poll.poll(0))
        return os.read(self._number, _SHOWN) if there else b""

    def _goes_on(self) -> bool:
        if self._poll is not None and self._begun:
            self.stalled = not self._poll.poll(1000.0 * SECONDS_TO_GO_ON)
        return not self.stalled
