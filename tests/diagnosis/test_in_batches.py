"""What is wrong in some batches of states alone is named with these batches."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, case, gyroscopic, with_torque

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import (
    FORWARD,
    INVERSE,
    Evidence,
    of_forward_dynamics,
    of_inverse_dynamics,
)
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.wrong_equation import equation_causes
from omegadot.diagnosis.experiments.in_batches import InBatches
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.reported.requests import ONE_ALONE
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_acceleration, random_states
from omegadot.harness.drive import Driver
from omegadot.reference_impl.motion import inverse_dynamics
from omegadot.reference_impl.system import Acceleration, Array, State, System
from omegadot.workers.harness_end.process import Answer

EVERY = (
    case("free", {}),
    case("top", {"gravity": GRAVITY, "pivot": PIVOT}),
    case("driven", {"torque": BODY_TORQUE, "damping": 0.2}, 1.3),
)
MISSING = "the gyroscopic term is missing"
TOGETHER = "that are requested together"
COUNT = 60
Where = Callable[[Array, int], Any]  # of places among n


class Toy:
    """A driver whose engine loses its gyroscopic term at these places of a batch."""

    def __init__(self, where: Where) -> None:
        self.where, self.requests = where, 0

    def _lost(self, count: int) -> Array:
        lost = np.broadcast_to(self.where(np.arange(count), count), count)
        return lost.astype(float)[:, None]

    def forward(self, system: System, states: State) -> Acceleration:
        lost = self._lost(len(states.position))
        return with_torque(system, states, lost * gyroscopic(system, states))

    def inverse(self, system: System, states: State, requested: Acceleration) -> Array:
        lost = self._lost(len(states.position))
        return np.asarray(
            inverse_dynamics(system, states, requested) - lost * gyroscopic(system, states)
        )

    def request(self, one: Case, operation: str, states: State, **more: Any) -> Answer:
        self.requests += 1
        if operation == "forward":
            return Answer("ok", result=vars(self.forward(one.system, states)))
        return Answer("ok", result={"torque": self.inverse(one.system, states, **_of(more))})


def _of(more: dict[str, Any]) -> dict[str, Any]:
    return {"requested": more["acceleration"]}


def over(toy: Toy) -> Across:
    across = Across()
    for one in EVERY:
        x = random_states(one, COUNT, [1])
        a = random_acceleration(one.system, x, [2])
        known: dict[str, Evidence] = {
            FORWARD: of_forward_dynamics(one.system, x, toy.forward(one.system, x)),
            INVERSE: of_inverse_dynamics(one.system, x, a, toy.inverse(one.system, x, a)),
        }
        across.add(Scene(one.name, one.system, features_of(one.system, one.initial), known))
    return across


def named(where: Where, torque: bool = False, text: str = "") -> tuple[str, bool, Toy]:
    """The cause on the first scenario, as it is named with its batches."""
    toy = Toy(where)
    across = over(toy)
    found = across.of_torque("free") if torque else equation_causes(across, "free", FORWARD)
    text = text or "; ".join(found) or ONE_ALONE
    batches = InBatches({one.name: one for one in EVERY}, across.scenes)
    with np.errstate(all="ignore"):
        if batches.wants(text, torque):
            batches.ask(Requests(cast(Driver, toy)), "free", text, torque)
        return *batches.of("free", text, torque), toy


WHERE: dict[str, tuple[Where, str]] = {
    "above": (lambda k, n: n > 10, "more than 10 states are requested together"),
    "above many": (lambda k, n: n > 37, "more than 37 states are requested together"),
    "several": (lambda k, n: n > 1, "several states are requested together"),
    "up to": (lambda k, n: n <= 6, "6 states or fewer are requested together"),
    "alone": (lambda k, n: n == 1, "a state is requested by itself"),
    "between": (lambda k, n: 4 <= n <= 20, "4 to 20 states are requested together"),
    "even": (lambda k, n: n % 2 == 0, "an even number of states are requested together"),
    "odd": (lambda k, n: n % 2 == 1, "an odd number of states are requested together"),
    "but the first": (lambda k, n: k > 0, f"a state is not the first of those {TOGETHER}"),
    "but the last": (lambda k, n: k < n - 1, f"a state is not the last of those {TOGETHER}"),
    "the last": (lambda k, n: k == n - 1, f"a state is the last of those {TOGETHER}"),
    "the last of several": (
        lambda k, n: (k == n - 1) & (n > 1),
        f"a state is the last of several {TOGETHER}",
    ),
    "from a place on": (
        lambda k, n: k >= 16,
        f"a state is not one of the first 16 of those {TOGETHER}",
    ),
    "left over": (
        lambda k, n: k >= n - n % 8,
        f"a state is left over of those {TOGETHER}, taken 8 at a time",
    ),
    "every third": (lambda k, n: k % 3 == 1, f"a state is number 2 of each 3 {TOGETHER}"),
}


@pytest.mark.parametrize("name", WHERE)
def test_what_some_batches_have_is_named_with_them(name: str) -> None:
    """Caught: "not always", and what is right of a few states for what is right of all."""
    where, condition = WHERE[name]
    text, decides, _ = named(where)
    assert decides
    assert text == f"{MISSING}, but only where {condition}"


@pytest.mark.parametrize("name", ["above many", "up to"])
def test_inverse_dynamics_have_batches_as_well(name: str) -> None:
    where, condition = WHERE[name]
    text, decides, _ = named(where, torque=True)
    assert decides
    assert text == f"inverse dynamics leave out the gyroscopic term, but only where {condition}"


def test_what_every_batch_has_takes_few_requests() -> None:
    text, decides, toy = named(lambda k, n: True)
    assert (text, decides) == (MISSING, False)
    assert toy.requests <= 6


def test_a_cause_of_other_states_in_the_batch_is_not_tried() -> None:
    text = "states have the omega-dot of other states that are requested together with them"
    found, decides, toy = named(lambda k, n: True, text=text)
    assert (found, decides, toy.requests) == (text, False, 0)


def test_batches_in_no_known_way_are_not_named() -> None:
    """At sizes that no rule has."""
    odd = {3, 12, 16, 17, 24, 33, COUNT}
    text, decides, _ = named(lambda k, n: n in odd)
    assert (text, decides) == (MISSING, False)
