"""Of which order single steps are: their error next to the motion itself, as they are halved."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.diagnosis.equations.operators.operands import gyroscopic
from omegadot.diagnosis.wording.digits import factor, listed
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
RATES = {
    "omega": "omega-dot",
    "attitude": "omega",
    "position": "the velocity",
    "linear_momentum": "the acceleration",
}
HALF = 0.5  # an order
EVEN = 0.05  # how near a part lies to the plain number that it is taken for
TERMS = {
    "the gyroscopic term": gyroscopic,
    "the damping": damping_torque,
    "the torque of gravity": gravity_torque,
    "the applied torque": applied_torque,
}
DELTA = 1e-4  # rad, of a derivative
NOTHING = 1e-6
NAMED = {
    "attitude": "the attitude",
    "linear_momentum": "the linear velocity",
    "position": "the position",
}


@dataclass(frozen=True)
class OrderLost:
    """Which channels are of a lower order than declared: (order, declared).

    by: what makes it, of each channel.  held: the terms of omega-dot that change in a step, and of
    these the ones that do not change in the engine's.  against: channels that single steps or whole
    runs show to be of a higher order.  has_past: the first step of a run is another than the rest.
    """

    orders: Mapping[str, tuple[int, int]]
    by: Mapping[str, str] = field(default_factory=dict)
    held: tuple[frozenset[str], frozenset[str]] | None = None
    against: frozenset[str] = frozenset()
    has_past: bool = False

    def over(self, observed: Mapping[str, float], declared: Mapping[str, int | None]) -> OrderLost:
        """Without what whole runs contradict. observed: their orders, where these are settled.

        What is lost in a single step and not in a run is lost in the report, or in a first step.
        """
        wrong = {
            c for c, (order, _) in self.orders.items() if observed.get(c, order) > order + HALF
        }
        orders = {c: one for c, one in self.orders.items() if c not in wrong}
        sound = {
            channel
            for channel, due in declared.items()
            if channel not in orders and due is not None and observed.get(channel, 0.0) > due - HALF
        }
        return replace(self, orders=orders, against=self.against | wrong | sound)

    @property
    def of_first(self) -> OrderLost:
        """Without what makes it: of steps that depend on the past the first is another."""
        return replace(self, by={}, held=None, has_past=True)

    def with_others(self, others: Iterable[OrderLost]) -> OrderLost:
        """One mistake shows in the channels that a scenario has: all of them over a run.

        Of a channel the lowest order counts; what some scenarios have no term for, others show. A
        channel that some show to be sound follows one that none does, where there is one.
        """
        every = [self, *others]
        orders = dict[str, tuple[int, int]]()
        for one in every:
            for channel, lost in one.orders.items():
                orders[channel] = min(lost, orders.get(channel, lost))
        sound = frozenset().union(*(one.against for one in every))
        unopposed = orders.keys() - sound
        kept = unopposed if unopposed & self.orders.keys() else set(self.orders)
        orders = {c: lost for c, lost in orders.items() if c in kept}
        by = {c: _agreed(c, every) for c in orders}
        held = [one.held for one in every if "omega" in one.orders and one.held is not None]
        if "omega" in orders and held:
            by["omega"] = _held_over(held)
        past = any(one.has_past for one in every)
        by = {c: text for c, text in by.items() if text and not past}
        return OrderLost(orders, by, None, self.against)

    @property
    def text(self) -> str:
        """``the error of one step goes as step^2 in omega: that is of order 1, where 2 is ..``."""
        named = dict[tuple[int, int], list[str]]()
        for channel in (c for c in OF_CHANNEL if c in self.orders):
            named.setdefault(self.orders[channel], []).append(NAMED.get(channel, channel))
        texts = [
            f"the error of one step goes as step^{order + 1} in {listed(names)}: that is of order "
            f"{order}, where {due} is declared"
            for (order, due), names in named.items()
        ]
        return "; ".join([*texts, *(self.by[c] for c in OF_CHANNEL if c in self.by)])


def _agreed(channel: str, every: Sequence[OrderLost]) -> str:
    """What makes a channel's error on half of the scenarios at least, none being against it."""
    losing = [one for one in every if channel in one.orders]
    texts = [one.by[channel] for one in losing if channel in one.by]
    return texts[0] if len(set(texts)) == 1 and 2 * len(texts) >= len(losing) else ""


def _held_over(every: Sequence[tuple[frozenset[str], frozenset[str]]]) -> str:
    """The terms that steps keep from their start, on every scenario that has them."""
    there = frozenset().union(*(kept for kept, _ in every))
    held = frozenset().union(*(one for _, one in every))
    if not held or any(held & kept != one for kept, one in every):
        return ""
    names = [name for name in TERMS if name in held]
    terms = (
        f"in a step {listed(names)} {'keep' if len(held) > 1 else 'keeps'} the value of its start"
    )
    whole = _moves("omega", 0.0)
    if held != there:
        return terms
    return whole if len(there) > 1 else f"either {whole}, or {terms}"


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
            by[channel] = _moves(channel, part)
        if channel == "omega" and order == 1:
            held = _held_terms(system, probe, stepped)
    return OrderLost(lost, by, held, frozenset(sound)) if lost else None


def _moves(channel: str, part: float) -> str:
    """What the second-order term of a step shows: in which place of the step a rate is taken."""
    what, rate = NAMED.get(channel, channel), RATES[channel]
    for k, when in ((0.0, "start"), (2.0, "end")):
        if abs(part - k) < EVEN:
            return f"{what} moves by {rate} of the step's {when}"
    return f"the second-order term of {what} is {factor(part)} times that of the equation"


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
        for name, term in TERMS.items()
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
