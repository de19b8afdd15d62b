"""The same system with one thing changed, loaded after it: nothing may be kept from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TypeVar

import numpy as np

from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states import equation
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness.drive import CaseResult, Driver
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, System

Part = TypeVar("Part", Body, Load)
MORE = 1.5
SLIGHTLY_MORE = 1.0 + 5e-6  # within what numbers are often taken for equal
STATES = 8  # at which each is evaluated
METRIC = "residual_of_sibling"
NOTE = "after the same system with another {} was loaded"


def siblings_of(case: Case) -> Iterator[tuple[str, Case]]:
    """By what is changed, the case with it; at first all of its numbers are, slightly.

    What an engine keeps by anything else, it then takes for this one: all other things are the
    same, and so are the size of a vector and the principal moments.
    """
    for what, system in _changed(case.system):
        name = f"{case.name}-with-another-{what}"
        scenario = case.scenario.model_copy(update={"name": name})
        yield what, replace(case, scenario=scenario, system=system)


def _changed(system: System) -> Iterator[tuple[str, System]]:
    body, load = system.body, system.load
    yield "scale", replace(system, bodies=(_scaled(body),), load=_scaled(load))
    yield "mass", replace(system, bodies=(replace(body, mass=np.asarray(MORE * body.mass)),))
    turned = _turned(_turned(body.inertia).T).T
    if np.any(turned != body.inertia):
        yield "inertia", replace(system, bodies=(replace(body, inertia=turned),))
    if load.pivot is not None and np.any(body.center_of_mass):
        moved = replace(body, center_of_mass=_turned(body.center_of_mass))
        yield "center_of_mass", replace(system, bodies=(moved,))
    if np.any(load.damping):
        yield "damping", replace(system, load=replace(load, damping=MORE * load.damping))
    for what in ("pivot", "gravity", "torque_body", "torque_world"):
        vector = getattr(load, what)
        if vector is not None and np.any(vector):
            yield what, replace(system, load=replace(load, **{what: _turned(vector)}))


def _scaled(part: Part) -> Part:
    """Every number of a body or a load, slightly larger."""
    numbers = {k: v for k, v in vars(part).items() if v is not None}
    return replace(part, **{k: SLIGHTLY_MORE * v for k, v in numbers.items()})


def _turned(values: Array) -> Array:
    """Components, or rows, under the next axis."""
    return np.roll(values, 1, axis=0)


def request_siblings(
    driver: Driver, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> None:
    """Forward dynamics of each, loaded after the case, into `result`; once for all integrators."""
    if result.siblings or "forward_dynamics" not in driver.engine.description.features:
        return
    for what, other in siblings_of(case):
        states = place_on_pivot(other.system, evaluation_states.random[:STATES])
        answer = driver.request(other, "forward", states=states)
        result.before[what] = driver.before
        result.siblings[what] = (other.system, states, answer)


def rows_of_siblings(result: CaseResult, eps: float) -> list[Row]:
    """The rows of these answers: of the equation, with what had been changed in their notes."""
    rows = list[Row]()
    for what, (system, states, answer) in result.siblings.items():
        if answer.ok:
            found = equation.forward_rows(
                system, states, Acceleration(**answer.result), METRIC, eps
            )
            rows += [replace(row, note=NOTE.format(what.replace("_", " "))) for row in found]
    return rows
