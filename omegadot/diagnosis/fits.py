"""Causes with a number in them, fitted to an engine's accelerations and then held to its bounds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.diagnosis.match import Match
from omegadot.gates.scales import norm
from omegadot.reference_impl.body_motion import attitude_motion
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque, torque
from omegadot.reference_impl.motion import center_of_mass_acceleration, forward_dynamics
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array

# A fitted number has rounding of its own, of about as many terms as there are components.
SLACK = 4.0
MOST_TRIES = 6
NOTHING = Acceleration(np.zeros(3), np.zeros(3))


def term_of(match: Match, moment: Array, gravity: float = 0.0) -> Acceleration:
    """A torque's share of the acceleration, and that of a free body's weight."""
    angular = apply(inverse(moving_inertia(match.system)), moment)
    if match.system.load.pivot is None:
        return Acceleration(angular, gravity * match.system.load.gravity + 0 * angular)
    turned = center_of_mass_acceleration(match.system, match.states, angular)
    still = center_of_mass_acceleration(match.system, match.states, 0 * angular)
    return Acceleration(angular, turned - still)


def with_term(match: Match, term: Acceleration, k: float = 1.0) -> Acceleration:
    """The true acceleration with k times one more term."""
    true = match.true
    return Acceleration(true.angular + k * term.angular, true.linear + k * term.linear)


def _fit(match: Match, term: Acceleration) -> float | None:
    """The k with ``found = true + k term``, each state weighted by its bound; None if none fits."""
    rest, line = _apart(match, match.found, match.true), _apart(match, term, NOTHING)
    if not np.any(line):
        return None
    k = float(rest @ line / (line @ line))
    return k if match.fits(with_term(match, term, k), SLACK) else None


def scaled_terms(match: Match) -> str:
    """One of the equation's terms times a number, or a damping that was not requested."""
    system, states = match.system, match.states
    w = states.angular_velocity
    gyroscopic = -cross(w, apply(moving_inertia(system), w))
    terms = {
        "the gyroscopic term": (gyroscopic, 0.0),
        "gravity": (gravity_torque(system, states), 1.0),
        "the applied torque": (applied_torque(system, states), 0.0),
        "the damping": (damping_torque(system, states), 0.0),
        "the torque of all loads": (torque(system, states), 0.0),
    }
    phrases = {0: "is missing", -1: "has the wrong sign", 2: "counts twice"}
    for what, (moment, gravity) in terms.items():
        k = _fit(match, term_of(match, moment, gravity))
        if k is not None:
            factor, whole = 1.0 + k, round(1.0 + k)
            scaled = f"is scaled by {factor:.6g}"
            text = phrases.get(whole, scaled) if abs(factor - whole) < 1e-9 else scaled
            over_mass = abs(factor * float(system.body.mass) - 1.0) < 1e-9
            return f"{what} {text}" + ": it is divided by the mass" * over_mass
    k = _fit(match, term_of(match, -w))
    if k is not None:
        return f"a damping of {k:.3g} N m s/rad acts that was not requested"
    return _gravity_vector(match)


def _gravity_vector(match: Match) -> str:
    """Another constant gravity than the one requested, by least squares."""
    requested = match.system.load.gravity
    gravity = requested + _change(match, "gravity", requested, 1.0)
    if not match.fits(_under(match, "gravity", gravity), SLACK):
        return ""
    return f"gravity is {_vector(gravity)} m/s^2, where {_vector(requested)} was requested"


def _under(match: Match, part: str, vector: Array) -> Acceleration:
    """The equation under a load that is another in one part."""
    other = replace(match.system, load=replace(match.system.load, **{part: vector}))
    return forward_dynamics(other, match.states)


def _change(match: Match, part: str, vector: Array, delta: float) -> Array:
    """By how much to change one part (3,) of the load: a step of Gauss-Newton."""
    here, ends = _under(match, part, vector), vector + delta * np.eye(3)
    rest = _apart(match, match.found, here)
    lines = [_apart(match, _under(match, part, end), here) / delta for end in ends]
    change: Array = np.linalg.lstsq(np.stack(lines, axis=-1), rest, rcond=None)[0]
    return change


def other_pivot(match: Match) -> str:
    """Another pivot than the one requested, by Gauss-Newton."""
    requested = match.system.load.pivot
    if requested is None:
        return ""
    delta = 1e-6 * float(norm(match.system.body.center_of_mass - requested))
    pivot = np.array(requested, dtype=float)
    for _ in range(MOST_TRIES):
        if match.fits(_under(match, "pivot", pivot), SLACK):
            off = _vector(pivot - requested)
            return f"the pivot lies at {_vector(pivot)} m, {off} m from where it was requested"
        pivot = pivot + _change(match, "pivot", pivot, delta)
    return ""


def _apart(match: Match, one: Acceleration, other: Acceleration) -> Array:
    """All components of a difference in one row, each state's in parts of its bound."""
    angular = (one.angular - other.angular) / match.angular_bound[:, None]
    linear = (one.linear - other.linear) / match.linear_bound[:, None]
    return np.concatenate([np.ravel(angular), np.ravel(linear)])


def _vector(values: Array) -> str:
    return f"({', '.join(f'{value:.6g}' for value in values)})"


def constant_inertia(match: Match) -> str:
    """Another inertia, the same at every state: ``I w_dot + w x I w = tau`` solved for I.

    Without any torque its size stays open, and is taken to be the requested one's.
    """
    w, w_dot = match.states.angular_velocity, match.found.angular
    (i, j), basis, six = np.triu_indices(3), np.zeros((6, 3, 3)), range(6)
    basis[six, i, j] = basis[six, j, i] = 1.0  # of the symmetric tensors
    columns = [apply(one, w_dot) + cross(w, apply(one, w)) for one in basis]
    weight = 1.0 / match.angular_bound[:, None]
    lines = np.stack([np.ravel(column * weight) for column in columns], axis=-1)
    requested, moment = moving_inertia(match.system), torque(match.system, match.states)
    if np.any(moment):
        found = np.linalg.lstsq(lines, np.ravel(moment * weight), rcond=None)[0]
        tensor = np.tensordot(found, basis, 1)
    else:
        tensor = np.tensordot(np.linalg.svd(lines, full_matrices=False)[2][-1], basis, 1)
        tensor = tensor * np.trace(requested) / np.trace(tensor)
    moments = np.linalg.eigvalsh(tensor)
    if not moments[0] > 0.0:
        return ""
    angular = apply(inverse(tensor), moment - cross(w, apply(tensor, w)))
    linear = match.true.linear
    if match.system.load.pivot is not None:
        linear = center_of_mass_acceleration(match.system, match.states, angular)
    if not match.fits(Acceleration(angular, linear), SLACK * moments[-1] / moments[0]):
        return ""
    off = float(np.linalg.norm(tensor - requested, 2) / np.linalg.norm(requested, 2))
    text = f"the dynamics are those of another inertia, {100 * off:.2g} % off"
    return f"{text}: its moments are {_vector(moments)} kg m^2"


def difference_quotient(match: Match) -> str:
    """omega-dot as ``(omega(t + h) - omega(t)) / h``, one h at all states.

    It is off by ``h/2`` times the second derivative; the third bounds what is left, by h times the
    fastest rate of the size of the first.
    """
    motion, states = attitude_motion(match.system), match.states
    rate = float(np.max(norm(match.states.angular_velocity)))
    if not rate > 0.0:
        return ""
    delta, step = 1e-4 / rate, SCHEMES["lie-rk4"].step
    ahead, behind = (
        motion.acceleration(*step(motion, states.orientation, states.angular_velocity, h))
        for h in (delta, -delta)
    )
    second = (ahead - behind) / (2 * delta)
    rest = match.found.angular - match.true.angular
    weight = 1.0 / match.angular_bound[:, None]
    line = np.ravel(0.5 * second * weight)
    h = float(np.ravel(rest * weight) @ line / (line @ line))
    left = norm(rest - 0.5 * h * second)
    if not 0.0 < h * rate < 0.1:
        return ""
    allowed = 4.0 * h * rate * (0.5 * h * norm(second)) + SLACK * match.angular_bound
    # where the second derivative is small the third is not: the sizes of both count
    allowed = allowed + h**2 * rate**2 * norm(match.true.angular)
    if not np.all(left <= allowed):
        return ""
    return f"omega-dot looks like a difference quotient over {h:.2g} s"
