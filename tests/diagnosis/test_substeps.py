"""A load that acts in some substeps alone, as whole runs show it; and silence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from test_over_runs import CASES, euler, kept

from omegadot.diagnosis.stepping.loads.substeps import part_named, part_of, substep_cause
from omegadot.reference_impl.coordinates import from_coordinates
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

TORQUE = "the applied torque"


def cause(shares: Sequence[float]) -> str:
    """Of runs whose steps are substeps of semi-implicit Euler with these shares of the torque."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        for share in shares:
            torque = (share - 1.0) * applied_torque(
                system, from_coordinates(system, q, v, "com-world")
            )
            more = apply(inverse(moving_inertia(system)), torque)
            q, v = euler(motion, q, v, h / len(shares), more)
        return q, v

    runs = [kept(one, step, 0.02, 1) for one in CASES]
    loads = (run.system.load for run in runs)
    driven = [bool(np.any(one.torque_body) or np.any(one.torque_world)) for one in loads]
    runs = [replace(run, fails=fails) for run, fails in zip(runs, driven, strict=True)]
    part = part_of(sum(shares) / len(shares))
    assert part is not None
    return substep_cause(TORQUE, part, runs)


@pytest.mark.parametrize(
    ("shares", "where"),
    [
        ((1, 0, 0), "the first of three"),
        ((0, 1, 0), "the second of three"),
        ((0, 1, 1), "the last two of three"),
        ((0, 1), "the last of two"),
    ],
)
def test_the_substeps_in_which_a_load_acts_are_named(shares: Sequence[float], where: str) -> None:
    """Caught: a torque that is cleared after a substep, said to be scaled in every one."""
    assert cause(shares) == f"{TORQUE} acts in {where} substeps alone"


def test_a_part_of_a_load_in_every_substep_is_not_one_in_some() -> None:
    assert cause((1 / 3, 1 / 3, 1 / 3)) == ""


def test_steps_without_substeps_are_not_said_to_have_them() -> None:
    assert cause((0.25,)) == ""


def test_parts_of_a_step_are_named() -> None:
    parts = [part_of(k) for k in (0.333333, 0.375, 0.3, 1.0, 0.0)]
    assert parts == [Fraction(1, 3), Fraction(3, 8), None, None, None]
    assert [part_named(one) for one in parts if one] == ["a third", "3/8"]
