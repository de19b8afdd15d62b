"""A run restarted: what rounding grows to is allowed, and no more.

What these tests catch: a bound without the growth of rounding, which would accuse sound engines,
and one that is not tightened where nothing grows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from omegadot.adapters.protocol import Integrator
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.gates.case import Sweep
from omegadot.gates.rows import Row
from omegadot.gates.steps.restart import refused, restart_of, row
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.scheme import every_channel
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

ONE_STEP = Integrator("own", None, every_channel(4))
SEVERAL = replace(ONE_STEP, one_step=False)


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    pool = Pool(5)
    return pool.prepare(pool.having({"asymmetric", "torque-free"}, 1)[0])


def start(prepared: Prepared) -> tuple[Sweep, State, int, State]:
    case, sweep = prepared.case, prepared.case.sweeps[0]
    how = (SCHEMES["lie-rk4"], case.system, case.initial)
    state = step_body(*how, sweep.timestep, sweep.steps, sweep.every)[1]
    found = restart_of(sweep)
    assert found is not None
    sample = found[0]
    return sweep, state, sample, State(*(values[sample:] for values in vars(state).values()))


def reported(prepared: Prepared, off: float, integrator: Integrator = ONE_STEP) -> Row:
    """What is reported where omega's last sample is off by so many rad/s."""
    sweep, state, sample, restarted = start(prepared)
    w = restarted.angular_velocity.copy()
    w[-1, 0] += off
    moved = replace(restarted, angular_velocity=w)
    return row(prepared.truth, integrator, sweep, state, sample, moved)


def bounds(prepared: Prepared) -> tuple[float, float]:
    """Of the last omega in rad/s: twice the round-off bound, as it is and with its growth."""
    sweep, state, _, _ = start(prepared)
    yardstick = prepared.truth.yardstick.of_momentum()
    growth = growth_along(yardstick.system, sweep.times, state, yardstick.rate)
    plain, grown = (
        2.0 * yardstick.round_off(sweep.timestep, sweep.sample_steps, g)["omega"][-1]
        for g in (np.ones(len(sweep.times)), growth)
    )
    return plain * yardstick.rate, grown * yardstick.rate


def test_growth_is_allowed_for_and_nothing_beyond(prepared: Prepared) -> None:
    plain, grown = bounds(prepared)
    assert grown > 2.0 * plain
    assert (reported(prepared, 0.0).value, reported(prepared, 0.0).verdict) == (0.0, "pass")
    near = reported(prepared, 0.5 * plain)
    assert near.verdict == "pass"
    assert near.value == pytest.approx(0.5, rel=0.1)  # of the bound without any growth
    assert reported(prepared, np.sqrt(plain * grown)).verdict == "pass"
    far = reported(prepared, 2.0 * grown)
    assert (far.verdict, far.channel, far.bound) == ("fail", "omega", 1.0)
    assert "steps depend on the past (declared by one_step=False)" in far.note


def test_a_method_of_several_steps_is_not_accused(prepared: Prepared) -> None:
    far = reported(prepared, 2.0 * bounds(prepared)[1], SEVERAL)
    assert (far.verdict, far.note) == ("info", "steps use earlier ones, as is declared")


def test_a_run_that_is_refused_is_beyond_every_bound() -> None:
    found = refused("not from here")
    assert (found.value, found.bound, found.verdict) == (float("inf"), 1.0, "fail")


def test_a_thin_body_at_a_long_step_is_not_judged(
    prepared: Prepared, monkeypatch: pytest.MonkeyPatch
) -> None:
    """``|J omega| / lambda`` of 3 times its rate, at steps of a third of a radian and of less."""
    yardstick = prepared.truth.yardstick
    assert not yardstick.is_stiff(1e3)  # no body that is not thin is stiff
    monkeypatch.setattr(yardstick, "_momentum", 3.0)
    assert yardstick.is_stiff(0.34 / yardstick.rate)
    assert not yardstick.is_stiff(0.33 / yardstick.rate)
