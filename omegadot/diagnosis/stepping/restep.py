"""Step an engine's own dynamics by a scheme of the reference, whatever the engine itself steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.reference_impl.coordinates import Coordinates
from omegadot.reference_impl.motion import AccelerationOf
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.schemes import Motion, Scheme
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, State, System


def on_rows(forward: AccelerationOf) -> AccelerationOf:
    """An engine's forward dynamics, which takes n rows, for states of any leading axes."""

    def acceleration(state: State) -> Acceleration:
        fields = vars(state)
        lead = np.broadcast_shapes(*(f.shape[:-1] for f in fields.values()))
        rows = {
            name: np.broadcast_to(f, (*lead, f.shape[-1])).reshape(-1, f.shape[-1])
            for name, f in fields.items()
        }
        found = forward(State(**rows))
        return Acceleration(found.angular.reshape(*lead, 3), found.linear.reshape(*lead, 3))

    return acceleration


def step_again(
    system: System,
    acceleration: AccelerationOf,
    scheme: Scheme,
    coordinates: Coordinates,
    initial: State,
    plan: tuple[float, int, int],
    known: Motion | None = None,
) -> tuple[Array, State]:
    """Times and states of a scheme over any acceleration. plan: the step in s, steps, every.

    known: the motion of this acceleration, where there is one that is quicker.
    """
    over = known or motion_over(system, coordinates, acceleration)

    def at_unit(q: Array, v: Array) -> Array:  # a wrong step may leave q too long
        return over.acceleration(over.normalize(q), v)

    motion = replace(over, acceleration=at_unit)
    return step_body(scheme, system, initial, *plan, coordinates, motion)
