"""Mistakes in the steps that the runs of several scenarios show together; and silence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, WORLD_TORQUE, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.diagnosis.wording.kinds import agreed
from omegadot.gates.case import Case, Sweep
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, System

CASES = (
    case("driven", {"torque": BODY_TORQUE}, 1.3),
    case("driven-in-world", {"torque": WORLD_TORQUE}),
    case("top-driven", {"pivot": PIVOT, "torque": WORLD_TORQUE, "gravity": GRAVITY}, 0.9),
    case("damped", {"damping": 0.3}),
    case("top", {"gravity": GRAVITY, "pivot": PIVOT}),
)
STEPS = 24
Share = Callable[[int, float], float]
Step = Callable[[System, Motion, Array, Array, float, int], tuple[Array, Array]]


def euler(motion: Motion, q: Array, v: Array, h: float, more: Array) -> tuple[Array, Array]:
    """A step of semi-implicit Euler with a change of omega-dot."""
    v = v + h * motion.acceleration(q, v)
    v[-3:] += h * more
    return motion.retract(q, h * v), v


def kept(one: Case, step: Step, h: float, every: int) -> KeptRun:
    system, motion = one.system, body_motion(one.system)
    q, v = to_coordinates(system, one.initial, "com-world")
    places, velocities = [q], [v]
    for n in range(STEPS * every):
        q, v = step(system, motion, q, v, h, n)
        places.append(q)
        velocities.append(v)
    cut = slice(None, None, every)
    state = from_coordinates(system, np.stack(places)[cut], np.stack(velocities)[cut], "com-world")
    sweep = Sweep(h, STEPS * every, every)
    bounds = {c: np.full(STEPS, 1e-13) for c in ("omega", "attitude", "velocity", "position")}
    return KeptRun(one.name, system, sweep, sweep.times, state, bounds, True)


def causes(
    step: Step,
    scheme: str | None = "semi-implicit-euler",
    plans: tuple[tuple[float, int], ...] = ((0.02, 1), (0.009, 2)),
) -> list[str]:
    """scheme: None where none is declared; then every run counts as one that fails."""
    runs = [kept(one, step, h, every) for one in CASES for h, every in plans]
    if scheme is not None:
        runs = [replace(run, fails=not bool(np.all(_sound(run, scheme)))) for run in runs]
    return causes_over_runs(Integrator("own", scheme, dict.fromkeys(CHANNELS, 1)), runs)


def _sound(run: KeptRun, scheme: str) -> NDArray[np.bool_]:
    return run.sound(SchemeOf(SCHEMES[scheme], "com-world"))


def driven(share: Share) -> Step:
    """The applied torque times a share of the step's number and the time."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        state = from_coordinates(system, q, v, "com-world")
        torque = (share(n, n * h) - 1.0) * applied_torque(system, state)
        return euler(motion, q, v, h, apply(inverse(moving_inertia(system)), torque))

    return step


@pytest.mark.parametrize(
    ("share", "phrase"),
    [
        (
            lambda n, t: min(1.0, t / 0.15),
            "rises evenly from 0 at t = 0 to its full size at t =",
        ),
        (lambda n, t: n + 1.0, "in the n-th step of a run the applied torque acts n times"),
        (lambda n, t: float(n == 0), "acts in the first step of a run alone"),
        (lambda n, t: float(n % 3 == 1), "acts in one of 3 steps alone, from step 2 on"),
    ],
)
def test_how_a_load_goes_over_a_run_is_named(share: Share, phrase: str) -> None:
    (text,) = causes(driven(share))
    assert phrase in text
    assert "the applied torque" in text


@pytest.mark.parametrize(
    ("length", "phrase"),
    [
        (lambda h: 1.0 / round(1.0 / h), "rounded to a whole number of steps in a second"),
        (lambda h: h * (1.0 + h), "by another part at each step size"),
        (lambda h: 1.01 * h, ""),
        (lambda h: min(h, 0.0101), "of a step is limited to 0.0101 s, and the clock goes on as"),
        (lambda h: max(h, 0.0101), "the length of a step is held above 0.0101 s"),
        (lambda h: 0.0101, "the length of a step is 0.0101 s, whatever was requested"),
        (lambda h: 0.0007 * round(h / 0.0007), "of a step is rounded to a multiple of 0.0007 s"),
        (lambda h: 0.0007 * max(1, int(h / 0.0007)), "is cut off to a multiple of 0.0007 s"),
        (lambda h: round(h, 3), "the length of a step is rounded to 3 decimals"),
        (lambda h: float(np.float32(h)), "the step is kept in single precision"),
        (lambda h: h * (1.0 + 3e-8), ""),
        (lambda h: h + 0.0003, "0.0003 s is added to the length of a step"),
    ],
)
def test_steps_of_another_length_in_each_run_are_named(
    length: Callable[[float], float], phrase: str
) -> None:
    """One part in all of them is known from a run by itself."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return euler(motion, q, v, length(h), np.zeros(3))

    found = causes(step, plans=((0.0201, 1), (0.00903, 2), (0.0123, 1), (0.0053, 1)))
    assert phrase in found[0] if phrase else found == []
    assert not any("one at least" in text for text in found)  # no step here is that long


def test_a_longest_step_is_named_where_most_steps_are_many_times_as_long() -> None:
    """Caught: silence, as no search for a length begins so far from the one requested."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return euler(motion, q, v, min(h, 1.0 / 300.0), np.zeros(3))

    for scheme in ("semi-implicit-euler", None):
        (text,) = causes(step, scheme, ((0.0035, 1), (5.0, 1), (20.0, 1), (0.003, 4)))
        assert text == (
            "the length of a step is limited to 0.00333333 s, and the clock goes on as requested"
        )


def test_the_scheme_is_known_by_what_is_right_in_the_runs_of_few_scenarios() -> None:
    """None is declared, and in the runs that show most no step has its length."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return euler(motion, q, v, round(h, 3), np.zeros(3))

    (text,) = causes(step, None, ((0.0201, 1), (0.0123, 1), (0.0153, 1), (0.002, 4)))
    assert text.startswith("the length of a step is rounded to 3 decimals")


def test_a_load_that_is_wrong_by_one_factor_goes_by_no_law() -> None:
    assert causes(driven(lambda n, t: 0.5)) == []


def test_a_load_that_goes_by_no_known_law_is_not_named() -> None:
    assert causes(driven(lambda n, t: 1.0 + np.cos(40.0 * t))) == []


def test_an_operand_of_the_step_before_is_named() -> None:
    before = dict[int, Array]()

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        before[n] = q[-4:]
        world, back = system.load.torque_world, inverse(moving_inertia(system))
        old, new = (rotate_inverse(before[k], world) for k in (max(n - 1, 0), n))
        return euler(motion, q, v, h, apply(back, old - new))

    (text,) = causes(step)
    assert text == (
        "in each step the torque in world axes is taken at the attitude of the step before"
    )


@pytest.mark.parametrize("most", [1e-7, 3])
def test_how_far_an_implicit_equation_is_solved_is_named(most: float) -> None:
    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        mean = v
        for k in range(30):
            last, place = mean, motion.retract(q, 0.5 * motion.cayley(h * mean))
            mean = v + 0.5 * h * motion.acceleration(place, mean)
            if k + 1 == most or 2.0 * float(np.linalg.norm((mean - last)[-3:])) < most < 1.0:
                break
        return motion.retract(q, motion.cayley(h * mean)), 2.0 * mean - v

    (text,) = causes(step, "implicit-midpoint")
    assert "fixed-point iterations" in text
    expected = "3 fixed-point iterations alone" if most == 3 else "which end once omega changes"
    assert expected in text


@pytest.mark.parametrize("most", [1e-5, 0])
def test_an_undeclared_midpoint_rule_is_named_with_its_unsolved_equation(most: float) -> None:
    """Caught: the rounds that stop too early, taken for a term that is held, or for a lower order.

    Stopped by no law of omega's change, the number of rounds is stated as it is.
    """

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        mean = v
        for k in range(30):
            last, place = mean, motion.retract(q, 0.5 * h * mean)
            mean = v + 0.5 * h * motion.acceleration(place, mean)
            change = 2.0 * float(np.linalg.norm((mean - last)[-3:]))
            if change < most or (not most and k == 2 + n % 2):
                break
        return motion.retract(q, h * mean), 2.0 * mean - v

    runs = [kept(one, step, 0.02, 1) for one in CASES]
    (text,) = causes_over_runs(Integrator("own", None, dict.fromkeys(CHANNELS, 2)), runs)
    assert text.startswith("it is stepped by the implicit midpoint rule, which turns by the expo")
    expected = "by less than 1e-5 rad/s" if most else "another number in some steps: up to"
    assert expected in text


def test_what_one_run_shows_gives_way_to_a_cause() -> None:
    fact, cause = "only the first steps are wrong: from t = 1 s on, the run is sound", "gravity"
    over = {"one": ([fact, cause], True), "other": ([cause], True)}
    assert agreed([fact, cause], over) == [cause]
    assert agreed([fact], over) == [fact]
