"""What the first step of a run takes of the run before it, in place of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.evidence import BEYOND_ROUNDING, SLACK
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, better
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import acceleration_of
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System
from omegadot.written import written

SAME = 1e-9  # rad
OWN = "the same integrator, of the same system"
CLOSE = 1e-6  # relative: what the extrapolation of a step to none is known to at least
WHOLE = 1e-6  # a part that is all of it
NEARER = 2.0**-6  # after eight halvings, between what two and none of them leave
FEWEST = 2  # runs that show it
MOST_NAMED = 3  # between which nothing decides
Quantity = Callable[[System, State], Array]


@dataclass(frozen=True)
class AfterRun:
    """First steps, ever shorter, from one state after one run.

    kind: of the run before.  system and path (n + 1,): that run's, and its states before a step of
    no length.  each: the path before each of the steps, and the end of this step; the last is the
    shortest.  steps: (1,), from the state.  same_step: the end of a step as long as those before.
    evaluated: where that run's scheme takes its last rates, if it is known.
    """

    kind: str
    system: System
    path: State
    each: tuple[tuple[State, State], ...]
    steps: VanishingSteps
    same_step: State
    evaluated: State | None = None

    def at(self, place: str) -> State | None:
        """The state at one of PLACES; None where it is not known, or has another name."""
        index = PLACES[place]
        if index is not None:
            return self.path[index]
        return None if place == STAGE and self.ends_on_path else self.evaluated

    @property
    def ends_on_path(self) -> bool:
        """Whether the last rates are taken at a state on the path."""
        if self.evaluated is None:
            return False
        attitudes = (attitude_angle(self.evaluated.orientation, q) for q in self.path.orientation)
        return any(angle <= SAME for angle in attitudes)

    def rate_off(self, channel: str) -> tuple[Array, Array, float]:
        """How far a rate of the first steps is off (3,), the right one, and the bound of both."""
        limit = self.steps.rates[channel]
        found, bound = better(limit)
        off = found[0] - limit.expected[0]
        return off, limit.expected[0], SLACK * float(bound[0])


STAGE, LAST = "at the last stage of", "that was evaluated last in"
PLACES: dict[str, int | None] = {  # of a run, as the place of a state on its path
    "at the start of": 0,
    "at the start of the last step of": -2,
    "at the end of": -1,
    STAGE: None,
    LAST: None,  # of whatever integrator
}
# Of the first stage of a step, in schemes of several.
WEIGHTS = {1 / 6: "RK4", 1 / 8: "the 3/8 rule", 1 / 4: "Heun's third-order scheme"}


def _gyroscopic(system: System, state: State) -> Array:
    w = state.angular_velocity
    return -cross(w, apply(moving_inertia(system), w))


# By channel: what a step goes by, and whether that is a torque, which the inertia is yet to divide.
TAKEN: dict[str, dict[str, tuple[Quantity, bool]]] = {
    "omega": {
        "omega-dot": (lambda system, state: acceleration_of(system)(state).angular, False),
        "gyroscopic torque": (_gyroscopic, True),
        "torque of the damping": (damping_torque, True),
        "torque of the weight": (gravity_torque, True),
        "applied torque": (applied_torque, True),
    },
    "attitude": {"omega": (lambda _, state: state.angular_velocity, False)},
    "linear_momentum": {
        "linear acceleration": (lambda system, state: acceleration_of(system)(state).linear, False)
    },
    "position": {"linear velocity": (lambda _, state: state.linear_velocity, False)},
}
NAMES = {
    "angular_velocity": "omega",
    "orientation": "attitude",
    "linear_velocity": "linear velocity",
    "position": "position",
}


def taken_of_run_before(seen: Sequence[AfterRun]) -> str:
    """What is taken of the run before, if it makes all of these first steps; "" without any."""
    return next(_causes(seen), "")


def _causes(seen: Sequence[AfterRun]) -> Iterator[str]:
    if _of_same_length(seen):
        yield "the first step of a run has the length of the steps of the run before"
        return
    for name, what in NAMES.items():
        text = _of_start(seen, name, what)
        if text:
            yield text
            return
    if any(np.any(one.steps.jumps) for one in seen):
        return  # what a step starts from is another, and no rate of it is one
    for channel, quantities in TAKEN.items():
        found = [
            one
            for what, (quantity, torque) in quantities.items()
            for place in PLACES
            for one in _of_rate(seen, channel, f"{what} {place}", quantity, torque, place)
        ]
        most = max((fits for fits, _ in found), default=(0, False))
        texts = [text for fits, text in found if fits == most]
        if texts and len(texts) <= MOST_NAMED:
            yield texts[0] if len(texts) == 1 else "either " + ", or ".join(texts)


def _of_same_length(seen: Sequence[AfterRun]) -> bool:
    """Whether a step of no length ends where one does of the length of those before."""
    own = [one for one in seen if one.kind == OWN]
    moved = [not _same(one.same_step, one.steps.states[0]) for one in own]
    return (
        len(own) >= FEWEST
        and all(moved)
        and all(_same(one.steps.limit[0], one.same_step) for one in own)
    )


def _same(one: State, other: State) -> bool:
    pairs = zip(vars(one).values(), vars(other).values(), strict=True)
    return all(norm(a - b) <= CLOSE * norm(b) for a, b in pairs)


def _of_start(seen: Sequence[AfterRun], name: str, what: str) -> str:
    """Of which state a quantity is that the first step starts with, in place of the one set."""
    own = [one for one in seen if one.kind == OWN]
    for place, index in PLACES.items():
        if index is None or len(own) < FEWEST:
            continue
        if all(_starts_from(one, name, index) for one in own):
            return f"the first step of a run starts from the {what} {place} the run before"
    return ""


def _starts_from(one: AfterRun, name: str, index: int) -> bool:
    """Whether shorter steps end ever nearer to a state of the run before, and not to the one set.

    Of an engine that starts from an old state each of the runs before is another.
    """
    ends = [(getattr(path, name)[index], getattr(end, name)) for path, end in one.each]
    left = [float(norm(end - kept)) for kept, end in ends]
    moved = float(norm(ends[-1][1] - getattr(one.steps.states, name)[0]))
    return moved > 0.0 and left[-1] <= NEARER * min(left[0], moved)


def _of_rate(
    seen: Sequence[AfterRun], channel: str, what: str, quantity: Quantity, torque: bool, place: str
) -> Iterator[tuple[tuple[int, bool], str]]:
    """One sentence, where one part of it makes all that is off; none where it does not.

    With the number of kinds of runs before that it is so after, and whether it is the whole.
    """
    if place == LAST and len({one.ends_on_path for one in seen}) < 2:
        return  # it has a name of its own
    states = [(one, one.at(place)) for one in seen]
    rows = [
        (one.kind, *one.rate_off(channel), _other(one, quantity, torque, state))
        for one, state in states
        if state is not None
    ]
    free = [one for one in seen if one.steps.system.load.pivot is None]
    if channel in ("linear_momentum", "position") and len(free) < len(seen):
        return
    own = [(off, due) for kind, off, _, bound, due in rows if kind == OWN and norm(due) > bound]
    size = sum(float(due @ due) for _, due in own)
    if not size > 0.0:
        return
    part = sum(float(due @ off) for off, due in own) / size
    fits, shown = dict[str, list[bool]](), 0
    for kind, off, right, bound, due in rows:
        close = bound * (1.0 + abs(part)) + CLOSE * float(norm(right) + abs(part) * norm(due))
        if abs(part) * float(norm(due)) <= BEYOND_ROUNDING * close:
            continue
        shown += kind == OWN and bool(norm(off) > close)
        fits.setdefault(kind, []).append(bool(norm(off - part * due) <= close))
    if shown < FEWEST or not all(fits.get(OWN, [False])):
        return
    also = {kind: all(each) for kind, each in fits.items() if kind != OWN}
    yield (sum(also.values()), _whole(part)), _worded(what, part, also)


def _other(one: AfterRun, quantity: Quantity, torque: bool, state: State) -> Array:
    """What the rate is off by if it is taken as a whole, (3,)."""
    system = one.steps.system
    due = quantity(one.system, state) - quantity(system, one.steps.states[0])
    return apply(inverse(moving_inertia(system)), due) if torque else np.asarray(due)


def _whole(part: float) -> bool:
    return abs(part - 1.0) <= WHOLE


def _worded(what: str, part: float, also: dict[str, bool]) -> str:
    weights = (f" (the first stage of {of})" for w, of in WEIGHTS.items() if _whole(part / w))
    stage = next(weights, "")
    of = "" if _whole(part) else f"for a part of {written(part, 4)}{stage}, "
    others = [kind for kind, so in also.items() if so]
    never = [kind for kind, so in also.items() if not so]
    text = f"{of}the first step of a run takes the {what} the run before in place of its own"
    text += f", also {' and '.join(others)}" * bool(others)
    return text + f", but not {', nor '.join(never)}" * bool(never)
