"""Runs of one step, each after a known run: what of that one their first step is made of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.experiments.requests import Requests
from omegadot.diagnosis.stepping.ends.after_run import OWN, AfterRun
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import RANGE, vanishing_steps
from omegadot.gates.case import Case
from omegadot.gates.steps.limits import extrapolated
from omegadot.gates.steps.probe import Probe, probe_at
from omegadot.harness.requests.repeats import OTHERS
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import motion_over
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, State

STEPS = 3  # of the run before: its start, the start of its last step and its end are three states
LONG = 16.0  # times the longest of the probe's steps: an eighth of a radian
OF_ANOTHER, AFTER_LOAD = "of another integrator", "of another system, loaded in between"


@dataclass(frozen=True)
class _Before:
    """The run before: of which case and integrator, from which state, in steps of h in s."""

    kind: str
    case: Case
    integrator: Integrator
    start: State
    h: float


def after_runs(
    driver: Requests,
    case: Case,
    integrators: Sequence[Integrator],
    states: State,
    eps: float,
    pairs: int,
) -> Iterator[AfterRun]:
    """First steps of the first of the integrators after runs of it, of others, of another system.

    states: (n,), of which neighbours are one run's start and the next one's. Only what is answered
    in full is yielded.
    """
    own, *others = integrators
    count = len(states.angular_velocity)
    placed = place_on_pivot(case.system, states)
    longest = LONG * probe_at(case.system, placed, eps).timesteps[:, 0]
    for k in range(min(pairs, count - 1)):
        before = _Before(OWN, case, own, placed[k + 1], float(longest[k + 1]))
        yield from _after(driver, before, case, own, placed[k], eps)
    for other in others[:1]:
        before = _Before(OF_ANOTHER, case, other, placed[1], float(longest[1]))
        yield from _after(driver, before, case, own, placed[0], eps)
    held = case.system.load.pivot is not None
    for other_case in reversed(OTHERS) if held else OTHERS:
        h = other_case.sweeps[0].timestep
        before = _Before(AFTER_LOAD, other_case, own, other_case.initial, h)
        found = [*_after(driver, before, case, own, placed[0], eps)]
        yield from found
        if found:
            return


def _after(
    driver: Requests, before: _Before, case: Case, own: Integrator, start: State, eps: float
) -> Iterator[AfterRun]:
    """Steps ever shorter from one state, each after the same run.

    An engine that keeps what is not finite is started afresh.
    """
    one = State(*(f[None] for f in vars(start).values()))
    probe = probe_at(case.system, one, eps)
    found = _ends(driver, before, case, own, start, probe.timesteps[0])
    if found is not None and not _finite(found[1]):
        driver.restart()
        found = _ends(driver, before, case, own, start, probe.timesteps[0])
    if found is None or not _finite(found[1]):
        return
    paths, ends = found
    stepped = State(*(np.stack(f)[None] for f in _by_field(ends[1:])))
    steps = vanishing_steps(case.system, Probe(one, probe.timesteps), stepped, eps)
    each = tuple(zip(paths[1:], ends[1:], strict=True))
    path = _limit(paths)
    last = _last_evaluated(before, path)
    yield AfterRun(before.kind, before.case.system, path, each, steps, ends[0], last)


def _last_evaluated(before: _Before, path: State) -> State | None:
    """Where a declared scheme takes its last rates in the run; None where that is not known."""
    scheme, how = SCHEMES.get(before.integrator.scheme or ""), before.integrator.coordinates
    system, seen = before.case.system, list[State]()
    if scheme is None or how not in scheme.coordinates:
        return None

    def acceleration(state: State) -> Acceleration:
        seen.append(state)
        return forward_dynamics(system, state)

    motion = motion_over(system, how, acceleration)
    step_body(scheme, system, path[-2], before.h, 1, 1, how, motion)
    last = seen[-1]
    # many states at once are for a derivative
    return last if last.orientation.shape == path.orientation[-1].shape else None


def _ends(
    driver: Requests,
    before: _Before,
    case: Case,
    own: Integrator,
    start: State,
    timesteps: Array,
) -> tuple[list[State], list[State]] | None:
    """The runs before, and the ends of a step as long as theirs and of each of these lengths.

    None where one is not answered.
    """
    paths, ends = list[State](), list[State]()
    for h in (before.h, *timesteps):
        went = _replay(driver, before.case, before.integrator, before.start, before.h, STEPS)
        came = _replay(driver, case, own, start, float(h), 1) if went is not None else None
        if went is None or came is None:
            return None
        paths.append(went)
        ends.append(came[-1])
    return paths, ends


def _finite(states: Sequence[State]) -> bool:
    return all(bool(np.all(np.isfinite(f))) for one in states for f in vars(one).values())


def _by_field(states: Sequence[State]) -> Iterator[tuple[Array, ...]]:
    return zip(*(vars(one).values() for one in states), strict=True)


def _limit(paths: Sequence[State]) -> State:
    """The run before, after steps of no length: its own start may depend on these."""
    last = _by_field(paths[-RANGE:])
    return State(*(extrapolated(np.stack(f, axis=-2)) for f in last))


def _replay(
    driver: Requests, case: Case, integrator: Integrator, start: State, h: float, steps: int
) -> State | None:
    """The states (steps + 1,) of a run; None where it is not answered in full."""
    how = {"timestep": h, "steps": steps, "every": 1, "accuracy": None}
    answer = driver.request(case, "replay", initial=start, integrator=integrator.name, **how)
    if not answer.ok or len(answer.result["time"]) != steps + 1:
        return None
    return State(**answer.result["state"])
