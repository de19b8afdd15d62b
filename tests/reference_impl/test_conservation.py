"""The midpoint rule keeps a free body's energy and momentum to round-off; others do not."""

from __future__ import annotations

import numpy as np
import pytest
from reference_cases import EPS, rows, start, system, turned

from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body

STEPS = 500


@pytest.mark.parametrize(
    "moments", [(1.0, 2.0, 2.5), (1.0, 1.0, 1.8), (2.0, 2.0, 2.0), (1e-6, 1.0, 1.0)]
)
@pytest.mark.parametrize("dt", [0.001, 0.05])
def test_midpoint_keeps_energy_and_momentum(moments: tuple[float, ...], dt: float) -> None:
    on = system(turned(moments))
    initial = start([1.0, 2.0, -1.5], [1, 2, 3, 4])
    _, states = step_body(SCHEMES["implicit-midpoint"], on, initial, dt, STEPS, 50)
    energy, momentum = total_energy(on, states), angular_momentum(on, states)
    # A step rounds the attitude and I ω, some sixteen times each. ω̇ is only known to eps times
    # the condition number, which Newton's iteration leaves in every step: h |ω̇| of it in ω, and
    # through I in the momentum undiminished for the large moments.
    condition = max(moments) / min(moments)
    step = (16 + dt * np.linalg.norm(initial.angular_velocity) * condition) * EPS
    assert np.max(np.abs(energy / energy[0] - 1)) <= STEPS * step
    drift = np.linalg.norm(momentum - momentum[0], axis=-1) / np.linalg.norm(momentum[0])
    assert np.max(drift) <= STEPS * step


@pytest.mark.parametrize("name", sorted(set(SCHEMES) - {"implicit-midpoint"}))
def test_other_schemes_drift(name: str) -> None:
    # else the test above would prove nothing about the midpoint rule
    on, initial = system([1.0, 2.0, 2.5]), start([1.0, 2.0, -1.5])
    step = 0.05 if SCHEMES[name].orders["attitude"] < 6 else 0.1
    _, states = step_body(SCHEMES[name], on, initial, step, STEPS, STEPS)
    momentum = angular_momentum(on, states)
    assert np.linalg.norm(momentum[-1] - momentum[0]) > 1e4 * STEPS * EPS


def test_midpoint_that_does_not_settle_is_not_a_number() -> None:
    on = system([1.0, 2.0, 2.5], pivot=(0, 0, -1), gravity=(0, 0, -9.81))
    initial = start([[100.0, 200.0, -150.0], [1.0, 2.0, -1.5]], [[1, 0, 0, 0], [1, 0, 0, 0]])
    _, states = step_body(SCHEMES["implicit-midpoint"], on, initial, np.array([9.0, 0.01]), 3, 1)
    assert np.all(np.isnan(rows(states, (-1, 0)).angular_velocity))
    assert np.all(np.isfinite(rows(states, (-1, 1)).angular_velocity))
