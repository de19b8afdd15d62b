"""Gate 3, scheme: an engine's steps against those it declares, and the order of its errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.harness.gates.course import CHANNELS, Course, Declared, order_of
from omegadot.harness.likeness import Likeness, like_schemes, likeness
from omegadot.harness.rows import Row
from omegadot.harness.truth import Truth
from omegadot.harness.verdicts import ORDER_TOLERANCE
from omegadot.reference_impl.system import State

GATE = "scheme"
# Rounding is then a tenth of the error at most, and its bound is seldom reached.
CLEAR_OF_ROUNDING = 10.0
# Beyond half a radian, or half its size, an error is no longer a power of the step: it saturates.
SATURATED = 0.5
BLOWN_UP = "not judged: the scheme itself blows up at so large a step"


@dataclass(frozen=True)
class Sight:
    """The runs of a sweep that can show the order of one channel, and why others cannot."""

    courses: list[Course]
    reason: str


def _saturated(course: Course) -> bool:
    return any(not np.max(course.error[c]) <= SATURATED for c in ("omega", "attitude"))


def _sight(courses: list[Course], channel: str) -> Sight:
    unsaturated = [course for course in courses if not _saturated(course)]
    clear = [
        course
        for course in unsaturated
        if np.max(course.error[channel]) > CLEAR_OF_ROUNDING * np.max(course.round_off[channel])
    ]
    if len(clear) == len(courses):
        return Sight(clear, "not resolved by this sweep")
    why = "errors saturate" if len(unsaturated) < len(courses) else "errors are close to rounding"
    return Sight(clear, f"not resolved by this sweep: {why}")


def order_rows(courses: list[Course], declared: Declared, course: Course) -> list[Row]:
    """The observed order of every channel with an error above rounding, against the declared one.

    Judged where the two finest slopes agree, from errors that stand clear of rounding and do not
    saturate. A channel in which the engine equals its declared scheme is not held to an order that
    the scheme does not show here either.
    """
    found = []
    for channel in CHANNELS:
        shown = order_of(courses, channel)
        if shown is None:
            continue
        sight, bound = _sight(courses, channel), declared.orders[channel]
        clear = order_of(sight.courses, channel)
        value = (clear or shown).value
        verdict, note = "info", sight.reason
        if clear is not None and clear.resolved:
            verdict, note = _held_to(clear.value, bound, _explained(course, channel))
        limit = None if bound is None else float(bound)
        found.append(Row(GATE, channel, "observed_order", value, "1", limit, verdict, note))
    return found


def _explained(course: Course, channel: str) -> bool:
    left = course.against_scheme.get(channel)
    return left is not None and bool(np.all(left <= course.round_off[channel]))


def _held_to(value: float, declared: int | None, explained: bool) -> tuple[str, str]:
    if declared is None:
        return "info", "no order is declared"
    if value >= declared - ORDER_TOLERANCE:
        return "pass", ""
    if explained:
        return "info", "below the declared order, as the scheme itself is on this motion"
    return "fail", f"observed order {value:.2f}, declared {declared}"


def match_row(truth: Truth, integrator: Integrator, course: Course, state: State) -> Row:
    """The largest distance from the declared scheme, in parts of its round-off bound.

    An engine that declares a scheme and steps another fails, even where its error shrinks as it
    should: what it says of itself is wrong. One that declares none is told what it equals.
    """
    if course.against_scheme:
        found = likeness(course.against_scheme, course.round_off)
        return _declared_row(truth, integrator, course, state, found)
    if integrator.scheme is not None:
        note = f"the reference has no run of {integrator.scheme} to hold this against"
        return _row(Likeness(float("nan"), "omega", float("nan")), "info", note)
    alike = like_schemes(truth, course.sweep, state)
    nearest = min(alike.values(), key=lambda one: (np.isnan(one.share), one.share), default=None)
    if nearest is None:
        nothing = Likeness(float("nan"), "omega", float("nan"))
        return _row(nothing, "info", "declares no scheme, and none was stepped beside it")
    equals = [key.scheme for key, one in alike.items() if one.agree]
    said = f"declares no scheme, and equals {' and '.join(dict.fromkeys(equals)) or 'none known'}"
    return _row(nearest, "info", said)


def _row(found: Likeness, verdict: str, note: str) -> Row:
    return Row(GATE, found.channel, "match", found.share, "1", 1.0, verdict, note)


def _declared_row(
    truth: Truth, integrator: Integrator, course: Course, state: State, found: Likeness
) -> Row:
    if np.isnan(found.share):
        return _row(found, "info", BLOWN_UP)
    if found.agree:
        return _row(found, "pass", f"equals {integrator.scheme}, to {found.distance:.1e}")
    alike = like_schemes(truth, course.sweep, state)
    others = dict.fromkeys(key.scheme for key, one in alike.items() if one.agree)
    instead = f"equals {' and '.join(others)}" if others else "steps otherwise"
    said = f"declares {integrator.scheme}, but {instead}: {found.channel} parts from it"
    return _row(found, "fail", f"{said} {found.share:.0e} times as far as rounding can")
