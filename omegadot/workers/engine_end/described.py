"""An adapter's description, held to the protocol's types before it leaves the worker.

A record holds every field of it: what passes here can be written there.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from inspect import signature
from typing import Any, get_args

import numpy as np

from omegadot.adapters.protocol import (
    FEATURES,
    Adapter,
    Description,
    Format,
    Integrator,
    Knob,
)
from omegadot.reference_impl.coordinates import COORDINATES
from omegadot.reference_impl.flight.schemes import FLIGHT_SCHEMES
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.workers.engine_end.checked import AnswerError, expect, numbers
from omegadot.workers.wire import one_line
from omegadot.written import written

FORMATS = get_args(Format)
# Those in which an integrator has an order; others of `Channel` are of gates without steps.
CHANNELS = ("omega", "attitude", "energy", "angular_momentum", "linear_momentum", "position")
KNOBS = get_args(Knob)
LISTS = (
    *("integrators", "conventions", "switched_off", "links", "features", "importers"),
    "settings",
)
# In parts of eps, the finest relative tolerance that a rounded estimate of an error can keep.
ROUNDINGS_OF_AN_ESTIMATE = 450
# Half the step divides an error by 2^p: of a higher order no two steps show it above rounding.
HIGHEST_ORDER = sys.float_info.mant_dig


def checked_description(found: Any) -> Description:
    """A description whose fields are of the annotated types."""
    if not isinstance(found, Description):
        raise AnswerError(f"description is of type {type(found).__name__}; answer with Description")
    for name in ("name", "version", "licence"):
        expect(f"description.{name}", getattr(found, name), str)
    for name in LISTS:
        if not isinstance(getattr(found, name), tuple | list | set | frozenset):
            kind = type(getattr(found, name)).__name__
            raise AnswerError(f"description.{name} is of type {kind}; answer with a tuple")
    if found.precision not in ("float64", "float32"):
        raise AnswerError(f"description.precision is {found.precision!r}; write float64 or float32")
    for name in LISTS[1:]:
        for item in getattr(found, name):
            expect(f"an item of description.{name}", item, str)
    for name, known in (("features", FEATURES), ("importers", FORMATS)):
        for item in getattr(found, name):
            if item not in known:
                raise AnswerError(
                    f"description.{name} names {item!r}; give one of {', '.join(known)}"
                )
    for setting in found.settings:
        if not setting or one_line(setting) != setting or list(found.settings).count(setting) > 1:
            raise AnswerError(
                f"description.settings names {setting!r}; give short names of one line, each once"
            )
    for integrator in found.integrators:
        expect("an item of description.integrators", integrator, Integrator)
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
    expect("an integrator's name", integrator.name, str)
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
        expect(f"the scheme of {integrator.name}", integrator.scheme, str)
        if integrator.scheme not in SCHEMES:
            scored = integrator.scheme in FLIGHT_SCHEMES
            known = "it is known to omegadot score only; declare None" if scored else "give None"
            raise AnswerError(
                f"the scheme of {integrator.name} is {integrator.scheme!r}, which the reference "
                f"lacks; {known} (scheme = None, in JSON null) for a scheme that is not listed, or "
                f"one of {', '.join(SCHEMES)}"
            )
    if integrator.coordinates not in COORDINATES:
        raise AnswerError(
            f"the coordinates of {integrator.name} are {integrator.coordinates!r}; "
            f"give one of {', '.join(COORDINATES)}"
        )
    _check_scheme_is_held(integrator)
    expect(f"the note of {integrator.name}", integrator.note, str)
    expect(f"one_step of {integrator.name}", integrator.one_step, bool)
    expect(f"the orders of {integrator.name}", integrator.orders, dict)
    for channel, order in integrator.orders.items():
        if channel not in CHANNELS:
            known = ", ".join(CHANNELS)
            raise AnswerError(
                f"the orders of {integrator.name} name {channel!r}; give one of {known}"
            )
        if order is not None:
            _check_order(f"the order of {integrator.name} in {channel}", order)


def _check_scheme_is_held(integrator: Integrator) -> None:
    """A scheme that the reference cannot step as declared would be held against nothing."""
    if integrator.scheme is None:
        return
    if integrator.knob != "timestep":
        raise AnswerError(
            f"{integrator.name} declares the scheme {integrator.scheme} and the knob "
            f"{integrator.knob}; the steps of an error-controlled integrator are no scheme's: give "
            "the scheme None"
        )
    known = SCHEMES[integrator.scheme].coordinates
    if integrator.coordinates not in known:
        raise AnswerError(
            f"{integrator.name} declares the scheme {integrator.scheme} in the coordinates "
            f"{integrator.coordinates}, in which the reference does not step it; give one of "
            f"{', '.join(known)}, or the scheme None"
        )


def _check_order(what: str, order: Any) -> None:
    expect(what, order, int)
    if isinstance(order, bool) or not 1 <= order <= HIGHEST_ORDER:
        # a whole number may have more digits than Python writes
        found = order if isinstance(order, bool) or abs(order) < 10**6 else "of many digits"
        raise AnswerError(
            f"{what} is {found}; give a whole number from 1 to {HIGHEST_ORDER}, or None (in JSON "
            "null) where the channel is conserved"
        )
