"""Standard output and error of a command: any letter may be printed, and a reader may leave."""

from __future__ import annotations

import codecs
import io
import os
import sys
from typing import Any

ERRORS = "omegadot-bytes-as-typed"
PLAIN = {"–": "-", "×": "x"}  # what stands for a letter that a terminal does not have


def on_one_line(text: object) -> str:
    """A path or a sentence for a terminal: on one line, and what steers a terminal as an escape."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(text))


def _as_typed(error: UnicodeError) -> tuple[bytes, int]:
    """For a letter that the terminal does not have a question mark, for a byte that was typed and
    that is no letter there the same byte: a path that is printed can be copied.
    """
    assert isinstance(error, UnicodeEncodeError)
    found = error.object[error.start : error.end]
    plain = (ord(PLAIN.get(c, "?")) for c in found)
    codes = (ord(c) - 0xDC00 for c in found)  # from 0x80 on of a byte, see os.fsdecode
    pairs = zip(codes, plain, strict=True)
    return bytes(c if 0x80 <= c < 0x100 else other for c, other in pairs), error.end


codecs.register_error(ERRORS, _as_typed)


class _Output(io.FileIO):
    """A descriptor that takes everything once its reader has left, as of ``| head -1``.

    The command then goes on to its end, and its exit code is its verdict.
    """

    def write(self, data: Any, /) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            discard(self.fileno())
            return len(data)


def prepare_streams() -> None:
    """Make both such that no text and no reader can end the command."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # it was closed: nothing else may take its place
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif stream is getattr(sys, f"__{name}__") and isinstance(stream, io.TextIOWrapper):
            setattr(sys, name, _as_output(stream))
        elif isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=ERRORS)


def _as_output(stream: io.TextIOWrapper) -> io.TextIOWrapper:
    """The same stream; a pipe on Windows has no letter for omega."""
    stream.flush()
    return io.TextIOWrapper(
        io.BufferedWriter(_Output(stream.fileno(), "wb", closefd=False)),
        encoding=stream.encoding,
        errors=ERRORS,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )


def discard(descriptor: int) -> None:
    """Let nothing reach a descriptor any more, now and as Python ends."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, descriptor)
    os.close(null)
