"""What is no frame is named by what is wrong with it."""

import io
import struct

import pytest
from programs import framed

from omegadot.workers.frame_reader import NoFrameError, read_frame

BODY = '{"body": 1, "shapes": []}'


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        (framed(BODY, order="<"), "little-endian, .* for 25; write it big-endian"),
        (b"step 1\n" + framed(BODY), "it begins with .*, where a header's length is due"),
        (struct.pack("<d", 0.0) + b"rest", "its header of 0 bytes, b'', is no JSON in UTF-8"),
        (framed("{'body'"), "Expecting property name .* at 1"),
        (b"\0\0\0\0\0\0\0\1\xff", "'utf-8' codec can't decode"),
    ],
)
def test_what_does_not_begin_as_a_frame(given: bytes, reason: str) -> None:
    with pytest.raises(NoFrameError, match=reason):
        read_frame(io.BytesIO(given))


@pytest.mark.parametrize(
    ("header", "reason"),
    [
        ('{"body": 1}', r"its header lacks 'shapes' \(an empty list where there are no arrays\)"),
        ('{"shapes": []}', "its header lacks 'body'"),
        ("[]", "its header is no object"),
        ('{"body": 1, "shapes": 3}', "its 'shapes' is no list"),
        ('{"body": 1, "shapes": [3]}', "its shapes have 3; give a list of whole numbers"),
        ('{"body": 1, "shapes": [[-1]]}', r"its shapes have \[-1\]; give a list of whole"),
        ('{"body": 1, "shapes": [[0]]}', "its shapes are of 1 arrays, and its body names 0 of"),
        ('{"body": {"$array": 1}, "shapes": [[0]]}', "names the array 1, and its shapes are of 1,"),
        ('{"body": {"$array": "a"}, "shapes": []}', "names the array 'a'"),
    ],
)
def test_headers_that_hold_no_message(header: str, reason: str) -> None:
    """Caught: bare errors of Python, as "'shapes'", and arrays that are read and then dropped."""
    with pytest.raises(ValueError, match=reason) as caught:
        read_frame(io.BytesIO(framed(header)))
    assert not isinstance(caught.value, NoFrameError)


def test_what_is_due_is_told_where_a_frame_is_cut() -> None:
    header = '{"body": [{"$array": 0}, {"$array": 1}], "shapes": [[3], [2, 5]]}'
    for frame, reason in (
        (framed(header, bytes(80)), "its header promises 2 arrays of 104 bytes, 80 came"),
        (framed(header)[:20], "its length promises a header of 65 bytes, 12 came"),
        (b"\0\0", "a header's length has 8 bytes, 2 came"),
    ):
        with pytest.raises(EOFError, match=reason):
            read_frame(io.BytesIO(frame))
