"""What is requested again: the answers of an engine depend on the request alone.

What these tests catch: requests that a fault of one state, of the order of requests, of the sign of
a quaternion or of the system before does not reach; a sound engine that is accused.
"""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from omegadot.adapters.protocol import Adapter, Trajectory
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.commands.faults.catalogue import FAULTS
from omegadot.commands.faults.detect import Judgement, Nameless, judge
from omegadot.commands.faults.prepared import Pool, Prepared
from omegadot.gates.case import Sweep
from omegadot.harness.requests.repeats import OTHERS, short_sweep
from omegadot.harness.requests.siblings import siblings_of
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration, Body, State, System
from omegadot.scenarios.random_traits import BLOCK

FILE = Path(__file__).parents[1] / "wrong_engines" / "wrong.py"
spec = importlib.util.spec_from_file_location("wrong_for_repeats", FILE)
assert spec is not None
assert spec.loader is not None
wrong = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = wrong
spec.loader.exec_module(wrong)


@pytest.fixture(scope="module")
def pool() -> Pool:
    return Pool(11)


@pytest.fixture(scope="module")
def prepared(pool: Pool) -> Prepared:
    needs = {"asymmetric", "free", "scalar-negative", "coarse"}
    return pool.prepare(pool.having(needs, 1)[0])


def judged(pool: Pool, prepared: Prepared, adapter: Adapter) -> Judgement:
    return judge(pool, prepared, "own", adapter, adapter.description.integrators)


def failed(found: Judgement) -> set[str]:
    return {row.metric for row in found.rows if row.verdict == "fail"}


@pytest.mark.parametrize(
    ("name", "metrics"),
    [
        ("OneStateAlone", {"residual_alone"}),
        ("FirstRunAfterLoad", {"reloaded"}),
        ("ScalarMadePositive", {"negated", "start"}),
        ("EveryRunAddsDamping", {"repeated", "negated", "reloaded"}),
    ],
)
def test_each_fault_is_seen_by_its_request(
    name: str, metrics: set[str], pool: Pool, prepared: Prepared
) -> None:
    found = judged(pool, prepared, getattr(wrong, name)())
    assert metrics <= failed(found)
    if name in ("OneStateAlone", "FirstRunAfterLoad"):  # nothing else shows it
        assert failed(found) == metrics


@pytest.mark.parametrize(
    ("name", "feature", "gate"),
    [
        ("LastIntervalWhole", "short-interval", "trajectory"),
        ("DampingClamped", "damping-above-1", "equation"),
        ("GravityAlwaysDown", "gravity-not-down", "equation"),
        ("DampedForgetsTorque", "torque", "equation"),
    ],
)
def test_what_random_systems_have_in_them_shows_the_fault(
    name: str, feature: str, gate: str, pool: Pool
) -> None:
    number = pool.having({feature, "damping", "asymmetric"}, 1)[0]
    assert number < BLOCK
    assert gate in judged(pool, pool.prepare(number), getattr(wrong, name)()).failed


def test_what_is_left_of_another_system_is_seen_without_one_before(pool: Pool) -> None:
    prepared = pool.prepare(next(n for n in range(BLOCK) if "gravity" not in pool._draw(n)[1]))
    found = judged(pool, prepared, wrong.KeepsGravity())
    assert "residual_reloaded" in failed(found)
    assert "residual" not in failed(found)


def test_a_sound_engine_gives_the_same_to_the_bit(pool: Pool, prepared: Prepared) -> None:
    found = judged(pool, prepared, ReferenceAdapter())
    rows = [row for row in found.rows if row.metric in ("repeated", "negated", "reloaded")]
    assert {row.verdict for row in rows} == {"pass"}
    assert {row.value for row in rows if row.metric != "negated"} == {0.0}
    schemes = len(ReferenceAdapter().description.integrators)
    assert len(rows) == 3 * schemes


def test_an_unknown_scheme_may_have_two_points_for_an_attitude(
    pool: Pool, prepared: Prepared
) -> None:
    found = judged(pool, prepared, Nameless(wrong.Sound()))
    rows = [row for row in found.rows if row.metric in ("repeated", "negated", "reloaded")]
    assert {(row.metric, row.verdict) for row in rows} == {
        ("repeated", "pass"),
        ("reloaded", "pass"),
    }


@pytest.mark.parametrize("name", ["LaterRunsDiffer", "FirstRunDiffers"])
def test_a_run_that_differs_from_one_alike_is_seen_without_a_scheme(
    name: str, pool: Pool, prepared: Prepared
) -> None:
    faulty = Nameless(FAULTS[name].wrap(ReferenceAdapter()))
    assert "repeated" in failed(judged(pool, prepared, faulty))


def test_a_run_that_fails_the_second_time_is_reported(pool: Pool, prepared: Prepared) -> None:
    class Once(wrong.Sound):  # type: ignore[misc, name-defined]
        seen = 0

        def run(self, *arguments: object) -> object:
            self.seen += 1
            if self.seen > 2 * len(prepared.case.sweeps):
                raise ValueError("worn out")
            return super().run(*arguments)

    notes = {row.note for row in judged(pool, prepared, Once()).rows if row.metric == "repeated"}
    assert notes == {"the same run, requested again, fails: ValueError: worn out"}


def test_a_short_run_has_the_samples_of_the_long_one() -> None:
    for sweep in (Sweep(0.1, 100, 3), Sweep(0.1, 5, 3), Sweep(0.1, 40, 20), Sweep(0.1, 8, 1)):
        short = short_sweep(sweep)
        count = len(short.times)
        assert count > 1
        assert np.array_equal(short.times, sweep.times[:count])
    assert short_sweep(Sweep(0.1, 100, 3)).steps == 9


def test_the_other_systems_have_every_load() -> None:
    for other in OTHERS:
        load = other.system.load
        parts = (load.gravity, load.damping, load.torque_body + load.torque_world)
        assert all(np.any(part) for part in parts)
    assert [other.system.load.pivot is None for other in OTHERS] == [False, True]


def test_states_that_are_the_same_attitude_are_the_same_start(prepared: Prepared) -> None:
    start = prepared.case.initial
    other = replace(start, orientation=-start.orientation)
    assert prepared.truth.yardstick.distance("attitude", start[None], other[None]) == 0.0


class KeepsLever(ReferenceAdapter):
    """The inertia about the pivot is kept by the lever alone, whatever the mass."""

    def __init__(self) -> None:
        super().__init__()
        self._kept: dict[bytes, tuple[Body, ...]] = {}

    def load(self, system: System) -> None:
        super().load(system)
        self._asked = system
        key = np.asarray(lever(system)).tobytes() + np.asarray(system.load.gravity).tobytes()
        self._kept.setdefault(key, system.bodies)
        super().load(replace(system, bodies=self._kept[key]))

    def model(self) -> tuple[Body, ...]:
        return self._asked.bodies


def test_what_is_kept_by_one_thing_is_seen_where_another_changes(pool: Pool) -> None:
    prepared = pool.prepare(pool.having({"asymmetric", "pivot", "lever"}, 1)[0])
    found = judged(pool, prepared, KeepsLever())
    assert failed(found) == {"residual_of_sibling"}
    notes = {row.note for row in found.rows if row.verdict == "fail"}
    assert "after the same system with another mass was loaded" in notes


def test_each_sibling_differs_in_one_thing(pool: Pool) -> None:
    for prepared in (pool.prepare(n) for n in range(BLOCK)):
        case = prepared.case
        for what, other in siblings_of(case):
            assert other.name != case.name
            changed = {
                name
                for part, own in (
                    (case.system.body, other.system.body),
                    (case.system.load, other.system.load),
                )
                for name in vars(part)
                if not np.array_equal(getattr(part, name), getattr(own, name))
            }
            assert changed == {what} or (what == "scale" and {"mass", "inertia"} <= changed)


class ForgetsWeight(ReferenceAdapter):
    """Where a torque acts, gravity does not turn the body; a sound one with `sound`."""

    def __init__(self, sound: bool = False) -> None:
        super().__init__()
        self.loaded, self._sound = list[System](), sound

    def load(self, system: System) -> None:
        super().load(system)
        self.loaded.append(system)

    def forward_dynamics(self, states: State) -> Acceleration:
        system = self.loaded[-1]
        if self._sound or not np.any(system.load.torque_body):
            return super().forward_dynamics(states)
        less = replace(system.load, gravity=0.0 * system.load.gravity)
        return forward_dynamics(replace(system, load=less), states)


class ForgetsWeightInSteps(ForgetsWeight):
    """The same in its runs alone."""

    def forward_dynamics(self, states: State) -> Acceleration:
        return ReferenceAdapter.forward_dynamics(self, states)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        system = self.loaded[-1]
        if np.any(system.load.torque_body):
            less = replace(system.load, gravity=0.0 * system.load.gravity)
            super(ForgetsWeight, self).load(replace(system, load=less))
        return super().run(initial, integrator, timestep, steps, every)


@pytest.mark.parametrize(
    ("kind", "sound"),
    [(ForgetsWeight, True), (ForgetsWeight, False), (ForgetsWeightInSteps, False)],
)
def test_a_wrong_equation_is_requested_with_one_thing_the_other_way(
    kind: type[ForgetsWeight], sound: bool, pool: Pool
) -> None:
    """Caught: a condition between two that are never parted; requests to sound engines."""
    needs = {"pivot", "lever", "gravity", "torque-body"}
    prepared = pool.prepare(pool.having(needs, 1)[0])
    engine, metric = kind(sound), "residual" if kind is ForgetsWeight else "rate_at_no_step"
    assert (metric in failed(judged(pool, prepared, engine))) is not sound
    body, gravity = prepared.case.system.body, prepared.case.system.load.gravity
    without = [
        one
        for one in engine.loaded
        if np.array_equal(one.body.inertia, body.inertia)
        and np.array_equal(one.load.gravity, gravity)
        and not np.any(one.load.torque_body)
    ]
    assert bool(without) is not sound
