"""Causes of a wrong equation: what the engine's accelerations and torques match instead."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.fits import (
    constant_inertia,
    difference_quotient,
    other_pivot,
    scaled_terms,
    term_of,
    with_term,
)
from omegadot.diagnosis.match import Match, only_where
from omegadot.diagnosis.misreadings import OF_ANY_STATE
from omegadot.diagnosis.model import mistaken_inertias
from omegadot.gates.case import Case
from omegadot.gates.equation import BOUND, EvaluationStates, forward_rows, inverse_rows
from omegadot.gates.scales import norm, torque_size
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import damping_torque, gravity_torque, weight
from omegadot.reference_impl.motion import (
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System


def causes(case: Case, evaluation_states: EvaluationStates, result: CaseResult) -> list[str]:
    """What forward dynamics match instead; inverse dynamics where forward ones are sound."""
    system, states = case.system, evaluation_states.random
    if not result.forward.ok:
        return []
    found = Acceleration(**result.forward.result)
    rows = forward_rows(system, states, found, "residual")
    if any(row.verdict == "fail" for row in rows):
        return _forward(Match(system, states, found))
    if result.inverse.ok:
        torque = result.inverse.result["torque"]
        rows = inverse_rows(system, states, evaluation_states.acceleration, torque)
        if any(row.verdict == "fail" for row in rows):
            return _inverse(system, states, evaluation_states.acceleration, torque)
    return []


def _forward(match: Match) -> list[str]:
    reported = {"omega-dot": match.found.angular, "the linear acceleration": match.found.linear}
    for what, values in reported.items():
        finite = int(np.count_nonzero(np.isfinite(values).all(-1)))
        if finite < len(values):
            return [f"{what} is not finite at {len(values) - finite} of {len(values)} states"]
    scaled = scaled_terms(match)
    if scaled:
        return [scaled]
    if len(match.found.angular) > 1 and not np.any(np.diff(match.found.angular, axis=0)):
        return ["omega-dot is the same at every state"]
    for text, candidate in (*_reported(match), *_misread(match), *_other_systems(match)):
        if match.fits(candidate):
            return [text]
    for fit in (other_pivot, constant_inertia, difference_quotient):
        text = fit(match)
        if text:
            return [text]
    where = only_where(match.states, match.sound)
    return [f"the equation holds at some states, and is wrong only where {where}"] if where else []


def _reported(match: Match) -> Iterator[tuple[str, Acceleration]]:
    """Accelerations that are right and reported in another frame, or of another point."""
    q, true, system = match.states.orientation, match.true, match.system
    world = Acceleration(rotate(q, true.angular), true.linear)
    yield "omega-dot looks like world axes: it matches after R^T", world
    back = Acceleration(rotate_inverse(q, true.angular), true.linear)
    yield "omega-dot looks turned twice: it matches after R", back
    yield "omega-dot has the wrong sign", Acceleration(-true.angular, true.linear)
    body = Acceleration(true.angular, rotate_inverse(q, true.linear))
    yield "the linear acceleration looks like body axes: it matches after R", body
    w, c = match.states.angular_velocity, system.body.center_of_mass
    lever = rotate(q, cross(true.angular, c) + cross(w, cross(w, c)))
    of_origin = Acceleration(true.angular, true.linear - lever)
    yield "the linear acceleration looks like that of the body's origin", of_origin


def _misread(match: Match) -> Iterator[tuple[str, Acceleration]]:
    """The equation at states that were misread on the way in."""
    for one in OF_ANY_STATE:
        states = place_on_pivot(match.system, one.right(match.states))
        there = forward_dynamics(match.system, states)
        yield f"on the way in, {one.statement}", there
        q = match.states.orientation
        turned = Acceleration(rotate(q, there.angular), there.linear)
        yield f"on the way in, {one.statement}, and omega-dot comes out in world axes", turned


def _other_systems(match: Match) -> Iterator[tuple[str, Acceleration]]:
    """The equation of another body or load."""
    system, states = match.system, match.states
    load, body = system.load, system.body
    swapped = replace(load, torque_body=load.torque_world, torque_world=load.torque_body)
    loads = {"the applied torque is taken in the wrong frame": swapped}
    if load.pivot is not None:
        loads["the pivot is ignored: the body moves freely"] = replace(load, pivot=None)
        at_origin = replace(load, pivot=np.zeros_like(load.pivot))
        loads["the body is pivoted at its origin instead of the pivot"] = at_origin
        loads["the pivot has the wrong sign"] = replace(load, pivot=-load.pivot)
    for text, other in loads.items():
        yield text, forward_dynamics(replace(system, load=other), states)
    force = rotate_inverse(states.orientation, weight(system))
    weight_moved = with_term(match, term_of(match, cross(-body.center_of_mass, force)))
    yield "gravity acts at the body's origin instead of the centre of mass", weight_moved
    yield "gravity is fixed to the body instead of the world", _gravity_in_body(match)
    centers = {
        "the centre of mass is ignored": 0 * body.center_of_mass,
        "the centre of mass has the wrong sign": -body.center_of_mass,
    }
    for text, center in centers.items():
        moved = replace(system, bodies=(replace(body, center_of_mass=center),))
        yield text, forward_dynamics(moved, states)
    for text, tensor in mistaken_inertias(body, system):
        if np.linalg.eigvalsh(tensor)[0] > 0.0:
            other_body = replace(system, bodies=(replace(body, inertia=tensor),))
            yield f"in the dynamics, {text}", forward_dynamics(other_body, states)


def _gravity_in_body(match: Match) -> Acceleration:
    system, q = match.system, match.states.orientation
    g = system.load.gravity
    if system.load.pivot is None:
        return Acceleration(match.true.angular, match.true.linear - g + rotate(q, g))
    r = system.body.center_of_mass - system.load.pivot
    moment = cross(r, system.body.mass * (g - rotate_inverse(q, g)))
    return with_term(match, term_of(match, moment))


def _inverse(system: System, states: State, requested: Acceleration, torque: Array) -> list[str]:
    """What the torque of inverse dynamics leaves out or counts, forward dynamics being sound."""
    true, w = inverse_dynamics(system, states, requested), states.angular_velocity
    gyroscopic = cross(w, apply(moving_inertia(system), w))
    gravity = gravity_torque(system, states)
    candidates = {
        "inverse dynamics leave out the gyroscopic term": true - gyroscopic,
        "inverse dynamics have the gyroscopic term's sign wrong": true - 2 * gyroscopic,
        "inverse dynamics leave out gravity": true + gravity,
        "inverse dynamics count damping among what is given": true - damping_torque(system, states),
        "inverse dynamics reports the torque in world axes": rotate(states.orientation, true),
        "inverse dynamics have the wrong sign": -true,
    }
    bound = BOUND * torque_size(system, states, requested)
    for text, candidate in candidates.items():
        if np.all(norm(torque - candidate) <= bound):
            return [text]
    return []
