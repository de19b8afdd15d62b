"""What a run reports is held to the contract: its start, unit quaternions, doubles, omega-dot.

What these tests catch: a bound that grows with the motion where it must not, a sample left out, an
accusation of numbers that are singles by chance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from in_process import judged

from omegadot.adapters.protocol import Integrator, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import CHANNELS, MeasuredRun
from omegadot.gates.rows import Row
from omegadot.gates.runs.trajectory import _length, _start, grain_of
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Acceleration, State

NAME = "lie-rk4"
METRICS = ("start", "unit_length", "precision", "residual_in_run")


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    pool = Pool(5)
    return pool.prepare(pool.having({"full-inertia", "asymmetric", "torque-free"}, 1)[0])


class Reported(ReferenceAdapter):
    """The reference with one thing reported otherwise."""

    def reports_found(self, state: State) -> State:
        return state

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        found = super().run(initial, integrator, timestep, steps, every)
        return Trajectory(found.time, self.reports_found(found.state))


def rows_of(prepared: Prepared, adapter: ReferenceAdapter) -> dict[str, Row]:
    integrator = Integrator(NAME, None, SCHEMES[NAME].orders)
    adapter.load(prepared.case.system)
    run = judged(prepared.case, prepared.truth, integrator, adapter)[0]
    return {row.metric: row for row in run.rows if row.metric in METRICS}


def test_a_sound_run_reports_all_of_it(prepared: Prepared) -> None:
    found = rows_of(prepared, Reported())
    assert {metric: row.verdict for metric, row in found.items()} == {
        "start": "pass",
        "unit_length": "pass",
        "residual_in_run": "pass",
    }


@pytest.mark.parametrize("field", ["orientation", "angular_velocity", "position"])
def test_the_start_is_the_state_given(field: str, prepared: Prepared) -> None:
    class Moved(Reported):
        def reports_found(self, state: State) -> State:
            values = getattr(state, field).copy()
            values[0] = values[0] + 1e-9 * np.max(np.abs(values))
            return replace(state, **{field: values})

    row = rows_of(prepared, Moved())["start"]
    assert (row.verdict, row.note) == (
        "fail",
        "the run does not begin at the state that it is given",
    )
    channel = {"orientation": "attitude", "angular_velocity": "omega", "position": "position"}
    assert row.channel == channel[field]


def test_a_start_without_an_error_is_at_no_distance() -> None:
    none, tiny = dict.fromkeys(CHANNELS, np.zeros(2)), dict.fromkeys(CHANNELS, np.full(2, EPS))
    row = _start(MeasuredRun(Sweep(0.1, 1, 1), none, tiny, {}))
    assert (row.value, row.bound, row.verdict) == (0.0, 1.0, "pass")


def test_the_start_is_held_to_the_floor_of_the_start() -> None:
    error = {"omega": np.array([2.0, 9.0]), "attitude": np.zeros(2), "position": np.zeros(2)}
    bounds = dict.fromkeys(error, np.array([1.0, 9.0]))
    for floor, share in (({}, 2.0), ({"omega": np.array([3.0, 9.0])}, 0.5)):
        row = _start(MeasuredRun(Sweep(0.1, 1, 1), error, bounds, {}, floor))
        assert (row.channel, row.value) == ("omega", share)


def test_the_length_reported_is_that_of_the_worst_sample(prepared: Prepared) -> None:
    q = np.tile([1.0, 0.0, 0.0, 0.0], (4, 1))
    q[2] *= 1.0 + 40 * EPS
    q[3] *= 1.0 + 44 * EPS  # farther off, and less so for the steps it took
    row = _length(Sweep(0.1, 3, 1), State(q, *3 * [np.zeros((4, 3))]), EPS)
    assert row.verdict == "pass"
    assert row.value == pytest.approx(40 * EPS, rel=0.02)
    assert row.bound == 16 * EPS * 3


@pytest.mark.parametrize("sample", [0, 7, -1])
def test_every_quaternion_is_of_unit_length(sample: int, prepared: Prepared) -> None:
    class Longer(Reported):
        def reports_found(self, state: State) -> State:
            q = state.orientation.copy()
            q[min(sample, len(q) - 1)] *= 1.0 + 1e-12  # a warm-up has two samples
            return replace(state, orientation=q)

    row = rows_of(prepared, Longer())["unit_length"]
    assert row.verdict == "fail"
    assert row.value == pytest.approx(1e-12, rel=1e-3)
    steps = prepared.case.sweeps[0].sample_steps[sample]
    assert row.bound == 16 * EPS * (steps + 1)


@pytest.mark.parametrize(
    ("fields", "channel", "kept"),
    [
        (["orientation"], "attitude", "attitude is kept"),
        (["angular_velocity"], "omega", "omega is kept"),
        (["orientation", "angular_velocity"], "attitude", "attitude and omega are kept"),
    ],
)
def test_single_precision_is_distinguished_from_double(
    fields: list[str], channel: str, kept: str, prepared: Prepared
) -> None:
    """Caught: "the state is kept in single precision", where one quantity alone is."""

    class Single(Reported):
        def reports_found(self, state: State) -> State:
            singles = {name: getattr(state, name).copy() for name in fields}
            for values in singles.values():
                values[1:] = values[1:].astype(np.float32)
            return replace(state, **singles)

    row = rows_of(prepared, Single())["precision"]
    assert (row.channel, row.verdict, row.bound) == (channel, "fail", EPS)
    assert row.note == f"{kept} in single precision, and double is declared"


def test_a_constant_omega_may_be_a_single_by_chance(prepared: Prepared) -> None:
    class Still(Reported):
        def reports_found(self, state: State) -> State:
            return replace(state, angular_velocity=0.0 * state.angular_velocity + 0.5)

    assert "precision" not in rows_of(prepared, Still())


def test_the_omega_dot_reported_is_that_of_the_states_reported(prepared: Prepared) -> None:
    class Late(Reported):
        def forward_dynamics(self, states: State) -> Acceleration:
            found = super().forward_dynamics(states)
            late = np.concatenate([found.angular[:1], found.angular[:-1]])
            return Acceleration(late, found.linear)

    row = rows_of(prepared, Late())["residual_in_run"]
    assert (row.gate, row.channel, row.verdict) == ("trajectory", "omega_dot", "fail")


def test_states_without_numbers_have_no_omega_dot_to_be_wrong(prepared: Prepared) -> None:
    class Vast(Reported):
        def reports_found(self, state: State) -> State:
            w = state.angular_velocity.copy()
            w[-1] = 1e200
            return replace(state, angular_velocity=w)

    with np.errstate(over="ignore", invalid="ignore"):
        assert rows_of(prepared, Vast())["residual_in_run"].verdict == "pass"


def test_multiples_of_one_step_are_no_single_precision() -> None:
    """Caught: omega rounded to 2^-20 rad/s, which single precision holds without a loss."""
    values = np.random.default_rng(5).normal(size=(40, 3))
    singles = values.astype(np.float32).astype(float)
    assert [grain_of(v) for v in (values, singles, np.zeros((4, 3)))] == [None, None, None]
    assert grain_of(np.round(values * 2.0**20) / 2.0**20) == -20
