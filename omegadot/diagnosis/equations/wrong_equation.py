"""Causes of a wrong equation: what the engine's accelerations and torques match instead."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import (
    ALONG,
    FORWARD,
    INVERSE,
    INVERTED,
    SLACK,
    Evidence,
    inverted,
    of_forward_dynamics,
    of_inverse_dynamics,
)
from omegadot.diagnosis.equations.held import Scene
from omegadot.diagnosis.equations.of_other_states import of_other_states
from omegadot.diagnosis.equations.quotient import difference_quotient
from omegadot.diagnosis.reported.requests import place_cause
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import EPS, eps_of, norm
from omegadot.gates.case import Case
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness import drive
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Acceleration, State
from omegadot.workers.wire import body_from

RELOADED = "after another system"
MOST_NAMED = 3  # causes between which nothing decides


def scene_of(case: Case, evaluation_states: EvaluationStates, result: CaseResult) -> Scene:
    """What is kept of one scenario's forward dynamics."""
    eps = eps_of(result.precision)
    evidence = {
        source: of_forward_dynamics(case.system, states, Acceleration(**answer.result), eps)
        for source, answer, states in (
            (FORWARD, result.forward, evaluation_states.random),
            (ALONG, result.path, evaluation_states.path),
            (RELOADED, result.reloaded, evaluation_states.random),
        )
        if answer.ok
    }
    requested, torque = evaluation_states.acceleration, result.inverse
    if torque.ok and np.isfinite(torque.result["torque"]).all():
        known = (case.system, evaluation_states.random, requested, torque.result["torque"])
        evidence[INVERSE] = of_inverse_dynamics(*known, eps)
        evidence[INVERTED] = inverted(*known, eps)
    held = body_from(result.model.result["bodies"][0]) if result.model.ok else None
    scaled = {
        what: of_forward_dynamics(system, states, Acceleration(**a.result), eps)
        for what, (system, states, a) in result.scaled.items()
        if a.ok
    }
    opposites = [
        (
            features_of(s, case.initial),
            of_forward_dynamics(s, states, Acceleration(**a.result), eps),
        )
        for s, states, a in result.opposites.values()
        if a.ok
    ]
    features = features_of(case.system, case.initial)
    before = {{drive.RELOADED: RELOADED}.get(k, k): v for k, v in result.before.items()}
    set_state = evaluation_states.random[0]
    states = (set_state, State(**result.model.result["state"])) if result.model.ok else None
    return Scene(
        case.name,
        case.system,
        features,
        evidence,
        held,
        scaled,
        before,
        states,
        {FORWARD: opposites},
    )


def equation_causes(across: Across, name: str, source: str) -> list[str]:
    """Of one scenario; what is known of the difference, where nothing fits."""
    evidence = across.scenes[name].evidence[source]
    found = evidence.found
    for what, values in {
        "omega-dot": found.angular,
        "the linear acceleration": found.linear,
    }.items():
        finite = int(np.count_nonzero(np.isfinite(values).all(-1)))
        if finite < len(values):
            return [f"{what} is not finite at {len(values) - finite} of {len(values)} states"]
    if not evidence.clear:
        return []
    single = _single(evidence)
    if single and evidence.eps <= EPS:
        return [single]
    text = place_cause(evidence)
    if not text and source in (FORWARD, ALONG) and np.any(found.angular):
        every = {scene.name: scene.evidence for scene in across.scenes.values()}
        text = of_other_states(every, source) or _constant(across, source)
    text = text or across.cause(name, source)
    if not text and source in (FORWARD, ALONG):
        text = difference_quotient(evidence)
    return [text] if text else known_difference(across, name, source)


def is_of_a_load(one: Candidate, evidence: Evidence) -> bool:
    """Whether inverse dynamics take a load as wrongly as a wrong equation does.

    ``J omega_dot = tau + d`` of the steps leaves ``tau - d`` for inverse dynamics.
    """
    states, system = evidence.states, evidence.system
    made = one.predicted(of_forward_dynamics(system, states, forward_dynamics(system, states)))
    if made is None:
        return False
    load = made.angular - forward_dynamics(system, states).angular
    off = evidence.found.angular - evidence.true.angular
    return bool(np.all(norm(off + load) <= SLACK * evidence.angular_bound))


def _single(evidence: Evidence) -> str:
    """omega-dot in numbers of single precision, where the right ones so rounded are wrong."""
    angular, true = evidence.found.angular, evidence.true
    single = Acceleration(true.angular.astype(np.float32).astype(float), true.linear)
    rounded = np.array_equal(angular, angular.astype(np.float32).astype(float))
    # numbers of few digits, as where a term is missing, may be single by themselves
    near = norm(angular - true.angular) <= evidence.angular_bound * (eps_of("float32") / EPS)
    found = rounded and bool(np.all(near)) and evidence.visible(single)
    return "omega-dot is worked out in single precision" * found


def _constant(across: Across, source: str) -> str:
    """On every scenario where it should change."""
    known = [s.evidence[source] for s in across.scenes.values() if source in s.evidence]
    changing = [e for e in known if np.any(np.diff(e.true.angular, axis=0))]
    moves = any(bool(np.any(np.diff(e.found.angular, axis=0))) for e in changing)
    return "omega-dot is the same at every state" if changing and not moves else ""


def known_difference(across: Across, name: str, source: str) -> list[str]:
    """What is known where no cause fits, of all such scenarios together."""
    known = across.known(name, source)
    return [f"none is known; {known}"] if known else []
