"""A system, or a state, with one thing changed: what an experiment on a condition is made of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from omegadot.harness.requests.opposite import ASIDE, PULL, opposites
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.rotations import turn_in_world
from omegadot.reference_impl.system import Array, State, System

FAR = 32.0  # times: more than what scenarios of one kind differ by
SCALES = (1e-3, 3e-2, 3e1, 1e3)  # of omega
UNEQUAL = (1.0, 1.2, 1.5)  # moments that any order leaves those of a body
PITCHED = np.array([0.0, 1.52, 0.0])  # rad: a pitch near a quarter turn


def other_loads(system: System) -> Iterator[tuple[str, System]]:
    """What acts on it, and where: one thing the other way, turned round, or all taken away."""
    yield from opposites(system)
    load, none = system.load, np.zeros(3)
    bare = replace(load, gravity=none, damping=np.zeros(()), torque_body=none, torque_world=none)
    torques = (np.any(load.torque_body) or np.any(load.torque_world), np.any(load.damping))
    if sum(map(bool, (*torques, np.any(load.gravity)))) > 1:
        yield "loads", replace(system, load=bare)
    for what in ("torque_body", "torque_world", "gravity"):
        vector = np.asarray(getattr(load, what))
        if np.any(vector):
            yield f"turned {what}", replace(system, load=replace(load, **{what: -vector}))
    gyration = np.sqrt(np.trace(system.body.inertia) / system.body.mass)
    if load.pivot is None:
        held = np.asarray(system.body.center_of_mass) - gyration * np.array(ASIDE)
        hanging = replace(load, pivot=held, gravity=np.array([0.0, 0.0, -PULL]))
        yield "weight", replace(system, load=hanging)
    elif np.any(lever(system)):
        on_it = replace(load, pivot=np.asarray(system.body.center_of_mass))
        yield "lever", replace(system, load=on_it)
        across = replace(system.body, center_of_mass=load.pivot - lever(system))
        yield "turned lever", replace(system, bodies=(across,))
        beyond = np.asarray(system.body.center_of_mass) + lever(system)
        yield "pivot beyond", replace(system, load=replace(load, pivot=beyond))


def other_bodies(system: System) -> Iterator[tuple[str, System]]:
    """Another inertia of the same trace, equal moments and orders among them; other sizes."""
    body, load = system.body, system.load
    mean = float(np.trace(body.inertia)) / 3.0

    def of_inertia(tensor: Array) -> System:
        return replace(system, bodies=(replace(body, inertia=tensor),))

    yield "sphere", of_inertia(mean * np.eye(3))
    for by in (1, 2):  # its own, about other axes: what two moments decide, two others do not
        yield f"rolled by {by}", of_inertia(np.roll(body.inertia, (by, by), (0, 1)))
    a, b, c = mean * np.array(UNEQUAL) * 3.0 / sum(UNEQUAL)
    for what, moments in (
        ("first", (b, b, c)),
        ("second", (c, b, b)),
        ("third", (b, c, b)),
        ("rising", (a, b, c)),
        ("falling", (c, b, a)),
        ("rolled", (b, c, a)),
        ("swapped", (b, a, c)),
    ):
        yield what, of_inertia(np.diag(moments))
    for what, k in (("more", FAR), ("less", 1.0 / FAR)):
        yield f"{what} mass", replace(system, bodies=(replace(body, mass=k * body.mass),))
        larger = replace(
            body, inertia=k**2 * body.inertia, center_of_mass=k * np.asarray(body.center_of_mass)
        )
        pivot = None if load.pivot is None else k * np.asarray(load.pivot)
        yield f"{what} size", replace(system, bodies=(larger,), load=replace(load, pivot=pivot))


def other_states(states: State) -> Iterator[tuple[str, State]]:
    """The same states (n,) with one thing changed; a pivoted body's place is the caller's."""
    w, q = states.angular_velocity, states.orientation

    def turning(omega: Array) -> State:
        return replace(states, angular_velocity=omega)

    yield "-q", replace(states, orientation=-q)
    yield "identity", replace(states, orientation=0.0 * q + np.array([1.0, 0.0, 0.0, 0.0]))
    yield "little turned", replace(states, orientation=_near_identity(q))
    about = [turn_in_world(0.0 * q + np.eye(4)[0], s * PITCHED, 1.0) for s in (1.0, -1.0)]
    yield from (("pitched", replace(states, orientation=one)) for one in about)
    for k in range(4):
        flipped = q * np.where(np.arange(4) == k, -1.0, 1.0)
        yield f"q{k} reversed", replace(states, orientation=flipped)
    for k, axis in enumerate("xyz"):
        here = np.arange(3) == k
        yield f"{axis} reversed", turning(np.where(here, -w, w))
        yield f"no {axis}", turning(np.where(here, 0.0, w))
        yield f"{axis} alone", turning(np.where(here, w, 0.0))
    yield from ((f"{k} times omega", turning(k * w)) for k in SCALES)
    still = np.zeros_like(w)
    yield "still", replace(states, linear_velocity=still)
    yield "at the origin", replace(states, position=still)


def _near_identity(q: Array) -> Array:
    """A hundredth of each turn, by the shorter way."""
    near = np.concatenate([np.abs(q[:, :1]) + 99.0, q[:, 1:] * np.sign(q[:, :1])], axis=-1)
    return np.asarray(near / np.linalg.norm(near, axis=-1, keepdims=True))
