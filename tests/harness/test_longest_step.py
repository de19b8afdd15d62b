"""An engine that splits what is longer than a step of its own into equal steps is sound."""

from __future__ import annotations

from math import ceil

import numpy as np
import pytest

import omegadot
from omegadot.adapters.protocol import Description, Integrator, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State

LONGEST = 6e-4  # s


class SplitAdapter(ReferenceAdapter):
    """Semi-implicit Euler in as few equal steps as are no longer than LONGEST; it declares none."""

    lost = 0.0  # of omega, in a step that is requested

    @property
    def description(self) -> Description:
        own = super().description
        orders = SCHEMES["semi-implicit-euler"].orders
        return Description(
            "split", "1", (Integrator("euler", None, orders),), features=own.features
        )

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        parts = ceil(timestep / LONGEST * (1.0 - 1e-12))
        how = (timestep / parts, steps * parts, every * parts)
        found = super().run(initial, "semi-implicit-euler", *how)
        if not self.lost:
            return Trajectory(found.time, found.state)
        kept = 1.0 - self.lost * np.arange(len(found.time))[:, None] * every
        spoiled = State(
            **{**vars(found.state), "angular_velocity": kept * found.state.angular_velocity}
        )
        return Trajectory(found.time, spoiled)


class SplitAndDampedAdapter(SplitAdapter):
    lost = 1e-6


@pytest.mark.parametrize(
    ("engine", "sound"), [(SplitAdapter, True), (SplitAndDampedAdapter, False)]
)
def test_it_is_run_until_its_steps_are_the_requested_ones(
    engine: type[SplitAdapter], sound: bool
) -> None:
    """Caught: an order of 0.2, of steps that several requested ones have in common.

    The other engine loses a part of omega in each step, however short it is.
    """
    found = omegadot.check(engine, scenarios="free-bar", shrink=False)
    assert found.passed is sound
