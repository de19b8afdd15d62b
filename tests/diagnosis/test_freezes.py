"""Steps that leave a slow body as it is: below which limit, of all bodies or of those of a kind."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from test_rests import CASES, STEPS, Rule, probed

from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.stepping.vanishing.freezes import FREEZES, freezes_of
from omegadot.diagnosis.stepping.vanishing.rests import Rests
from omegadot.gates.case import Case
from omegadot.gates.steps.probe import Probe
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State, System

SLOW_W, SLOW_V = 0.5, 0.15


def slowly(one: Case) -> Probe:
    """States of many speeds, which do not go with omega."""
    probe = probed(one)
    places = 7 * np.arange(len(probe.states.position)) % len(probe.states.position)
    mixed = replace(probe.states, linear_velocity=probe.states.linear_velocity[places])
    return replace(probe, states=place_on_pivot(one.system, mixed))


def frozen(rule: Rule) -> dict[str, Rests]:
    found = {}
    for one in CASES:
        probe = slowly(one)
        fields = {
            name: np.repeat(f[:, None], STEPS, axis=1) for name, f in vars(probe.states).items()
        }
        how = (SCHEMES["semi-implicit-euler"], one.system, State(**fields), probe.timesteps, 1, 1)
        after, stays = step_body(*how)[1][-1], rule(one.system, probe.states)
        pairs = zip(vars(after).values(), fields.values(), strict=True)
        ends = State(*(np.where(stays[:, None, None], old, new) for new, old in pairs))
        found[one.name] = freezes_of(one.system, probe, ends, [])
    return found


def by_both(system: System, states: State) -> NDArray[np.bool_]:
    """Omega, and of a free body its speed as well."""
    w, v = (
        np.linalg.norm(one, axis=-1) for one in (states.angular_velocity, states.linear_velocity)
    )
    return np.asarray((w < SLOW_W) & ((v < SLOW_V) | (system.load.pivot is not None)))


def test_a_limit_below_which_steps_change_nothing_is_named() -> None:
    """Caught: "the body does not move in the run", of a body that is slow."""
    engine = EngineOverScenarios()
    engine.integrators["one"].asleep.frozen |= frozen(by_both)
    free, pivoted = (engine.sleep("one", name) for name in ("body-0", "body-2"))
    assert free.startswith(f"{FREEZES} where the body is free and |omega| is below a limit between")
    assert "and its speed is below one between" in free
    assert pivoted.startswith(f"{FREEZES} where the body is pivoted and")
    assert "|omega| is below a limit between" in pivoted
    assert "its speed" not in pivoted


def test_bodies_that_move_are_not_frozen() -> None:
    """Caught: a state at rest, which no step should change, taken for a frozen one."""
    found = frozen(lambda _, states: np.zeros(len(states.position), bool))
    assert not any(one.seen for one in found.values())
