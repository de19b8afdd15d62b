"""Causes of a wrong equation: what the engine's accelerations and torques match instead."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.equations.evidence import (
    ALONG,
    BEYOND_ROUNDING,
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
from omegadot.diagnosis.equations.quotient import difference_quotient
from omegadot.diagnosis.models.fitted_misreadings import order_text, signed_orders
from omegadot.diagnosis.reported.requests import place_cause
from omegadot.diagnosis.wording.digits import factor
from omegadot.diagnosis.wording.features import features_of
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION, eps_of, norm, torque_size
from omegadot.gates.case import Case
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness import drive
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System
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
        text = _constant(across, source)
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


def inverse_causes(
    system: System, states: State, requested: Acceleration, torque: Array, eps: float = EPS
) -> list[str]:
    """What the torque of inverse dynamics leaves out or counts, forward dynamics being sound."""
    true, w = inverse_dynamics(system, states, requested), states.angular_velocity
    bound = ROUNDINGS_PER_EVALUATION * eps * torque_size(system, states, requested)
    if np.all(norm(torque - true) <= BEYOND_ROUNDING * bound):
        return []
    inertia = moving_inertia(system)
    terms: dict[str, Array] = {
        "the gyroscopic term": cross(w, apply(inertia, w)),
        "gravity": -gravity_torque(system, states),
        "the inertia times omega-dot": apply(inertia, requested.angular),
    }
    loads: dict[str, Array] = {
        "damping": damping_torque(system, states),
        "the applied torque": applied_torque(system, states),
    }

    def fits(candidate: Array, times: float = 1.0) -> bool:
        return bool(np.all(norm(torque - candidate) <= SLACK * max(1.0, abs(times)) * bound))

    found = []
    if fits(rotate(states.orientation, true)):
        found.append("inverse dynamics report the torque in world axes")
    if fits(rotate_inverse(states.orientation, true)):
        found.append("inverse dynamics report the torque turned by R^T once more")
    if fits(-true):
        found.append("inverse dynamics have the wrong sign")
    for order, signs in signed_orders():
        if not np.all(signs < 0.0) and fits(signs * true[:, order]):
            axes = order_text(order, signs)
            found.append(f"inverse dynamics report the torque in other axes: {axes}")
    k = _share(torque, true, bound)
    if k is not None and abs(k - 1.0) > 1e-9 and abs(k + 1.0) > 1e-9 and fits(k * true, k):
        found.append(f"inverse dynamics report the torque scaled by {factor(k)}")
    if all(np.any(one) for one in loads.values()) and fits(true - sum(loads.values())):
        found.append("inverse dynamics leave out the loads that act: damping and torque")
    for what, term in terms.items():
        k = _share(torque - true, term, bound)
        if k is not None and fits(true + k * term):
            found.append(_worded(what, 1.0 + k))
    for what, term in loads.items():
        k = _share(torque - true, term, bound)
        if k is not None and fits(true + k * term):
            found.append(_load_worded(what, k))
    bodies = _other_bodies(system, states, requested)
    found += [text for text, made in bodies.items() if not fits(true) and fits(made())]
    for what, term in _other_gyroscopic(inertia, w, requested.angular) if not found else ():
        if fits(true - terms["the gyroscopic term"] + term):
            found.append(f"inverse dynamics have {what} for the gyroscopic term")
    for what, term in terms.items() if not found else ():
        for axis in range(3):
            alone = np.where(np.arange(3) == axis, term, 0.0)
            k = _share(torque - true, alone, bound)
            if k is not None and fits(true + k * alone):
                found.append(_worded(f"the {'xyz'[axis]} component of {what}", 1.0 + k))
    if len(found) > MOST_NAMED:
        return []
    return ["either " + ", or ".join(found)] if len(found) > 1 else found


def _share(rest: Array, term: Array, bound: Array) -> float | None:
    line, off = np.ravel(term / bound[:, None]), np.ravel(rest / bound[:, None])
    size = float(line @ line)
    return float(off @ line) / size if size > 0.0 and np.isfinite(size) else None


def _worded(what: str, k: float) -> str:
    known = {0: f"leave out {what}", -1: f"have {what}'s sign wrong", 2: f"count {what} twice"}
    if abs(k - round(k)) < 1e-9 and round(k) in known:
        return f"inverse dynamics {known[round(k)]}"
    return f"inverse dynamics have {what} scaled by {factor(k)}"


def _load_worded(what: str, k: float) -> str:
    """Of a load that belongs to what is found, k times the torque that it exerts added to it."""
    if abs(k + 1.0) < 1e-9:
        return f"inverse dynamics leave out what {what} takes up: it is counted among what is given"
    if abs(k - 1.0) < 1e-9:
        return f"inverse dynamics count {what} on top of the torque that is found"
    if abs(k + 2.0) < 1e-9:
        return f"inverse dynamics count {what} twice among what is given"
    return f"inverse dynamics have {factor(k)} times {what} in them"


def _other_gyroscopic(inertia: Array, w: Array, rate: Array) -> Iterator[tuple[str, Array]]:
    """With omega-dot in the place of an omega."""
    yield "omega-dot x I omega", np.asarray(cross(rate, apply(inertia, w)))
    yield "omega x I omega-dot", np.asarray(cross(w, apply(inertia, rate)))


def _other_bodies(
    system: System, states: State, requested: Acceleration
) -> dict[str, Callable[[], Array]]:
    """The torque by another inertia."""
    inertia, w = np.asarray(moving_inertia(system), dtype=float), states.angular_velocity
    gravity, body = gravity_torque(system, states), system.body.inertia
    diagonal = np.diag(np.diag(inertia))

    def by(mass: Array, spin: Array) -> Callable[[], Array]:
        return lambda: apply(mass, requested.angular) + cross(w, apply(spin, w)) - gravity

    return {
        "inverse dynamics use the inertia's diagonal alone": by(diagonal, diagonal),
        "inverse dynamics use the inertia's diagonal alone for omega-dot": by(diagonal, inertia),
        "inverse dynamics use the inertia's diagonal alone in the gyroscopic term": by(
            inertia, diagonal
        ),
        "inverse dynamics use the inertia about the centre of mass, not about the pivot": by(
            np.asarray(body), np.asarray(body)
        ),
        "inverse dynamics have the products of inertia with the wrong sign": by(
            2.0 * diagonal - inertia, 2.0 * diagonal - inertia
        ),
        "inverse dynamics invert the inertia": by(np.asarray(inverse(inertia)), inertia),
        "inverse dynamics give the torque of the acceleration that the loads cause": lambda: (
            inverse_dynamics(system, states, forward_dynamics(system, states))
        ),
    }
