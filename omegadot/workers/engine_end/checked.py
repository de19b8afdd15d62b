"""An adapter's answers, held to the protocol's types and shapes before they leave the worker."""

from __future__ import annotations

import time
from typing import Any, TypeVar

import numpy as np

from omegadot.adapters.protocol import Trajectory
from omegadot.reference_impl.system import Acceleration, Array, Body, State
from omegadot.written import written

Shape = tuple[int, ...]
Arrays = TypeVar("Arrays", bound=State | Acceleration | Body)
_V: Shape = (3,)
SHAPES: dict[type, dict[str, Shape]] = {
    State: {"orientation": (4,), "angular_velocity": _V, "position": _V, "linear_velocity": _V},
    Acceleration: {"angular": _V, "linear": _V},
    Body: {"mass": (), "center_of_mass": _V, "inertia": (3, 3)},
}
TICK = time.get_clock_info("perf_counter").resolution  # s


class AnswerError(TypeError):
    """An adapter's answer is not what the protocol requires; the message states what and where."""


def expect(what: str, value: Any, kind: type) -> None:
    """Raise AnswerError where the value is not of this type."""
    if not isinstance(value, kind):
        name = type(value).__name__
        raise AnswerError(f"{what} is of type {name}; answer with a {kind.__name__}")


def numbers(what: str, value: Any, shape: Shape) -> Array:
    """The value as an array of this shape. Raises AnswerError where it is no such thing."""
    try:
        array = np.asarray(value)
    except ValueError as error:  # rows of different lengths
        raise AnswerError(f"{what} is no array: {error}") from error
    if array.dtype.kind not in "fiu":
        kind = type(value).__name__ if array.shape == () else f"an array of {array.dtype.name}"
        raise AnswerError(f"{what} is {kind}; answer with an array of real numbers")
    if array.shape != shape:
        raise AnswerError(f"{what} has the shape {array.shape}; answer with {shape}")
    return array.astype(float, copy=False)


def checked(what: str, value: Any, kind: type[Arrays], lead: Shape) -> Arrays:
    """A state, an acceleration or a body whose arrays have the leading axes `lead`."""
    expect(what, value, kind)
    fields = {
        name: numbers(f"{what}.{name}", getattr(value, name), (*lead, *shape))
        for name, shape in SHAPES[kind].items()
    }
    return kind(**fields)


def checked_trajectory(trajectory: Any) -> Trajectory:
    """A trajectory with as many states as times; how many there should be is a gate's to judge."""
    expect("run()", trajectory, Trajectory)
    count = np.size(trajectory.time)
    time = numbers("run().time", trajectory.time, (max(1, count),))
    state = checked("run().state", trajectory.state, State, (count,))
    return Trajectory(time, state, trajectory.seconds)


def checked_seconds(seconds: Any, whole: float, what: str = "run().seconds") -> float:
    """What a run's steps took, in s: as the adapter measured it, or else the whole call.

    Less than a tick is nothing measured: a coarser clock has not moved. It is a tick at least.
    """
    if seconds is None:
        return max(whole, TICK)
    found = float(numbers(what, seconds, ()))
    if not 0.0 <= found <= whole:
        raise AnswerError(
            f"{what} is {written(found)}; give a part of the {written(whole)} s that the call took"
        )
    return found if found >= TICK else max(whole, TICK)


def checked_bodies(bodies: Any, count: int) -> tuple[Body, ...]:
    """As many bodies as were loaded, each with its mass, centre of mass and inertia."""
    expect("model()", bodies, tuple)
    if len(bodies) != count:
        raise AnswerError(f"model() has {len(bodies)} bodies; answer with {count}")
    for body in bodies:
        expect("a body of model()", body, Body)
    return tuple(checked("model()", body, Body, ()) for body in bodies)


def checked_native(found: Any) -> dict[str, dict[str, str]]:
    """Conventions and defaults, both names with texts."""
    for part in ("conventions", "defaults"):
        expect("native()", found, dict)
        expect(f"native()[{part!r}]", found.get(part), dict)
        for name, value in found[part].items():
            expect(f"a name of native()[{part!r}]", name, str)
            expect(f"native()[{part!r}][{name!r}]", value, str)
    return {part: dict(found[part]) for part in ("conventions", "defaults")}
