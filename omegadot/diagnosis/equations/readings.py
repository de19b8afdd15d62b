"""Right accelerations that are reported otherwise, or of states that were misread on the way in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.models.misreadings import OF_ANY_STATE, Misreading
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Acceleration


@dataclass(frozen=True)
class Reading:
    """One way to misread a state, or to report an acceleration."""

    text: str
    accelerations: Callable[[Evidence], Acceleration]


def _reported() -> Iterator[Reading]:
    def turned(e: Evidence) -> Acceleration:
        return Acceleration(rotate(e.states.orientation, e.true.angular), e.true.linear)

    def back(e: Evidence) -> Acceleration:
        return Acceleration(rotate_inverse(e.states.orientation, e.true.angular), e.true.linear)

    def negative(e: Evidence) -> Acceleration:
        return Acceleration(-e.true.angular, e.true.linear)

    def in_body(e: Evidence) -> Acceleration:
        return Acceleration(e.true.angular, rotate_inverse(e.states.orientation, e.true.linear))

    def upwards(e: Evidence) -> Acceleration:
        return Acceleration(e.true.angular, -e.true.linear)

    yield Reading("omega-dot looks like world axes: it matches after R^T", turned)
    yield Reading("omega-dot looks turned twice: it matches after R", back)
    yield Reading("omega-dot has the wrong sign", negative)
    yield Reading("the linear acceleration looks like body axes: it matches after R", in_body)
    yield Reading("the linear acceleration has the wrong sign", upwards)
    yield Reading(
        "the linear acceleration is zero", lambda e: Acceleration(e.true.angular, 0 * e.true.linear)
    )


def _misread(one: Misreading) -> Iterator[Reading]:
    def there(e: Evidence) -> Acceleration:
        return forward_dynamics(e.system, place_on_pivot(e.system, one.right(e.states)))

    def turned(e: Evidence) -> Acceleration:
        found = there(e)
        return Acceleration(rotate(e.states.orientation, found.angular), found.linear)

    yield Reading(f"on the way in, {one.statement}", there)
    yield Reading(f"on the way in, {one.statement}, and omega-dot comes out in world axes", turned)


READINGS = (*_reported(), *(reading for one in OF_ANY_STATE for reading in _misread(one)))
