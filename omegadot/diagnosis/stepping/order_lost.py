"""The orders that an integrator has lost, over the scenarios of a run, as text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from omegadot.diagnosis.wording.digits import factor, listed

CHANNELS = ("omega", "attitude", "position", "linear_momentum")
RATES = {
    "omega": "omega-dot",
    "attitude": "omega",
    "position": "the velocity",
    "linear_momentum": "the acceleration",
}
NAMED = {
    "attitude": "the attitude",
    "linear_momentum": "the linear velocity",
    "position": "the position",
}
TERMS = ("the gyroscopic term", "the damping", "the torque of gravity", "the applied torque")
HALF = 0.5  # an order
EVEN = 0.05  # how near a part lies to the plain number that it is taken for


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
        for channel in (c for c in CHANNELS if c in self.orders):
            named.setdefault(self.orders[channel], []).append(NAMED.get(channel, channel))
        texts = [
            f"the error of one step goes as step^{order + 1} in {listed(names)}: that is of order "
            f"{order}, where {due} is declared"
            for (order, due), names in named.items()
        ]
        return "; ".join([*texts, *(self.by[c] for c in CHANNELS if c in self.by)])


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
        f"in short steps {listed(names)} {'keep' if len(held) > 1 else 'keeps'} the value of the "
        "step's start"
    )
    whole = moves("omega", 0.0)
    if held != there:
        return terms
    return whole if len(there) > 1 else f"either {whole}, or {terms}"


def moves(channel: str, part: float) -> str:
    """What the second-order term of a step shows: in which place of the step a rate is taken."""
    what, rate = NAMED.get(channel, channel), RATES[channel]
    for k, when in ((0.0, "start"), (2.0, "end")):
        if abs(part - k) < EVEN:
            return f"{what} moves by {rate} of the step's {when}"
    return f"the second-order term of {what} is {factor(part)} times that of the equation"
