"""Step an engine's own dynamics by a scheme of the reference, whatever the engine itself steps."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.body_origin import from_origin, is_offset, to_origin
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.schemes import AccelerationOf, Scheme
from omegadot.reference_impl.stepping import step_through
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


def at_origin(system: System, of_center: AccelerationOf) -> AccelerationOf:
    """The same accelerations of states reported at the body's origin."""
    c = system.body.center_of_mass

    def acceleration(state: State) -> Acceleration:
        found, w = of_center(from_origin(system, state)), state.angular_velocity
        lever = cross(found.angular, c) + cross(w, cross(w, c))
        return Acceleration(found.angular, found.linear - rotate(state.orientation, lever))

    return acceleration


def step_again(
    system: System,
    acceleration: AccelerationOf,
    scheme: Scheme,
    origin: bool,
    initial: State,
    plan: tuple[float, int, int],
) -> tuple[Array, State]:
    """Times and states of a scheme over any acceleration. plan: the step in s, steps, every."""
    reported_at_origin = origin and is_offset(system)
    start = to_origin(system, initial) if reported_at_origin else initial
    rate = at_origin(system, acceleration) if reported_at_origin else acceleration
    times, states = step_through(scheme, system, rate, start, *plan)
    return times, from_origin(system, states) if reported_at_origin else states
