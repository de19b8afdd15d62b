"""Causes in the stepping: another scheme, another step, another force, a limit on omega."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations
from omegadot.diagnosis.equations.hypotheses import hypotheses, wrong_form
from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.slips import damping_ends, slipped
from omegadot.diagnosis.stepping.step_ends import (
    End,
    clipped_at,
    held_below,
    left_multiplied,
    second_order_turn,
    speed_below,
    straight_quaternion,
    turn_within,
    turned_by_last_omega,
    with_end,
)
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.body_motion import motion_over
from omegadot.reference_impl.coordinates import PHRASES, canonical, distinct
from omegadot.reference_impl.growth import changes
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State

ENDS: dict[str, End] = {
    "the attitude's change in body axes is multiplied from the left": left_multiplied,
    "the attitude is stepped as q + h/2 q omega and not normalised": straight_quaternion,
    "the attitude turns by the step's last omega alone": turned_by_last_omega,
    "the turn of a step is taken by the exponential's series to second order": second_order_turn,
}
MOST_TRIES = 8
CONVERGES = 0.3  # what a try must leave of the distance before it
MOST_STEPS = 5000  # causes are tried by stepping again, and a step takes about 0.1 ms
# A fitted run has come out of a search that ends within rounding, and bounds are of one run.
SLACK = 4.0
SEEN = 1e-9  # relative: a change that is smaller is not followed
MOST_NAMED = 3
NOT_STEPPED = ("report", "precision")


def precision_reported(reported: ReportedRun) -> str:
    """Attitude or omega of every sample after the start are numbers of single precision.

    Places are not looked at: they may follow, in double, from what is kept.
    """

    def single(state: State, field: str) -> bool:
        kept = getattr(state, field)[1:]
        moves = bool(np.ptp(kept, axis=0).any())  # a body put to sleep has zeros
        return moves and np.array_equal(kept, kept.astype(np.float32).astype(float))

    fields = {"orientation": "attitude", "angular_velocity": "omega"}
    found = [
        s for f, s in fields.items() if single(reported.state, f) and not single(reported.own, f)
    ]
    what = "state" if len(found) == 2 else "".join(found)
    eps = float(np.finfo(np.float32).eps)
    pairs = zip(vars(reported.state).values(), vars(reported.own).values(), strict=True)
    if found and all(np.all(np.abs(a - b) <= eps * np.abs(b)) for a, b in pairs):
        return f"the {what} is reported in single precision, and kept in double"
    single_is_due = reported.truth.yardstick.eps > EPS
    return f"the {what} is kept in single precision" if found and not single_is_due else ""


def _asleep(reported: ReportedRun) -> str:
    still = ~np.any(reported.state.angular_velocity, axis=-1)
    if not still.any() or not np.all(np.any(reported.own.angular_velocity, axis=-1)):
        return ""
    first = int(np.argmax(still))
    if not np.all(still[first:]):
        return ""
    rate = float(norm(reported.own.angular_velocity[first]))
    when = f"from t = {reported.time[first]:.4g} s on"
    return f"the body is put to sleep: omega is zero {when}, where it should be {rate:.2g} rad/s"


def _limit(
    reported: ReportedRun,
    size: Callable[[Array], Array],
    end: Callable[[float], End],
    field: str = "angular_velocity",
) -> float | None:
    """The size that omega, or the velocity, is kept within by the end of each step, if any.

    The greatest that is reported is nearly the one that the steps keep to.
    """
    greatest = float(np.max(size(getattr(reported.state, field)[1:])))
    if not 0.0 < greatest < float(np.max(size(getattr(reported.own, field)[1:]))):
        return None

    def stepped(more: float) -> State:
        return reported.stepped(with_end(reported.declared, end(greatest * (1.0 + more))))

    more = _search(reported, stepped, 1e-6)
    return None if more is None else greatest * (1.0 + more)


def _held(reported: ReportedRun) -> str:
    limit = _limit(reported, norm, held_below)
    return "" if limit is None else f"omega is held below {limit:.6g} rad/s"


def _clipped(reported: ReportedRun) -> str:
    limit = _limit(reported, np.abs, clipped_at)
    return "" if limit is None else f"each component of omega is held within {limit:.6g} rad/s"


def _speed(reported: ReportedRun) -> str:
    limit = _limit(reported, norm, speed_below, "linear_velocity")
    return "" if limit is None else f"the linear velocity is held below {limit:.6g} m/s"


def _turn_held(reported: ReportedRun) -> str:
    """The turn of each step is cut at an angle, which the greatest between samples is made of."""
    q, every = reported.state.orientation, reported.sweep.every
    greatest = float(np.max(norm(rotation_between(q[:-1], q[1:])))) / every
    if not 0.0 < greatest < np.pi / every:
        return ""
    for angle in (float(f"{greatest:.6g}"), greatest):
        stepped = reported.stepped(with_end(reported.declared, turn_within(angle)))
        if reported.agrees(reported.state, stepped, slack=SLACK):
            return f"the turn of a step is held within {angle:.6g} rad"
    return ""


def _other_scheme(reported: ReportedRun) -> str:
    for name, scheme in SCHEMES.items():
        system, declared = reported.case.system, reported.integrator.coordinates
        ways = sorted(distinct(system), key=lambda way: way != canonical(system, declared))
        for way in (way for way in ways if way in scheme.coordinates):
            other = replace(reported, integrator=replace(reported.integrator, coordinates=way))
            same = name == reported.integrator.scheme
            if same and way == canonical(system, declared):
                continue  # what is declared: this is not what is wrong
            if reported.agrees(reported.state, other.stepped(scheme)):
                if same:
                    return f"it steps {PHRASES[way]}, which is not what is declared"
                return f"it is stepped by {name}, though {reported.integrator.scheme} is declared"
    return ""


def _other_end(reported: ReportedRun) -> str:
    for text, end in ENDS.items():
        if reported.agrees(reported.state, reported.stepped(with_end(reported.declared, end))):
            return text
    return ""


def _slipped(reported: ReportedRun) -> str:
    """The declared scheme with one slip in it, or with the damping split off."""
    name = reported.integrator.scheme or ""
    for text, scheme in slipped(name).items():
        if reported.agrees(reported.state, reported.stepped(scheme)):
            return f"it is stepped by {name}, but {text}"
    system = reported.case.system
    if float(system.load.damping):
        undamped = replace(system, load=replace(system.load, damping=np.zeros(())))
        for text, end in damping_ends(system).items():
            made = reported.stepped(with_end(reported.declared, end), undamped)
            if reported.agrees(reported.state, made):
                return f"the damping is split off each step: it acts {text}"
    return ""


def _search(reported: ReportedRun, stepped: Callable[[float], State], delta: float) -> float | None:
    """The number with which a run comes to the reported one, by Gauss-Newton; None if none does.

    delta: a small change of the number, of which one per cent is still distinguished from rounding.
    """
    rate, found = reported.truth.yardstick.rate, 0.0

    def apart(state: State) -> Array:
        return np.ravel(changes(state, reported.state, rate))

    before = np.inf
    for _ in range(MOST_TRIES):
        here = stepped(found)
        if reported.agrees(reported.state, here, slack=SLACK):
            return found
        left = float(norm(apart(here)))
        if not left < CONVERGES * before:
            return None
        before = left
        slope = (apart(here) - apart(stepped(found + delta))) / delta
        size = float(slope @ slope)
        if not size > 0.0 or not np.isfinite(size):
            return None
        found += float(slope @ apart(here)) / size
        if not np.isfinite(found):
            return None
    return None


def _longer(reported: ReportedRun) -> str:
    h = reported.sweep.timestep
    part = _search(reported, lambda k: reported.stepped(timestep=h * (1.0 + k)), 1e-6)
    if part is None or part == 0.0:
        return ""
    return f"steps are {100 * abs(part):.4g} % too {'long' if part > 0 else 'short'}"


def _damped(reported: ReportedRun) -> str:
    system, yardstick = reported.case.system, reported.truth.yardstick

    def stepped(damping: float) -> State:
        more = replace(system.load, damping=system.load.damping + damping)
        return reported.stepped(system=replace(system, load=more))

    scale = yardstick.scale.smallest / float(reported.time[-1])  # takes a run's time to act
    found = _search(reported, stepped, 1e-6 * scale)
    if found is None or found == 0.0:
        return ""
    return f"a damping of {found:.3g} N m s/rad acts in the steps that was not requested"


def _other_equation(reported: ReportedRun) -> str:
    """The scheme over another equation, all hypotheses side by side in lanes."""
    system, states = reported.case.system, reported.own
    known = [h for h in hypotheses(system) if h.part not in NOT_STEPPED and not h.unlikely]
    found, forms, kept = list[str](), list[Form](), list[Array]()
    true = forward_dynamics(system, states)
    for one in known:
        form = wrong_form([one], system)
        if form is None:
            continue
        tried = accelerations(form, states)
        change = np.concatenate([tried.angular - true.angular, tried.linear - true.linear])
        size = float(np.max(np.abs(change)))
        if size <= SEEN * float(np.max(np.abs(true.angular)) + np.max(np.abs(true.linear))):
            continue
        if any(np.max(np.abs(change - other)) <= SEEN * size for other in kept):
            continue
        found.append(one.text.strip())
        forms.append(form)
        kept.append(change)
    if not forms:
        return ""
    lanes = Form(*(np.stack(part) for part in zip(*(vars(f).values() for f in forms), strict=True)))
    stepped = _in_lanes(reported, lanes, len(forms))
    fits = [
        text
        for k, text in enumerate(found)
        if reported.agrees(reported.state, stepped[:, k], slack=SLACK)
    ]
    if not 0 < len(fits) <= MOST_NAMED:
        return ""
    texts = fits[0] if len(fits) == 1 else "either " + ", or ".join(fits)
    return f"in the steps, {texts}"


def _in_lanes(reported: ReportedRun, lanes: Form, count: int) -> State:
    """(n, lanes, ...): the declared scheme over each of these equations."""
    system, sweep = reported.case.system, reported.sweep
    coordinates = reported.integrator.coordinates
    motion = motion_over(system, coordinates, lambda state: accelerations(lanes, state))
    start = State(*(np.stack([f] * count) for f in vars(reported.case.initial).values()))
    plan = (sweep.timestep, sweep.steps, sweep.every, coordinates, motion)
    with np.errstate(all="ignore"):
        return step_body(reported.declared, system, start, *plan)[1]


CAUSES_OF_STEPPING = (
    _asleep,
    _other_scheme,
    _other_end,
    _slipped,
    _longer,
    _damped,
    _clipped,
    _held,
    _speed,
    _turn_held,
    _other_equation,
)
CAUSES_OF_UNKNOWN = (
    _asleep,
    _slipped,
    _longer,
    _damped,
    _clipped,
    _held,
    _speed,
    _other_equation,
)
