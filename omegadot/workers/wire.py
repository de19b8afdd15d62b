"""How a worker and the harness talk: one frame a message, a JSON header and raw arrays.

A frame is: 8 bytes, the header's length (big endian); the header, UTF-8 JSON, in which an array
stands as ``{"$array": i}``; then the arrays in order, as little-endian float64. Nothing is
pickled, so an old worker and a new harness understand each other. `frame_reader` reads them.
"""

from __future__ import annotations

import dataclasses
import json
import math
import struct
from typing import Any

import numpy as np

from omegadot.adapters.protocol import Description, Integrator
from omegadot.reference_impl.system import Array, Body, Load, System

MOST_CHARACTERS = 500
_SHORTENED = " ..."


def _pack(value: Any, arrays: list[Array]) -> Any:
    if value is None or type(value) in (str, int, bool):  # most of a description
        return value
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiub":
            raise TypeError(f"an array of {value.dtype.name} cannot be sent; give real numbers")
        arrays.append(np.array(value, dtype="<f8", order="C"))  # a scalar stays one
        return {"$array": len(arrays) - 1}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {f.name: getattr(value, f.name) for f in dataclasses.fields(value)}
        return {name: _pack(item, arrays) for name, item in fields.items()}
    if isinstance(value, dict):
        return {str(key): _pack(item, arrays) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_pack(item, arrays) for item in value]
    if isinstance(value, set | frozenset):
        return sorted(value)
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, float) and not math.isfinite(value):  # JSON has no such number
        return _pack(np.array(value), arrays)
    return value


def encode_frame(message: dict[str, Any]) -> bytes:
    """One message as a frame; arrays anywhere in it travel as raw float64.

    Raises TypeError where it holds what neither JSON nor an array of real numbers can.
    """
    arrays: list[Array] = []
    body = _pack(message, arrays)
    header = json.dumps(
        {"body": body, "shapes": [a.shape for a in arrays]}, allow_nan=False
    ).encode()
    return struct.pack(">Q", len(header)) + header + b"".join(a.tobytes() for a in arrays)


def system_from(message: dict[str, Any]) -> System:
    """The System that a packed one describes."""
    load = dict(message["load"])
    load["damping"] = np.asarray(load["damping"], dtype=float)
    bodies = tuple(body_from(body) for body in message["bodies"])
    return System(bodies=bodies, load=Load(**load))


def body_from(message: dict[str, Any]) -> Body:
    """The Body that a packed one describes."""
    return Body(**{key: np.asarray(value, dtype=float) for key, value in message.items()})


def description_of(message: dict[str, Any]) -> Description:
    """The Description that a packed one holds, every text of it one printable line."""
    message = {key: _printable(value) for key, value in message.items()}
    lists = {key: tuple(value) for key, value in message.items() if isinstance(value, list)}
    fields: dict[str, Any] = {**message, **lists}
    fields["integrators"] = tuple(Integrator(**item) for item in message["integrators"])
    fields["features"] = frozenset(message["features"])
    return Description(**fields)


def _printable(value: Any) -> Any:
    """The same, with texts at any depth made printable: they go to terminals as they are."""
    if isinstance(value, dict):
        return {key: _printable(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_printable(entry) for entry in value]
    return one_line(value, 8 * MOST_CHARACTERS) if isinstance(value, str) else value


def one_line(text: str, most: int = MOST_CHARACTERS) -> str:
    """An engine's text as one line of printable characters, cut where it is longer than `most`.

    Control characters, escape codes' first bytes and lone surrogates become spaces, so that the
    line can be written as UTF-8 and shown anywhere.
    """
    if len(text) <= most and text.isprintable() and text == " ".join(text.split()):
        return text
    start = text[: 8 * most]  # a message may be megabytes long
    line = " ".join("".join(c if c.isprintable() else " " for c in start).split())
    if len(line) <= most and len(start) == len(text):
        return line
    return line[: most - len(_SHORTENED)] + _SHORTENED
