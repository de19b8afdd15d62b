"""Integrators that declare no scheme: whatever is sound passes, and what is not is caught.

What these tests catch: a check of consistency that takes a scheme's own error for a fault, or a
fault for a scheme's error; one that accuses methods that conserve, branch, or keep earlier steps in
mind; a fault that only a known scheme would have shown.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from omegadot.adapters.protocol import Adapter, Description, Integrator, Trajectory
from omegadot.adapters.reference.adapter import FEATURES, ReferenceAdapter
from omegadot.commands.faults.catalogue import FAULTS
from omegadot.commands.faults.detect import Judgement, Nameless, judge, without_scheme
from omegadot.commands.faults.prepared import Pool
from omegadot.gates.case import Sweep
from omegadot.gates.steps.restart import restart_of
from omegadot.reference_impl.coordinates import from_coordinates
from omegadot.reference_impl.energy import rotational_kinetic_energy
from omegadot.reference_impl.schemes import COMMON, SCHEMES, Motion, Scheme
from omegadot.reference_impl.schemes.scheme import Step, every_channel
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

pytestmark = pytest.mark.no_cover  # its lines are covered by others

SEED = 31
EULER = without_scheme(Integrator("semi-implicit-euler", None, every_channel(1)))
# Next to what a first-order error hides: what no order, and no conservation, would show.
HIDDEN = (
    *("SecretDamping", "StepSlightlyLong", "QuaternionDrifts", "SinglePrecision", "OmegaJitters"),
    *("EnergyCorrected", "MomentumCorrected", "LogsOneStepLate", "LastStepMissing", "StaleState"),
    *("DampingAfterAWhile", "GravityOffInFirstStep", "TorqueOneStepLate", "VelocityIsDamped"),
    *(
        "AttitudeAtHalfStep",
        "OmegaAtHalfStep",
        "AttitudeInSinglePrecision",
        "NormInSinglePrecision",
    ),
    *("OneSampleTwice", "StartInSinglePrecision", "FirstSampleMissing", "ClockDrifts"),
    *("OmegaDotOfTheSampleBefore", "NineDigits", "FallsAsleep", "OmegaClampedByComponent"),
)


@pytest.fixture(scope="module")
def pool() -> Pool:
    return Pool(SEED)


def failures(found: Judgement) -> list[object]:
    unsettled = ("one step size", "the sweep does not resolve")
    return [r for r in found.rows if r.verdict == "fail" and not r.note.startswith(unsettled)]


@pytest.mark.parametrize("scheme", COMMON)
def test_every_scheme_of_the_reference_passes_unnamed(scheme: str, pool: Pool) -> None:
    adapter = Nameless(ReferenceAdapter())
    own = tuple(i for i in adapter.description.integrators if i.name == scheme)
    assert [i.scheme for i in own] == [None]
    for number in range(4):  # one of each flavour
        found = judge(pool, pool.prepare(number), "unnamed", adapter, own)
        assert (failures(found), found.broken) == ([], ""), number


@pytest.mark.parametrize("name", HIDDEN)
def test_what_a_first_order_error_would_hide_is_caught(name: str, pool: Pool) -> None:
    fault = FAULTS[name]
    adapter = Nameless(fault.wrap(ReferenceAdapter()))
    falls = {"free"} if "gravity" in fault.needs else set()  # a pivot may hold all of the weight
    number = pool.having(fault.needs | falls, 1)[0]
    adapter.load(pool.prepare(number + 1).case.system)
    found = judge(pool, pool.prepare(number), "unnamed", adapter, (EULER,))
    assert found.broken == ""
    assert failures(found) != []


class OwnScheme(ReferenceAdapter):
    """A sound engine with a method of its own."""

    one_step = True
    order = 1

    @property
    def description(self) -> Description:
        integrator = Integrator("own", None, every_channel(self.order), one_step=self.one_step)
        return Description("own", "1.0", (integrator,), features=FEATURES)

    def scheme(self) -> Step:
        raise NotImplementedError

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        own = Scheme("own", "", self.scheme(), every_channel(self.order))
        return Trajectory(*step_body(own, self.system, initial, timestep, steps, every))


class Projected(OwnScheme):
    """Euler's method that scales omega back to the energy of the step's start: it conserves."""

    def scheme(self) -> Step:
        system = self.system

        def energy(q: Array, v: Array) -> Array:
            state = from_coordinates(system, q, v, "com-world")
            return rotational_kinetic_energy(system, state)[..., None]

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            before = energy(q, v)
            q, v = SCHEMES["semi-implicit-euler"].step(motion, q, v, h)
            end = v.copy()
            end[..., -3:] *= np.sqrt(before / energy(q, v))
            return q, end

        return step


class TwoStep(OwnScheme):
    """Adams and Bashforth's method of order 2, started by a step of order 2."""

    one_step, order = False, 2

    def scheme(self) -> Step:
        last: list[tuple[Array, Array]] = []

        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            here = (v, motion.acceleration(q, v))
            before = last.pop() if last else None
            last.append(here)
            if before is None:
                return SCHEMES["lie-rk4"].step(motion, q, v, h)
            way, pull = (1.5 * now - 0.5 * then for now, then in zip(here, before, strict=True))
            return motion.retract(q, h * way), v + h * pull

        return step


class TwoStepUntold(TwoStep):
    """The same, and it states that a step depends on the state alone."""

    one_step = True


def judged(pool: Pool, adapter: Adapter, needs: set[str]) -> Judgement:
    number = pool.having(needs, 1)[0]
    own = adapter.description.integrators
    return judge(pool, pool.prepare(number), "own", adapter, own)


def test_a_conserving_method_of_its_own_is_not_accused(pool: Pool) -> None:
    found = judged(pool, Projected(), {"torque-free", "asymmetric", "free"})
    assert failures(found) == []
    energy = [r for r in found.rows if (r.channel, r.metric) == ("energy", "drift_full")]
    assert {row.note for row in energy} == {"within round-off"}


def test_a_method_that_uses_earlier_steps_declares_it(pool: Pool) -> None:
    assert failures(judged(pool, TwoStep(), {"tumbling", "asymmetric"})) == []
    reported = judged(pool, TwoStepUntold(), {"tumbling", "asymmetric"})
    assert {(row.gate, row.metric) for row in failures(reported)} == {("scheme", "restarted")}  # type: ignore[attr-defined]


def rows_of(found: Judgement, metric: str) -> list[str]:
    return [row.note for run in found.runs for row in run.rows if row.metric == metric]


def test_the_rate_at_no_step_shows_how_long_the_steps_are(pool: Pool) -> None:
    moving = pool.prepare(pool.having({"fast", "asymmetric"}, 1)[0])
    adapter = Nameless(FAULTS["StepSlightlyLong"].wrap(ReferenceAdapter()))
    found = judge(pool, moving, "unnamed", adapter, (EULER,))
    assert set(rows_of(found, "rate_at_no_step")) - {""} == {"steps are 0.1 % too long"}
    adapter = Nameless(FAULTS["LastStepMissing"].wrap(ReferenceAdapter()))
    found = judge(pool, moving, "unnamed", adapter, (EULER,))
    assert set(rows_of(found, "rate_at_no_step")) - {""} == {"a run of one step does not move"}


def test_a_known_scheme_takes_first_steps_and_restarts_no_run(pool: Pool) -> None:
    named = ReferenceAdapter()
    own = tuple(i for i in named.description.integrators if i.name == "lie-rk4")
    found = judge(pool, pool.prepare(0), "named", named, own)
    assert list(found.result.first_steps) == ["lie-rk4"]
    assert {row.verdict for row in found.rows if row.metric == "rate_at_no_step"} == {"pass"}
    assert found.result.restarts == {}


def test_a_run_is_restarted_at_its_middle() -> None:
    assert restart_of(Sweep(0.1, 10, 3)) == (2, Sweep(0.1, 4, 3))  # samples 0 3 6 9 10
    assert restart_of(Sweep(0.1, 3, 2)) == (1, Sweep(0.1, 1, 2))
    assert restart_of(Sweep(0.1, 2, 5)) is None
    coarsest = Sweep(0.4, 21, 2)  # 11 steps are left of it
    assert restart_of(coarsest, coarsest) == restart_of(coarsest) == (5, Sweep(0.4, 11, 2))
    assert restart_of(Sweep(0.2, 42, 4), coarsest) == (5, Sweep(0.2, 8, 4))
    assert restart_of(Sweep(0.1, 84, 8), coarsest) == (5, Sweep(0.1, 8, 8))
    assert restart_of(Sweep(0.025, 336, 32), coarsest) == (5, Sweep(0.025, 32, 32))


def test_a_run_that_cannot_be_restarted_fails(pool: Pool) -> None:
    class OnlyFromTheStart(Nameless):
        start: Array | None = None

        def run(
            self, initial: State, integrator: str, timestep: float, steps: int, every: int
        ) -> Trajectory:
            if steps > 1 and self.start is None:
                self.start = initial.angular_velocity
            if steps > 1 and not np.array_equal(self.start, initial.angular_velocity):  # type: ignore[arg-type]
                raise ValueError("not from here")
            return super().run(initial, integrator, timestep, steps, every)

    prepared = pool.prepare(pool.having({"asymmetric"}, 1)[0])
    found = judge(pool, prepared, "own", OnlyFromTheStart(ReferenceAdapter()), (EULER,))
    text = "a run cannot be restarted at its own sample: ValueError: not from here"
    assert set(rows_of(found, "restarted")) == {text}


def test_loads_are_no_time(pool: Pool) -> None:
    """A body that is driven, damped and pivoted is autonomous too: restarted, it goes on alike."""
    for needs in ({"torque", "damping"}, {"pivot", "gravity"}):
        found = judged(pool, TwoStepUntold(), needs)
        assert rows_of(found, "restarted")
        single = Nameless(ReferenceAdapter())
        prepared = pool.prepare(pool.having(needs, 1)[0])
        sound = judge(pool, prepared, "unnamed", single, (EULER,))
        assert {row.value for row in sound.rows if row.metric == "restarted"} == {0.0}


def test_the_system_is_that_of_the_case(pool: Pool) -> None:
    """The probe is stepped by the equation's rate; another gravity shows in it."""

    class Floating(Nameless):
        def load(self, system: System) -> None:
            super().load(replace(system, load=replace(system.load, gravity=np.zeros(3))))

    prepared = pool.prepare(pool.having({"gravity", "free"}, 1)[0])
    found = judge(pool, prepared, "unnamed", Floating(ReferenceAdapter()), (EULER,))
    wrong = {r.channel for r in found.rows if r.metric == "rate_at_no_step" and r.value > 1.0}
    assert wrong == {"linear_momentum"}
