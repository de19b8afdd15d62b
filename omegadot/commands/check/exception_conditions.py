"""On which bodies and motions a declared exception holds: limits of a few quantities.

``when = { moments_product_below = 1.2e-7 }``: a quantity of `QUANTITIES` with ``_below`` or
``_above``, and a limit in SI units. An exception with several holds where all of them do.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.from_scenario import system_of
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.scenarios import Scenario


def _moments(scenario: Scenario) -> np.ndarray:
    """Principal moments about the centre of mass, kg m^2. Shape (3,), the smallest first."""
    return np.linalg.eigvalsh(system_of(scenario).body.inertia)


def _torque(scenario: Scenario) -> float:
    return sum(math.hypot(*torque.value) for torque in scenario.load.torque)


def _lever(scenario: Scenario) -> float:
    pivoted = scenario.load.pivot is not None
    return math.hypot(*lever(system_of(scenario))) if pivoted else 0.0


def _decay(scenario: Scenario) -> float:
    """``d T / J``, J the largest moment: omega is slowed by e to this, or more, in the run."""
    largest = float(np.linalg.eigvalsh(moving_inertia(system_of(scenario)))[-1])
    return scenario.load.damping * scenario.run.duration / largest


QUANTITIES: dict[str, Callable[[Scenario], float]] = {
    "moments_product": lambda scenario: float(np.prod(_moments(scenario))),
    "moments_ratio": lambda scenario: float(_moments(scenario)[-1] / _moments(scenario)[0]),
    "angular_velocity": lambda scenario: math.hypot(*scenario.initial.angular_velocity),
    "speed": lambda scenario: math.hypot(*scenario.initial.linear_velocity),
    "torque": _torque,
    "lever": _lever,
    "decay": _decay,
}
"""kg^3 m^6; largest over smallest; rad/s and m/s of the centre of mass, both at the start; N m,
of the applied torques; m, from the pivot to the centre of mass, and 0 without a pivot; 1.
"""
KEYS = tuple(f"{quantity}_{side}" for quantity in QUANTITIES for side in ("below", "above"))


@dataclass(frozen=True)
class Condition:
    """A limit of a quantity. key: of `KEYS`, such as ``speed_below``."""

    key: str
    limit: float

    def holds(self, scenario: Scenario) -> bool:
        """Whether the quantity is beyond the limit. One that equals it is not."""
        quantity, _, side = self.key.rpartition("_")
        value = QUANTITIES[quantity](scenario)
        return value < self.limit if side == "below" else value > self.limit


def read_conditions(table: object, where: str) -> tuple[Condition, ...]:
    """The conditions of a table ``when``. Raises UsageError, which begins with `where`."""
    example = "give it as a table of limits, such as {moments_product_below = 1.2e-7}"
    if not isinstance(table, dict) or not table:
        raise UsageError(f"{where}: when is {table!r}; {example}.")
    found = []
    for key, limit in table.items():
        if key not in KEYS:
            raise UsageError(f"{where}: when: unknown key {key!r}; {nearest(key, KEYS)}.")
        number = isinstance(limit, int | float) and not isinstance(limit, bool)
        if not number or not abs(limit) <= sys.float_info.max:
            shown = repr(limit)[:40]
            raise UsageError(f"{where}: when: {key} is {shown}; give a number in SI units.")
        found.append(Condition(key, float(limit)))
    return tuple(found)


def all_hold(conditions: Sequence[Condition], scenario: Scenario) -> bool:
    """Whether every condition holds of a scenario."""
    return all(condition.holds(scenario) for condition in conditions)
