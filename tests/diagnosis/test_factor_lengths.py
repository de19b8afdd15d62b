"""An implicit term with the length of another step, in all runs and in steps as they vanish."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import kept
from wrong_equations import GRAVITY, PIVOT, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.turns.factor_lengths import other_lengths
from omegadot.diagnosis.stepping.vanishing.jumps import jump_cause
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.gates.steps.probe import probe_at
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

CASES = (
    case("damped", {"damping": 0.3}),
    case("top-damped", {"gravity": GRAVITY, "pivot": PIVOT, "damping": 0.1}),
    case("free", {}),
)
FIRST = {"damped": 0.04, "top-damped": 0.02, "free": 0.03}
Length = Callable[[str, float], float]


def with_length(motion: Motion, part: float | Array) -> Motion:
    """Each Jacobian times g / h."""

    def jacobian(q: Array, v: Array, size: Array | None) -> tuple[Array, Array]:
        a, slopes = acceleration_and_jacobian(motion, q, v, size)
        return a, np.asarray(part)[..., None, None] * slopes

    return replace(motion, jacobian=jacobian)


def run_of(one: Case, scheme: str, length: Length, h: float) -> KeptRun:
    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return SCHEMES[scheme].step(with_length(motion, length(one.name, h) / h), q, v, h)

    run = kept(one, step, h, 1)
    return replace(run, fails=not run.sound(SchemeOf(SCHEMES[scheme], "com-world")).all())


def steps_of(one: Case, scheme: str, length: Length) -> VanishingSteps:
    probe = probe_at(one.system, place_on_pivot(one.system, random_states(one, 12, [1])))
    lanes = [
        np.broadcast_to(f[:, None], (*probe.timesteps.shape, f.shape[-1])).copy()
        for f in vars(probe.states).values()
    ]
    part = np.vectorize(lambda h: length(one.name, h) / h)(probe.timesteps)
    motion = with_length(body_motion(one.system), part)
    how = (probe.timesteps, 1, 1, "com-world", motion)
    _, after = step_body(SCHEMES[scheme], one.system, State(*lanes), *how)
    return vanishing_steps(one.system, probe, after[-1])


def statement(scheme: str, length: Length, cases: tuple[Case, ...] = CASES) -> str:
    runs = [run_of(one, scheme, length, FIRST[one.name] / k) for one in cases for k in (1, 2, 4)]
    steps = {one.name: steps_of(one, scheme, length) for one in cases}
    requested = {one.name: [FIRST[one.name] / k for k in (1, 2, 4)] for one in cases}
    integrator = Integrator("own", scheme, dict.fromkeys(CHANNELS, 1))
    found = other_lengths(integrator, steps, runs, requested)
    if found is not None and scheme == "implicit-damping-euler":
        assert "free" not in found.names
    return "" if found is None else found.statement


@pytest.mark.parametrize(
    ("scheme", "what"),
    [
        ("implicit-damping-euler", "the implicit damping"),
        ("linearly-implicit-euler", "the linearly implicit term"),
    ],
)
def test_the_length_of_the_first_run_or_a_fixed_one_is_named(scheme: str, what: str) -> None:
    """Caught: "0.024 kg m^2 is added to the inertia's diagonal (an armature)"."""
    assert statement(scheme, lambda name, h: FIRST[name]) == (
        f"{what} has the step's length of another run of the same system: of the first one, in "
        "all runs after it"
    )
    fixed = f"{what} has the length of one and the same step in every run, 0.013 s"
    assert statement(scheme, lambda name, h: 0.013) == fixed


def test_of_one_system_alone_it_is_either() -> None:
    text = statement("implicit-damping-euler", lambda name, h: FIRST[name], CASES[:1])
    assert text.startswith("either ")
    assert text.endswith("in every run, 0.04 s")


@pytest.mark.parametrize(
    "length",
    [lambda name, h: h, lambda name, h: 2.0 * h, lambda name, h: h + 0.01],
)
def test_other_lengths_are_none_of_another_run(length: Length) -> None:
    """Right ones; in part ones; and a number that is added, as an armature's is."""
    assert statement("implicit-damping-euler", length) == ""


@pytest.mark.parametrize("least", [1e-6, 1e-5])
def test_steps_that_are_never_shorter_than_a_length_hold_omega_within_no_limit(
    least: float,
) -> None:
    """Their ends jump, by less than what the steps are judged by, and in any direction."""
    for one in CASES:
        probe = probe_at(one.system, place_on_pivot(one.system, random_states(one, 12, [1])))
        shape = (*probe.timesteps.shape, -1)
        lanes = [
            np.broadcast_to(f[:, None], (*shape[:-1], f.shape[-1]))
            for f in vars(probe.states).values()
        ]
        how = (np.maximum(probe.timesteps, least), 1, 1, "com-world", body_motion(one.system))
        _, after = step_body(SCHEMES["rk4-quaternion"], one.system, State(*lanes), *how)
        steps = vanishing_steps(one.system, probe, after[-1])
        assert "is held" not in jump_cause(steps)
