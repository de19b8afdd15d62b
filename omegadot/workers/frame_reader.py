"""Frames as they are read, see `wire`; what is no frame is named by what is wrong with it."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from omegadot.reference_impl.system import Array

# Text that gets into the channel looks like a header of 10^18 bytes.
LONGEST_HEADER = 2**30
_SHOWN = 16


class Stream(Protocol):
    """What frames are read from."""

    def read(self, count: int, /) -> bytes:
        """So many bytes; fewer where no more will come."""
        ...


class NoFrameError(ValueError):
    """What comes does not begin as a frame does: it may be the end of the frame before it."""


def read_frame(stream: Stream) -> dict[str, Any]:
    """Read one message.

    Raises EOFError when no more bytes come, with those that were due where a part has come;
    NoFrameError and ValueError where what comes is no frame.
    """
    header = _header(stream)
    shapes = header["shapes"]
    sizes = [8 * math.prod(shape) for shape in shapes]
    arrays: list[Array] = []
    came = 0
    for shape, size in zip(shapes, sizes, strict=True):
        data = stream.read(size)
        came += len(data)
        if len(data) != size:
            due = f"{len(sizes)} array{'s' if len(sizes) > 1 else ''} of {sum(sizes)} bytes"
            raise EOFError(f"its header promises {due}, {came} came")
        arrays.append(np.frombuffer(data, dtype="<f8").reshape(shape).copy())
    named: set[int] = set()
    unpacked: dict[str, Any] = _unpack(header["body"], arrays, named)
    if len(named) < len(arrays):
        raise ValueError(
            f"its shapes are of {len(arrays)} arrays, and its body names {len(named)} of them as "
            '{"$array": ...}'
        )
    return unpacked


def _header(stream: Stream) -> dict[str, Any]:
    length = _length(stream)
    text = stream.read(length)
    if len(text) != length:
        raise EOFError(f"its length promises a header of {length} bytes, {len(text)} came")
    try:
        header = json.loads(text.decode())
    except (ValueError, RecursionError) as error:
        why = f"{error.msg} at {error.pos}" if isinstance(error, json.JSONDecodeError) else error
        raise NoFrameError(
            f"its header of {length} bytes, {text[:_SHOWN]!r}{' ...' * (length > _SHOWN)}, is no "
            f"JSON in UTF-8 ({why})"
        ) from None
    if not isinstance(header, dict):
        raise ValueError('its header is no object; write {"body": ..., "shapes": [...]}')
    for key, what in (("body", ""), ("shapes", " (an empty list where there are no arrays)")):
        if key not in header:
            raise ValueError(f"its header lacks {key!r}{what}")
    _check_shapes(header["shapes"])
    return header


def _length(stream: Stream) -> int:
    """The header's length. Raises NoFrameError where the 8 bytes are no plausible one."""
    start = stream.read(8)
    if len(start) != 8:
        raise EOFError(f"a header's length has 8 bytes, {len(start)} came" if start else "")
    length, reverse = int.from_bytes(start, "big"), int.from_bytes(start, "little")
    if length <= LONGEST_HEADER:
        return length
    if reverse <= LONGEST_HEADER:
        raise NoFrameError(
            f"the length of its header is little-endian, {start!r} for {reverse}; write it "
            "big-endian"
        )
    raise NoFrameError(
        f"it begins with {start!r}, where a header's length is due; standard output is for "
        "answers alone, print to standard error"
    )


def _check_shapes(shapes: Any) -> None:
    if not isinstance(shapes, list):
        raise ValueError("its 'shapes' is no list; list the shape of each array")
    for shape in shapes:
        sizes = shape if isinstance(shape, list) else [None]
        if not all(type(size) is int and size >= 0 for size in sizes):
            raise ValueError(f"its shapes have {shape!r}; give a list of whole numbers for each")


def _unpack(value: Any, arrays: Sequence[Array], named: set[int]) -> Any:
    """A body with its arrays. named: takes the numbers of those that stand in it."""
    if isinstance(value, dict):
        if "$array" in value:
            number = value["$array"]
            if type(number) is not int or not 0 <= number < len(arrays):
                raise ValueError(
                    f"its body names the array {number!r}, and its shapes are of {len(arrays)}, "
                    "counted from 0"
                )
            named.add(number)
            return arrays[number]
        return {key: _unpack(item, arrays, named) for key, item in value.items()}
    if isinstance(value, list):
        return [_unpack(item, arrays, named) for item in value]
    return value
