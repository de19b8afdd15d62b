"""Of which order single steps are: their error next to the motion itself, as they are halved."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from omegadot.gates.bounds.scales import norm
from omegadot.gates.steps.vanishing_step import Probe
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System
from omegadot.reports.text.numbers import listed

CLEAR = 1e3  # times rounding
WHOLE = 0.2  # how near an exponent lies to the whole number that it is taken for
LEAST = 3  # states that show it
PARTS = 4  # of each step, in which the motion itself is stepped
HALVINGS = 4  # of the longest steps, with which the error is clear of rounding
OF_CHANNEL = {
    "omega": "angular_velocity",
    "attitude": "orientation",
    "position": "position",
    "linear_momentum": "linear_velocity",
}
NAMED = {"linear_momentum": "the linear velocity", "position": "the position"}


def order_lost(
    system: System, probe: Probe, stepped: State, eps: float, declared: Mapping[str, int | None]
) -> str:
    """``a step's error goes as its length^2 in omega: it is of order 1, where 2 is declared``.

    "" where no channel's order is clear and below the declared one. stepped: (m, k, ...), the ends
    of the probe's steps (m, k).
    """
    lost = dict[tuple[int, int], list[str]]()
    for channel, order in _orders(system, probe, stepped, eps).items():
        due = declared.get(channel)
        if due is not None and order < due:
            lost.setdefault((order, due), []).append(NAMED.get(channel, channel))
    return "; ".join(
        f"the error of one step goes as step^{order + 1} in {listed(names)}: that is of order "
        f"{order}, where {due} is declared"
        for (order, due), names in lost.items()
    )


def _orders(system: System, probe: Probe, stepped: State, eps: float) -> dict[str, int]:
    """The order of each channel in which most states agree on one."""
    kept = slice(0, HALVINGS + 1)
    h = probe.timesteps[:, kept]
    many = State(*(np.repeat(f[:, None], h.shape[1], axis=1) for f in vars(probe.states).values()))
    scheme = SCHEMES["munthe-kaas-rk4"]
    exact = step_body(scheme, system, many, h / PARTS, PARTS, PARTS)[1][-1]
    found = dict[str, int]()
    for channel, name in OF_CHANNEL.items():
        if system.load.pivot is not None and channel in ("position", "linear_momentum"):
            continue
        order = _order(*(getattr(x, name) for x in (stepped, exact, many)), kept, eps)
        if order is not None:
            found[channel] = order
    return found


def _order(came: Array, due: Array, start: Array, kept: slice, eps: float) -> int | None:
    came = came[:, kept]
    turns = due.shape[-1] == 4
    error = attitude_angle(came, due) if turns else norm(came - due)
    size = 1.0 if turns else norm(due) + norm(start)
    clear = error > CLEAR * eps * size
    with np.errstate(all="ignore"):
        powers = np.log2(error[:, :-1] / error[:, 1:])
    orders = list[int]()
    for row, good in zip(powers, clear, strict=True):
        used = row[: int(np.argmin(good)) - 1 if not good.all() else len(row)]
        # the longest steps have terms of their own
        if len(used) >= 2 and np.all(np.abs(used[-2:] - np.round(used[-1])) < WHOLE):
            orders.append(int(np.round(used[-1])) - 1)
    if len(orders) < LEAST:
        return None
    values, counts = np.unique(orders, return_counts=True)
    best = int(values[np.argmax(counts)])
    return best if 2 * int(np.max(counts)) > len(orders) else None
