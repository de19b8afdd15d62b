"""An engine's own rounding of omega-dot, as it shows between states a few roundings apart.

What these tests catch: an engine that keeps the momentum, called wrong on a needle; a wrong
equation, or a term of fewer digits, that is taken for such rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from in_process import builtin, declared, truth_of

from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import evaluation_states_of, reported_rows
from omegadot.harness.drive import CaseResult
from omegadot.harness.in_process import driver_of
from omegadot.harness.judging.engine import held, shared_rows
from omegadot.harness.outcome import EngineCase
from omegadot.harness.requests.nudged import request_nudged, rounding_may_decide
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

Equation = Callable[[System, State], Array]
NEEDLE = builtin("thin-bar")


def by_momentum(system: System, states: State) -> Array:
    """omega from the momentum, by the inverse of the inertia; no torque acts."""
    tensor = moving_inertia(system)
    solve = np.linalg.inv(tensor)
    momentum = apply(tensor, states.angular_velocity)
    again = np.squeeze(solve @ momentum[..., None], -1)
    return np.asarray(np.squeeze(solve @ cross(momentum, again)[..., None], -1))


def near_inertia(system: System, states: State) -> Array:
    """One number of the tensor is off by three parts in 1e10, which a needle makes much of."""
    body = system.body
    tensor = np.array(body.inertia)
    tensor[2, 2] *= 1.0 + 3e-10
    return forward_dynamics(
        replace(system, bodies=(replace(body, inertia=tensor),)), states
    ).angular


def of_few_digits(system: System, states: State) -> Array:
    """The momentum in the gyroscopic term has 40 bits."""
    mantissa, exponent = np.frexp(apply(moving_inertia(system), states.angular_velocity))
    rounded = np.ldexp(np.round(2.0**40 * mantissa), exponent - 40)
    torque = cross(rounded, states.angular_velocity)
    return np.asarray(np.linalg.solve(moving_inertia(system), torque[..., None])[..., 0])


class Own(ReferenceAdapter):
    """The reference with another forward dynamics."""

    def __init__(self, equation: Equation) -> None:
        super().__init__()
        self.equation = equation

    def forward_dynamics(self, states: State) -> Acceleration:
        linear = super().forward_dynamics(states).linear
        return Acceleration(self.equation(self.system, states), linear)


def judged(equation: Equation) -> tuple[list[Row], list[Row]]:
    """The rows of omega-dot, before and after states a few roundings off are requested."""
    truth, adapter = truth_of(NEEDLE, ()), Own(equation)
    how = declared("own", None, 4)
    driver: Any = driver_of("toy", adapter, (how,))
    states = evaluation_states_of(NEEDLE, truth, 0)
    result: CaseResult = driver.evaluate_equations(NEEDLE, states)
    reported = equation(NEEDLE.system, states.path)

    def rows() -> list[Row]:
        found = shared_rows(NEEDLE, states, result)
        found += held(result, reported_rows(NEEDLE.system, states.path, reported))
        return [row for row in found if row.channel == "omega_dot"]

    before = rows()
    found = EngineCase(driver.engine, result, before, [])
    assert rounding_may_decide(NEEDLE, found)
    request_nudged(driver, NEEDLE, found, states)
    assert not rounding_may_decide(NEEDLE, found)
    return before, rows()


def verdicts(rows: list[Row]) -> set[str]:
    return {row.verdict for row in rows}


def test_an_engine_that_keeps_the_momentum_is_sound_on_a_needle() -> None:
    before, after = judged(by_momentum)
    assert "fail" in verdicts(before)
    assert verdicts(after) == {"pass"}
    assert len(after) == len(before)


@pytest.mark.parametrize("equation", [near_inertia, of_few_digits])
def test_what_is_the_same_a_few_roundings_off_is_no_rounding(equation: Equation) -> None:
    before, after = judged(equation)
    assert verdicts(before) == verdicts(after) == {"fail"}
