"""Of which order single steps are: their error next to the motion itself, as they are halved."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from omegadot.diagnosis.equations.operators.operands import gyroscopic
from omegadot.diagnosis.stepping.order_lost import EVEN, TERMS, OrderLost, moves
from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION, norm
from omegadot.gates.steps.probe import Probe
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, rotation_between
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System

WHOLE = 0.2  # how near an exponent lies to the whole number that it is taken for
# Times rounding: that of one step then changes the exponent of a halved error by half as much.
CLEAR = 2.0 * ROUNDINGS_PER_EVALUATION / (WHOLE * np.log(2.0))
LEAST = 3  # states that show it
PARTS = 4  # of each step, in which the motion itself is stepped
HALVINGS = 4  # of the longest steps, with which the error is clear of rounding
OF_CHANNEL = {
    "omega": "angular_velocity",
    "attitude": "orientation",
    "position": "position",
    "linear_momentum": "linear_velocity",
}
TORQUES: dict[str, Callable[[System, State], Array]] = dict(
    zip(TERMS, (gyroscopic, damping_torque, gravity_torque, applied_torque), strict=True)
)
DELTA = 1e-4  # rad, of a derivative
NOTHING = 1e-6


def order_lost(
    system: System, probe: Probe, stepped: State, eps: float, declared: Mapping[str, int | None]
) -> OrderLost | None:
    """The orders that single steps have lost; None where no channel's is clear and too low.

    stepped: (m, k, ...), the ends of the probe's steps (m, k).
    """
    lost, by = dict[str, tuple[int, int]](), dict[str, str]()
    held, sound = None, set[str]()
    for channel, (order, part) in _orders(system, probe, stepped, eps).items():
        due = declared.get(channel)
        if due is None or order >= due:
            sound.add(channel)
            continue
        lost[channel] = order, due
        if part is not None:
            by[channel] = moves(channel, part)
        if channel == "omega" and order == 1:
            held = _held_terms(system, probe, stepped)
    return OrderLost(lost, by, held, frozenset(sound)) if lost else None


def _held_terms(
    system: System, probe: Probe, stepped: State
) -> tuple[frozenset[str], frozenset[str]] | None:
    """Terms of omega-dot that change, and those that a step takes at its start; None if it is open.

    The second-order term of omega is ``h^2/2`` of the derivatives of all terms: those of a term
    that is held are left out of it.
    """
    states = probe.states
    rate = float(np.max(norm(states.angular_velocity))) or 1.0
    delta, scheme = DELTA / rate, SCHEMES["munthe-kaas-rk4"]
    ahead, behind = (step_body(scheme, system, states, h, 1, 1)[1][-1] for h in (delta, -delta))
    back = inverse(moving_inertia(system))
    slopes = {
        name: apply(back, term(system, ahead) - term(system, behind)) / (2.0 * delta)
        for name, term in TORQUES.items()
    }
    total = sum(slopes.values(), 0.0 * states.angular_velocity)
    kept = {name: one for name, one in slopes.items() if np.any(norm(one) > NOTHING * norm(total))}
    h = probe.timesteps[:, HALVINGS - 1 : HALVINGS + 1]
    w_dot = forward_dynamics(system, states).angular[:, None]
    came = stepped.angular_velocity[:, HALVINGS - 1 : HALVINGS + 1]
    second = (
        2.0 * (came - states.angular_velocity[:, None] - h[..., None] * w_dot) / h[..., None] ** 2
    )
    second = 2.0 * second[:, 1] - second[:, 0]
    weight = 1.0 / np.maximum(norm(total), NOTHING * np.max(norm(total)))[:, None]
    lines = np.stack([np.ravel(one * weight) for one in kept.values()], axis=-1)
    target = np.ravel(second * weight)
    if not (lines.size and np.isfinite(lines).all() and np.isfinite(target).all()):
        return None
    parts = np.linalg.lstsq(lines, target, rcond=None)[0]
    left = np.max(np.abs(lines @ parts - target))
    held = frozenset(name for name, part in zip(kept, parts, strict=True) if abs(part) < EVEN)
    sound = [part for part in parts if abs(part - 1.0) < EVEN]
    if left > EVEN or len(held) + len(sound) < len(kept):
        return None
    return frozenset(kept), held


def _orders(
    system: System, probe: Probe, stepped: State, eps: float
) -> dict[str, tuple[int, float | None]]:
    """The order of each channel in which most states agree on one.

    With it, where it is 1, what the second-order term of a step is of the right one, if it is the
    same at all states.
    """
    kept = slice(0, HALVINGS + 1)
    h = probe.timesteps[:, kept]
    many = State(*(np.repeat(f[:, None], h.shape[1], axis=1) for f in vars(probe.states).values()))
    scheme = SCHEMES["munthe-kaas-rk4"]
    a = forward_dynamics(system, probe.states)
    rates = {
        "omega": a.angular,
        "attitude": probe.states.angular_velocity,
        "position": probe.states.linear_velocity,
        "linear_momentum": a.linear,
    }
    exact = step_body(scheme, system, many, h / PARTS, PARTS, PARTS)[1][-1]
    found = dict[str, tuple[int, float | None]]()
    for channel, name in OF_CHANNEL.items():
        if system.load.pivot is not None and channel in ("position", "linear_momentum"):
            continue
        came, due, start = (getattr(x, name) for x in (stepped, exact, many))
        order = _order(came[:, kept], due, start, eps)
        if order is not None:
            rate = rates[channel][:, None] * h[..., None]
            part = _second_order(came[:, kept], due, start, rate) if order == 1 else None
            found[channel] = (order, part)
    return found


def _second_order(came: Array, due: Array, start: Array, first: Array) -> float | None:
    """What the second-order terms of steps are of the right ones; None where it differs.

    first: (m, k, 3), the terms of first order.
    """
    turns = due.shape[-1] == 4
    off = rotation_between(due, came) if turns else came - due
    right = (rotation_between(start, due) if turns else due - start) - first
    with np.errstate(all="ignore"):
        parts = np.sum(off * right, axis=-1) / np.sum(right * right, axis=-1)
        left = norm(off - parts[..., None] * right) / norm(off)
    here = 2.0 * parts[:, -1] - parts[:, -2]  # the terms of third order taken off
    good = np.isfinite(here) & (left[:, -1] < EVEN)
    if np.count_nonzero(good) < max(LEAST, 0.8 * np.count_nonzero(np.isfinite(here))):
        return None
    middle = float(np.median(here[good]))
    even = np.abs(here[good] - middle) < EVEN
    return 1.0 + middle if np.mean(even) > 0.8 else None


def _order(came: Array, due: Array, start: Array, eps: float) -> int | None:
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
        whole = float(np.round(used[-1])) if len(used) >= 2 else 0.0
        # below order 1 it is rounding
        if np.isfinite(whole) and whole >= 2.0 and np.all(np.abs(used[-2:] - whole) < WHOLE):
            orders.append(int(whole) - 1)
    if len(orders) < LEAST:
        return None
    values, counts = np.unique(orders, return_counts=True)
    best = int(values[np.argmax(counts)])
    return best if 2 * int(np.max(counts)) > len(orders) else None
