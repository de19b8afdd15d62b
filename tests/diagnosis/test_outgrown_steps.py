"""A wrong term that outgrows the steps of one integrator is the one that another's steps show."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from wrong_equations import case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.in_steps import StepCauses
from omegadot.diagnosis.kept_case import KeptCase, source_of
from omegadot.diagnosis.over_scenarios import OverScenarios
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.gates.states.equation import random_states
from omegadot.gates.steps.probe import probe_at
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State

EULER, RK4 = "semi-implicit-euler", "rk4-quaternion"
DRAG = "the linear velocity is damped by its square"
LIGHT = case("light", {"damping": 0.5}, 1e-9)
EVERY = (
    *(case(f"damped-{k}", {"damping": d}, m) for k, (d, m) in enumerate(((0.3, 2.0), (1.7, 0.7)))),
    case("damped-most", {"damping": 2.9}, 5.0),
    LIGHT,
)


def steps_of(one: Case, scheme: str, power: float) -> VanishingSteps:
    """Of a drag ``-d / m |v|^power v`` on the linear velocity."""
    system, exact = one.system, body_motion(one.system)
    probe = probe_at(system, random_states(one, 12, [1]))
    ratio = float(system.load.damping) / float(system.body.mass)

    def acceleration(q: Array, v: Array) -> Array:
        found = np.array(exact.acceleration(q, v))
        linear = v[..., :-3]
        found[..., :-3] -= ratio * norm(linear)[..., None] ** power * linear
        return found

    lanes = State(
        *(np.repeat(f[:, None], probe.timesteps.shape[1], 1) for f in vars(probe.states).values())
    )
    q, v = to_coordinates(system, lanes, "com-world")
    motion = replace(exact, acceleration=acceleration)
    with np.errstate(all="ignore"):
        end = SCHEMES[scheme].step(motion, q, v, probe.timesteps[..., None])
    return vanishing_steps(system, probe, from_coordinates(system, *end, "com-world"))


def outgrown(power: float, other: float) -> tuple[str, str, bool]:
    """The causes of RK4 on another scenario and on the light body; whether they are one.

    other: of the drag in Euler's steps.
    """
    across, by = Across(), Integrator(RK4, None, SCHEMES[RK4].orders)
    powers = {EULER: other, RK4: power}
    known = {(one.name, s): steps_of(one, s, p) for one in EVERY for s, p in powers.items()}
    for one in EVERY:
        evidence = {source_of(s): known[one.name, s].evidence for s in (EULER, RK4)}
        across.add(Scene(one.name, one.system, features_of(one.system, one.initial), evidence))
    kept = KeptCase("light", by, "", None, False, False, known["light", RK4])
    causes = StepCauses(across, OverScenarios(), kept, list)
    texts = [across.cause(name, source_of(RK4)) for name in ("damped-most", "light")]
    with np.errstate(all="ignore"):
        return texts[0], texts[1], causes.outgrown(known["light", RK4], "damped-most")


def test_a_drag_that_outgrows_the_steps_of_one_integrator_is_that_of_the_other() -> None:
    """Caught: no cause on any scenario, as beyond the range of numbers nothing seemed to fit."""
    elsewhere, here, same = outgrown(1.0, 1.0)
    assert elsewhere.startswith(DRAG)
    assert here == ""
    assert same


def test_a_drag_of_another_kind_is_not_that_of_the_other() -> None:
    elsewhere, _, same = outgrown(0.0, 1.0)
    assert elsewhere
    assert not same
