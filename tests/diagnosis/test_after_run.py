"""What the first step of a run takes of the run before it, as runs after known runs show."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from wrong_equations import CASES

from omegadot.adapters.protocol import Trajectory
from omegadot.adapters.reference import ReferenceAdapter
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.experiments.run_before import after_runs
from omegadot.diagnosis.stepping.ends.after_run import OWN, AfterRun, _of_start, taken_of_run_before
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.states.equation import random_states
from omegadot.harness.in_process import driver_of
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import damping_torque
from omegadot.reference_impl.motion import acceleration_of, forward_dynamics
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, State, System

EULER, RK4 = "semi-implicit-euler", "rk4-quaternion"
FREE, DAMPED, TOP = (next(c for c in CASES if c.name == n) for n in ("free", "damped-more", "top"))


@dataclass
class Memory:
    """What an engine has of the run before: its system, states and step; loads: whether it stays
    when another system is loaded.
    """

    system: System | None = None
    states: list[State] = field(default_factory=list)
    h: float = 0.0


# From the memory, the system, a state and the step: the state that is stepped, its rates and step.
Take = Callable[[Memory, System, State, float], tuple[State, Array, Array, float]]


class Keeping(ReferenceAdapter):
    """Semi-implicit Euler, whose first step takes something of the run before."""

    forgets = False

    def __init__(self, take: Take) -> None:
        super().__init__()
        self.take, self.memory = take, Memory()

    def load(self, system: System) -> None:
        super().load(system)
        if self.forgets:
            self.memory = Memory()

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        assert (every, integrator) == (1, EULER)
        state, seen = initial, [initial]
        for k in range(steps):
            found = acceleration_of(self.system)(state)
            start, w_dot, spin, h = state, found.angular, state.angular_velocity, timestep
            if k == 0 and self.memory.system is not None:
                start, w_dot, spin, h = self.take(self.memory, self.system, state, timestep)
            w = start.angular_velocity + h * w_dot
            turn = h * (w + spin - start.angular_velocity)
            v = start.linear_velocity + h * found.linear
            q = quaternion_product(start.orientation, exp_quaternion(turn))
            state = State(q, w, start.position + h * v, v)
            seen.append(state)
        self.memory = Memory(self.system, seen, timestep)
        fields = zip(*(vars(one).values() for one in seen), strict=True)
        return Trajectory(timestep * np.arange(steps + 1), State(*map(np.stack, fields)))


def old_omega_dot(place: int, part: float = 1.0) -> Take:
    def take(
        m: Memory, system: System, state: State, h: float
    ) -> tuple[State, Array, Array, float]:
        assert m.system is not None
        old = acceleration_of(m.system)(m.states[place]).angular
        own = acceleration_of(system)(state).angular
        return state, own + part * (old - own), state.angular_velocity, h

    return take


def old_damping(
    m: Memory, system: System, state: State, h: float
) -> tuple[State, Array, Array, float]:
    assert m.system is not None
    more = damping_torque(m.system, m.states[-1]) - damping_torque(system, state)
    own = acceleration_of(system)(state).angular
    return (
        state,
        own + np.linalg.solve(moving_inertia(system), more),
        state.angular_velocity,
        h,
    )


def old_turn(
    m: Memory, system: System, state: State, h: float
) -> tuple[State, Array, Array, float]:
    own = acceleration_of(system)(state).angular
    return state, own, m.states[-1].angular_velocity, h


def old_step(
    m: Memory, system: System, state: State, h: float
) -> tuple[State, Array, Array, float]:
    return state, acceleration_of(system)(state).angular, state.angular_velocity, m.h


def old_start(
    m: Memory, system: System, state: State, h: float
) -> tuple[State, Array, Array, float]:
    start = replace(state, angular_velocity=m.states[-1].angular_velocity)
    own = acceleration_of(system)(start).angular
    return start, own, start.angular_velocity, h


def cause(engine: ReferenceAdapter, case: object, *names: str) -> str:
    """names: of integrators, of which the first is looked at."""
    requests = Requests(driver_of("wrong", engine))
    known = {i.name: i for i in engine.description.integrators}
    integrators = [known[name] for name in names or (EULER,)]
    assert case in CASES
    one = next(c for c in CASES if c is case)
    seen = after_runs(requests, one, integrators, random_states(one, 4, [1]), EPS, 3)
    return taken_of_run_before([*seen])


LAST = "the first step of a run takes the omega-dot at the start of the last step of the run before"
WRONG: dict[str, tuple[Take, str]] = {
    "last omega-dot": (old_omega_dot(-2), LAST),
    "omega-dot at the end": (
        old_omega_dot(-1),
        "the first step of a run takes the omega-dot at the end of the run before",
    ),
    "a multistep method": (
        old_omega_dot(-2, -0.5),
        "for a part of -0.5, the first step of a run takes the omega-dot at the start of the last",
    ),
    "turn": (old_turn, "the first step of a run takes the omega at the end of the run before"),
    "length": (old_step, "the first step of a run has the length of the steps of the run before"),
    "start": (old_start, "the first step of a run starts from the omega at the end of the run"),
}


@pytest.mark.parametrize("case", [FREE, DAMPED, TOP], ids=lambda case: case.name)
@pytest.mark.parametrize("name", WRONG)
def test_what_is_taken_is_named(name: str, case: object) -> None:
    """Caught: something is left over, and no word of what."""
    take, phrase = WRONG[name]
    if name == "start" and case is FREE:
        return  # nothing slows it down, and it turns ever faster until no number is left
    assert cause(Keeping(take), case).startswith(phrase)


class FirstStage(ReferenceAdapter):
    """Schemes whose first stage has the omega-dot that the run before evaluated last."""

    kept: Array | None = None

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        assert every == 1
        system, stale = self.system, self.kept

        def acceleration(state: State) -> Acceleration:
            nonlocal stale
            found = forward_dynamics(system, state)
            self.kept = found.angular
            if stale is not None:
                found, stale = replace(found, angular=stale), None
            return found

        motion = motion_over(system, "com-world", acceleration)
        how = (timestep, steps, every, "com-world", motion)
        return Trajectory(*step_body(SCHEMES[integrator], system, initial, *how))


@pytest.mark.parametrize("case", [FREE, DAMPED], ids=lambda case: case.name)
def test_what_the_last_stage_has_left_over_is_named(case: object) -> None:
    """Caught: the omega-dot at the end of the run, which is near that of the last stage."""
    found = cause(FirstStage(), case, RK4)
    assert found.startswith(
        "for a part of 0.1667 (the first stage of RK4), the first step of a run takes the "
        "omega-dot at the last stage of the run before in place of its own"
    )


@pytest.mark.parametrize(("name", "other"), [(EULER, RK4), (RK4, EULER)])
def test_what_is_left_over_is_so_after_another_integrator_s_run(name: str, other: str) -> None:
    """Caught: "but not of another integrator", whose last omega-dot is of another place."""
    found = cause(FirstStage(), DAMPED, name, other)
    assert (
        "the first step of a run takes the omega-dot that was evaluated last in the run before in "
        "place of its own, also of another integrator"
    ) in found


def test_a_torque_is_told_from_omega_dot() -> None:
    """Caught: the whole omega-dot named where its damping alone is old."""
    found = cause(Keeping(old_damping), DAMPED)
    assert found.startswith("the first step of a run takes the torque of the damping at the end of")


@pytest.mark.parametrize("forgets", [True, False])
def test_whether_it_stays_after_a_load_is_said(forgets: bool) -> None:
    engine = Keeping(old_omega_dot(-2))
    engine.forgets = forgets
    said = ", but not of another system, loaded in between"
    also = ", also of another system, loaded in between"
    assert cause(engine, TOP).endswith(said if forgets else also)


def test_nothing_is_named_of_a_sound_engine() -> None:
    def own(m: Memory, system: System, state: State, h: float) -> tuple[State, Array, Array, float]:
        return state, acceleration_of(system)(state).angular, state.angular_velocity, h

    assert cause(Keeping(own), TOP) == ""
    assert cause(Keeping(own), DAMPED) == ""


def test_a_velocity_that_is_none_throughout_is_that_of_no_run_before() -> None:
    """Caught: a body held in its centre of mass, whose velocities are the same in every run."""
    system = FREE.system
    own = np.asarray(system.body.center_of_mass)
    held = replace(system, load=replace(system.load, pivot=own))
    state = State(np.array([0.6, 0.8, 0.0, 0.0]), np.ones(3), np.zeros(3), np.zeros(3))
    path = State(*(np.repeat(f[None], 4, axis=0) for f in vars(state).values()))
    steps = SimpleNamespace(system=held, states=path[:1])
    turned = replace(state, orientation=np.array([0.6, -0.8, 0.0, 0.0]))
    one: Any = AfterRun(OWN, held, path, ((path, turned),) * 8, steps, turned)  # type: ignore[arg-type]
    assert not _of_start([one, one], "linear_velocity", "linear velocity")
