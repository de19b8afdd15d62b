"""An adapter's answers, held to the protocol's types and shapes before they leave the worker."""

from __future__ import annotations

from dataclasses import replace
from inspect import signature
from typing import Any, TypeVar, get_args

import numpy as np

from omegadot.adapters.protocol import (
    Adapter,
    Channel,
    Description,
    Format,
    Integrator,
    Knob,
    Trajectory,
)
from omegadot.reference_impl.coordinates import COORDINATES
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Acceleration, Array, Body, State
from omegadot.workers.wire import one_line
from omegadot.written import written

Shape = tuple[int, ...]
Arrays = TypeVar("Arrays", bound=State | Acceleration | Body)
_V: Shape = (3,)
SHAPES: dict[type, dict[str, Shape]] = {
    State: {"orientation": (4,), "angular_velocity": _V, "position": _V, "linear_velocity": _V},
    Acceleration: {"angular": _V, "linear": _V},
    Body: {"mass": (), "center_of_mass": _V, "inertia": (3, 3)},
}
CHANNELS, FORMATS = get_args(Channel), get_args(Format)
KNOBS = get_args(Knob)
# In parts of eps, the finest relative tolerance that a rounded estimate of an error can keep.
ROUNDINGS_OF_AN_ESTIMATE = 450


class AnswerError(TypeError):
    """An adapter's answer is not what the protocol requires; the message states what and where."""


def _expect(what: str, value: Any, kind: type) -> None:
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
    _expect(what, value, kind)
    fields = {
        name: numbers(f"{what}.{name}", getattr(value, name), (*lead, *shape))
        for name, shape in SHAPES[kind].items()
    }
    return kind(**fields)


def checked_trajectory(trajectory: Any) -> Trajectory:
    """A trajectory with as many states as times; how many there should be is a gate's to judge."""
    _expect("run()", trajectory, Trajectory)
    count = np.size(trajectory.time)
    time = numbers("run().time", trajectory.time, (max(1, count),))
    state = checked("run().state", trajectory.state, State, (count,))
    return Trajectory(time, state, trajectory.seconds)


def checked_seconds(seconds: Any, whole: float) -> float:
    """What a run's steps took, in s: as the adapter measured it, or else the whole call."""
    if seconds is None:
        return whole
    found = float(numbers("run().seconds", seconds, ()))
    if not 0.0 <= found <= whole:
        raise AnswerError(
            f"run().seconds is {written(found)}; give a part of the {written(whole)} s that the "
            "call took"
        )
    return found


def checked_bodies(bodies: Any, count: int) -> tuple[Body, ...]:
    """As many bodies as were loaded, each with its mass, centre of mass and inertia."""
    _expect("model()", bodies, tuple)
    if len(bodies) != count:
        raise AnswerError(f"model() has {len(bodies)} bodies; answer with {count}")
    for body in bodies:
        _expect("a body of model()", body, Body)
    return tuple(checked("model()", body, Body, ()) for body in bodies)


def checked_native(found: Any) -> dict[str, dict[str, str]]:
    """Conventions and defaults, both names with texts."""
    for part in ("conventions", "defaults"):
        _expect("native()", found, dict)
        _expect(f"native()[{part!r}]", found.get(part), dict)
        for name, value in found[part].items():
            _expect(f"a name of native()[{part!r}]", name, str)
            _expect(f"native()[{part!r}][{name!r}]", value, str)
    return {part: dict(found[part]) for part in ("conventions", "defaults")}


def checked_description(found: Any) -> Description:
    """A description whose fields are of the annotated types."""
    if not isinstance(found, Description):
        raise AnswerError(f"description is of type {type(found).__name__}; answer with Description")
    for name in ("name", "version", "licence"):
        _expect(f"description.{name}", getattr(found, name), str)
    if found.precision not in ("float64", "float32"):
        raise AnswerError(f"description.precision is {found.precision!r}; write float64 or float32")
    for name in ("conventions", "switched_off", "links", "features", "importers"):
        for item in getattr(found, name):
            _expect(f"an item of description.{name}", item, str)
    for item in found.importers:
        if item not in FORMATS:
            known = ", ".join(FORMATS)
            raise AnswerError(f"description.importers names {item!r}; give one of {known}")
    for integrator in found.integrators:
        _expect("an item of description.integrators", integrator, Integrator)
        _check_integrator(integrator)
    names = [integrator.name for integrator in found.integrators]
    if len(set(names)) < len(names):
        raise AnswerError(f"description.integrators has a name twice, of {', '.join(names)}")
    return found


def _takes_accuracy(adapter: Adapter) -> bool:
    """Whether `run` has a parameter of this name, or any."""
    parameters = signature(adapter.run).parameters
    return "accuracy" in parameters or any(p.kind is p.VAR_KEYWORD for p in parameters.values())


def description_of(adapter: Adapter) -> Description:
    """The adapter's description. Accuracies that `run` does not take are fixed ones, and none is
    finer than single precision allows an estimate of the error.
    """
    found = checked_description(adapter.description)
    if all(integrator.knob == "timestep" for integrator in found.integrators):
        return found
    takes, least = _takes_accuracy(adapter), 0.0
    if found.precision == "float32":
        least = ROUNDINGS_OF_AN_ESTIMATE * float(np.finfo(np.float32).eps)

    def own(integrator: Integrator) -> Integrator:
        if integrator.knob != "accuracy":
            return integrator
        if not takes:
            return replace(integrator, knob="fixed-accuracy")
        return replace(integrator, finest_accuracy=max(least, integrator.finest_accuracy))

    return replace(found, integrators=tuple(map(own, found.integrators)))


def _check_integrator(integrator: Integrator) -> None:
    _expect("an integrator's name", integrator.name, str)
    if not integrator.name or one_line(integrator.name) != integrator.name:
        raise AnswerError(
            f"an integrator's name is {integrator.name!r}; give one short line that can be printed"
        )
    if integrator.knob not in KNOBS:
        raise AnswerError(
            f"the knob of {integrator.name} is {integrator.knob!r}; give one of {', '.join(KNOBS)}"
        )
    finest = numbers(f"the finest accuracy of {integrator.name}", integrator.finest_accuracy, ())
    if not 0.0 <= finest < 1.0:
        raise AnswerError(
            f"the finest accuracy of {integrator.name} is {written(finest)}; give a number from "
            "0 to 1"
        )
    if integrator.scheme is not None:
        _expect(f"the scheme of {integrator.name}", integrator.scheme, str)
        if integrator.scheme not in SCHEMES:
            raise AnswerError(
                f"the scheme of {integrator.name} is {integrator.scheme!r}, which the reference "
                f"lacks; give None for a scheme of your own, or one of {', '.join(SCHEMES)}"
            )
    if integrator.coordinates not in COORDINATES:
        raise AnswerError(
            f"the coordinates of {integrator.name} are {integrator.coordinates!r}; "
            f"give one of {', '.join(COORDINATES)}"
        )
    for channel, order in integrator.orders.items():
        if channel not in CHANNELS:
            known = ", ".join(CHANNELS)
            raise AnswerError(
                f"the orders of {integrator.name} name {channel!r}; give one of {known}"
            )
        if order is not None:
            _expect(f"the order of {integrator.name} in {channel}", order, int)
            if order < 1:
                raise AnswerError(
                    f"the order of {integrator.name} in {channel} is {order}; give a whole number "
                    "above zero, or None where the channel is conserved"
                )
