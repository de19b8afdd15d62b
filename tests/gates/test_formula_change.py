"""A turn at which a scheme changes its formula: rounding decides there, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from in_process import builtin, judged, truth_of

from omegadot.adapters.protocol import Integrator, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.gates.bounds.opened import opened_by_scheme
from omegadot.gates.case import Case, Sweep
from omegadot.gates.rows import Row
from omegadot.gates.steps.scheme import OPENED
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.schemes.short_turns_euler import SHORT
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State

NAME = "semi-implicit-euler-short-turns"
JUMP = SHORT**3 / 6


def spinning(turn: float) -> Case:
    """A sphere that turns by so much, in rad, in each of a thousand steps."""
    case, step = builtin("sphere"), 1e-3
    omega = turn / step * np.array([0.0, 0.0, 1.0])
    steps = (Sweep(4.0 * step, 250, 25), Sweep(2.0 * step, 500, 50), Sweep(step, 1000, 100))
    return replace(case, initial=replace(case.initial, angular_velocity=omega), sweeps=steps)


class Turning(ReferenceAdapter):
    """Semi-implicit Euler that turns about z by some rad more than the exponential at short turns.

    share: of the steps in which it does so.
    """

    def __init__(self, more: float, share: float) -> None:
        super().__init__()
        self.more, self.share = more, share

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        chance = np.random.default_rng(1)

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            q, v = SCHEMES["semi-implicit-euler"].step(motion, q, v, h)
            short = abs(h * v[..., -1]) < 1.5 * SHORT and chance.random() < self.share
            more = np.zeros_like(v)
            more[..., -1] = self.more * short
            return motion.retract(q, more), v

        own = Scheme("own", "", step, SCHEMES[NAME].orders)
        return Trajectory(*step_body(own, self.system, initial, timestep, steps, every))


def finest(turn: float, more: float, share: float, steps: str = "") -> Row:
    """The match of the finest step. steps: a scheme of the reference that is stepped instead."""
    case = spinning(turn)
    integrator = Integrator(NAME, NAME, dict(SCHEMES[NAME].orders))
    adapter = None if steps else Turning(more, share)
    runs = judged(case, truth_of(case, (NAME,)), integrator, adapter, steps)
    coarse, middle, fine = (row for run in runs for row in run.rows if row.metric == "match")
    assert (coarse.verdict, middle.verdict) == ("pass", "pass")
    assert OPENED not in coarse.note
    return fine


def test_either_formula_passes_where_rounding_decides() -> None:
    """Caught: an engine accused at 1 rad/s and steps of 1 ms, whichever formula it takes."""
    for share in (0.0, 0.3, 1.0):
        row = finest(SHORT, JUMP, share)
        assert (row.verdict, OPENED in row.note) == ("pass", share > 0.0)


def test_what_is_neither_formula_fails_there() -> None:
    assert finest(SHORT, 2.1 * JUMP, 1.0).verdict == "fail"
    assert finest(SHORT, -1.1 * JUMP, 1.0).verdict == "fail"


def test_a_turn_that_is_off_the_change_has_one_formula() -> None:
    """Caught: an excuse for turns that are merely short."""
    for turn, exact in ((SHORT * (1 + 1e-9), True), (SHORT * (1 - 1e-9), False)):
        assert finest(turn, JUMP if exact else 0.0, 1.0).verdict == "fail"
        row = finest(turn, 0.0, 0.0, steps=NAME)
        assert (row.verdict, OPENED in row.note) == ("pass", False)


def test_nothing_is_left_open_from_where_growth_is_infinite() -> None:
    """Caught: bounds that are no numbers, infinity times no lever, and an engine accused."""
    case = spinning(SHORT)
    truth, sweep = truth_of(case, (NAME,)), case.sweeps[-1]
    own = truth.companion(Integrator(NAME, NAME, {}), sweep)
    assert own is not None
    grown = replace(own, growth=np.where(np.arange(len(own.growth)) > 5, np.inf, own.growth))
    theta = np.where(np.isfinite(grown.growth), 1e-12, np.inf)
    left = opened_by_scheme(truth.yardstick, sweep, grown, theta)
    assert left["omega"][5] > 0.0
    assert all(np.isfinite(values).all() for values in left.values())
