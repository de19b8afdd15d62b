"""Gate 3, scheme: an engine's steps against those it declares, and the order of its errors."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.likeness import Likeness, like_schemes, likeness
from omegadot.gates.errors.findings import Declared, MeasuredSweep
from omegadot.gates.errors.measured_run import CHANNELS, MeasuredRun
from omegadot.gates.errors.observed_order import ORDER_TOLERANCE, VANISHED, ObservedOrder, is_whole
from omegadot.gates.errors.verdicts import STIFF
from omegadot.gates.rows import Row
from omegadot.gates.truth import SchemeKey, Truth, scheme_key
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.schemes import COMMON
from omegadot.reference_impl.system import State, System
from omegadot.written import written

GATE = "scheme"
BLOWN_UP = "not judged: the scheme itself blows up at so large a step"
OPENED = "beyond rounding, within what the scheme itself leaves open"
MOMENTUM = "the angular momentum, where it is what is stepped, may round by as much"
NOTHING = Likeness(float("nan"), "omega", float("nan"))


def orders_seen(sweep: MeasuredSweep) -> dict[str, ObservedOrder]:
    """The order of every channel with an error above rounding, from all runs of one sweep."""
    found = {channel: sweep.order(channel) for channel in CHANNELS}
    return {channel: order for channel, order in found.items() if order is not None}


def order_rows(
    seen: Mapping[str, ObservedOrder],
    declared: Declared,
    measured: MeasuredRun,
    stiffness: float = 0.0,
) -> list[Row]:
    """The orders that one integrator's sweep shows, against those that it declares.

    A channel in which the engine equals its declared scheme is not held to an order that the
    scheme does not show here either.  stiffness: of the finest step, see `verdicts.Evidence`.
    """
    found = []
    for channel, shown in seen.items():
        limit, left = declared.orders[channel], measured.against_scheme.get(channel)
        hidden = f": {shown.hidden}" if shown.hidden else ""
        verdict, note = "info", f"not resolved by this sweep{hidden}"
        if shown is VANISHED:
            verdict, note = "info", "the error falls into rounding"
        elif shown.resolved:
            explained = left is not None and bool(np.all(left <= measured.beside_scheme[channel]))
            verdict, note = _held_to(shown, limit, explained)
            if verdict == "fail" and stiffness > 1.0:
                verdict, note = "info", f"{STIFF}: {note}"
            if verdict == "fail" and measured.may_be_rounding(channel):
                verdict, note = "info", f"{MOMENTUM}: {note}"
        bound = None if limit is None else float(limit)
        found.append(Row(GATE, channel, "observed_order", shown.value, "1", bound, verdict, note))
    return found


def _held_to(order: ObservedOrder, declared: int | None, explained: bool) -> tuple[str, str]:
    if declared is None:
        return "info", "no order is declared"
    if order.value >= declared - ORDER_TOLERANCE:
        return "pass", ""
    if order.value + order.rise >= declared - ORDER_TOLERANCE:
        limit = order.value + order.rise
        return "info", f"not settled: the slopes are heading for {limit:.2f}"
    if not is_whole(order.value):
        return "info", f"not settled: observed order {order.value:z.2f}, declared {declared}"
    if explained:
        return "info", "below the declared order, as the scheme itself is on this motion"
    return "fail", f"observed order {order.value:z.2f}, declared {declared}"


def comparison_keys(integrator: Integrator, system: System) -> list[SchemeKey]:
    """The reference's runs to hold an integrator against: every common one's if it declares none.

    None of them for an error-controlled integrator, whose steps are its own.
    """
    if integrator.knob != "timestep":
        return []
    declared = scheme_key(integrator, system)
    if declared is not None:
        return [declared]
    coordinates = canonical(system, integrator.coordinates)
    return [
        SchemeKey(name, coordinates)
        for name, scheme in COMMON.items()
        if coordinates in scheme.coordinates
    ]


def match_row(truth: Truth, integrator: Integrator, measured: MeasuredRun, state: State) -> Row:
    """The largest distance from the declared scheme, in parts of its round-off bound.

    A declared scheme is a claim on every step, and this run alone decides it: an engine that steps
    another fails, however fast the difference vanishes with the step. Two schemes of order p always
    differ by terms of that order or a higher one, so that an order tells nothing of which is
    stepped. For an engine that declares none, the row names the schemes that it equals.
    """
    if measured.against_scheme:
        found = likeness(measured.against_scheme, measured.beside_scheme)
        return _declared_row(truth, integrator, measured, state, found)
    if integrator.scheme is not None:
        note = f"the reference has no run of {integrator.scheme} to hold this against"
        return _row(NOTHING, "info", note)
    alike = like_schemes(truth, measured.sweep, state)
    nearest = min(alike.values(), key=lambda one: (np.isnan(one.share), one.share), default=None)
    if nearest is None:
        return _row(NOTHING, "info", "declares no scheme, and none was stepped for comparison")
    equals = _equalled(alike) or "none known"
    return _row(nearest, "info", f"declares no scheme, and equals {equals}")


def _equalled(alike: Mapping[SchemeKey, Likeness]) -> str:
    return " and ".join(dict.fromkeys(key.scheme for key, one in alike.items() if one.agree))


def _row(found: Likeness, verdict: str, note: str) -> Row:
    return Row(GATE, found.channel, "match", found.share, "1", 1.0, verdict, note)


def _declared_row(
    truth: Truth, integrator: Integrator, measured: MeasuredRun, state: State, found: Likeness
) -> Row:
    if np.isnan(found.share):
        return _row(found, "info", BLOWN_UP)
    if found.agree:
        note = f"equals {integrator.scheme}, to {written(found.distance, 2)}"
        rounded = all(map(measured.equals_by_rounding, CHANNELS))
        return _row(found, "pass", note if rounded else f"{note}, {OPENED}")
    others = _equalled(like_schemes(truth, measured.sweep, state))
    instead = f"equals {others}" if others else "steps otherwise"
    text = f"declares {integrator.scheme}, but {instead}: {found.channel} diverges from it"
    return _row(found, "fail", f"{text} {written(found.share, 1)} times as far as rounding can")
