"""What is kept for a system is its alone: wrong where equal ids or arguments mix systems up."""

from __future__ import annotations

from omegadot.harness.random_cases import random_case
from omegadot.reference_impl.formed_once import MOST, formed_once
from omegadot.reference_impl.system import System


def test_it_is_formed_once_for_each_system_and_argument() -> None:
    calls: list[str] = []

    @formed_once
    def named(system: System, name: str = "none") -> tuple[float, str]:
        calls.append(name)
        return float(system.body.mass), name

    one, other = random_case(1, 0).system, random_case(1, 1).system
    assert named(one) is named(one)
    assert named(one, "a") == (float(one.body.mass), "a")
    assert named(one, name="b")[1] == "b"
    assert named(other) == (float(other.body.mass), "none")
    assert calls == ["none", "a", "b", "none"]


def test_systems_that_are_gone_leave_nothing_to_those_in_their_place() -> None:
    mass = formed_once(lambda system: float(system.body.mass))
    for index in range(3 * MOST):
        system = random_case(2, index).system
        assert mass(system) == float(system.body.mass)
        del system
