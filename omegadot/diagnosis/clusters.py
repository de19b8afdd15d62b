"""Clusters of identical trajectories: engines that step one scheme agree, and that is no evidence.

Members are found by what they did, not by what they declare: two runs of one case and step belong
together where their omega and attitude differ by no more than rounding may have grown to in either.
Translation is left aside: engines that step one scheme at different points of the body, its origin
or its centre of mass, turn alike.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.gates.bounds.likeness import likeness
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import ROTATION
from omegadot.gates.truth import Truth
from omegadot.harness.outcome import EngineCase, JudgedCase
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.stepping import stack
from omegadot.reference_impl.system import Array, State

# The reference is not counted: its schemes give the clusters their names.
NOT_COUNTED = ("exact", "reference")


@dataclass(frozen=True)
class Cluster:
    """Runs of one scenario and step that turn alike, as ``engine:integrator``.

    scheme: the reference's that they equal, None where they equal none.  also: others that they
    equal too, where the motion does not distinguish schemes; `scheme` is then the one that most
    members declare.  exact: they equal the exact solution: this is no sign of a common scheme.
    """

    scenario: str
    timestep: float
    scheme: str | None
    members: tuple[str, ...]
    also: tuple[str, ...] = ()
    exact: bool = False


@dataclass(frozen=True)
class _MeasuredRun:
    """One run, or one of the reference's. bound: (n,), how far rounding may take its omega."""

    name: str
    scheme: str | None
    state: State
    bound: Array


def _alike(one: _MeasuredRun, others: Sequence[_MeasuredRun], rate: float) -> list[bool]:
    """Whether a run agrees with each of the others, to the sum of both bounds."""
    if not others:
        return []
    many = stack([other.state for other in others])
    turns = attitude_angle(one.state.orientation, many.orientation)
    spins = norm(one.state.angular_velocity - many.angular_velocity) / rate
    found = []
    for turn, spin, other in zip(turns, spins, others, strict=True):
        bounds = dict.fromkeys(ROTATION, one.bound + other.bound)
        found.append(likeness({"omega": spin, "attitude": turn}, bounds).agree)
    return found


def _bound(truth: Truth, sweep: Sweep, growth: Array) -> Array:
    return truth.yardstick.round_off(sweep.timestep, sweep.sample_steps, growth)["omega"]


def _runs(truth: Truth, engines: Iterable[EngineCase], sweep: Sweep) -> list[_MeasuredRun]:
    """The runs of one step that ended well, each with the bound of the scheme that it declares."""
    found = []
    for engine in engines:
        for judged in engine.runs:
            if judged.sweep != sweep or judged.outcome != "ok" or engine.engine.name in NOT_COUNTED:
                continue
            integrator = judged.integrator
            answer = engine.result.runs[integrator.name, sweep.timestep]
            if len(answer.result["time"]) != len(sweep.times):
                continue
            own = truth.companion(integrator, sweep)
            bound = _bound(truth, sweep, own.growth if own else truth.growth[truth.rows(sweep)])
            name, state = f"{engine.engine.name}:{integrator.name}", State(**answer.result["state"])
            found.append(_MeasuredRun(name, integrator.scheme, state, bound))
    return found


def _schemes(truth: Truth, sweep: Sweep) -> list[_MeasuredRun]:
    """The reference's runs with this step."""
    return [
        _MeasuredRun(key.scheme, key.scheme, own.state, _bound(truth, sweep, own.growth))
        for (key, timestep), own in truth.companions.items()
        if timestep == sweep.timestep
    ]


def _grouped(runs: list[_MeasuredRun], rate: float) -> list[list[_MeasuredRun]]:
    """The runs in groups: each agrees with every other of its group."""
    groups: list[list[_MeasuredRun]] = []
    for run in runs:
        home = next((group for group in groups if all(_alike(run, group, rate))), None)
        if home is None:
            groups.append([run])
        else:
            home.append(run)
    return groups


def _named(group: list[_MeasuredRun], schemes: list[_MeasuredRun], rate: float) -> list[str]:
    """The schemes that a group equals, the one that most of it declare first."""
    alike = zip(schemes, _alike(group[0], schemes, rate), strict=True)
    agreeing = list(dict.fromkeys(scheme.name for scheme, equal in alike if equal))
    declared = Counter(run.scheme for run in group)
    return sorted(agreeing, key=lambda name: -declared[name])


def clusters_of_run(cases: Iterable[JudgedCase]) -> list[Cluster]:
    """The clusters of every case that has an exact trajectory to be measured by, step by step.

    A run that nothing else equals is one by itself.
    """
    with np.errstate(all="ignore"):
        return [cluster for judged in cases for cluster in _clusters(judged)]


def _clusters(judged: JudgedCase) -> Iterator[Cluster]:
    truth = judged.truth
    if truth is None:
        return
    for sweep in judged.case.sweeps:
        runs = _runs(truth, judged.engines, sweep)
        if not runs:  # of a trace there may be fewer samples than a sweep has
            continue
        schemes, rate = _schemes(truth, sweep), truth.yardstick.rate
        bound = _bound(truth, sweep, truth.growth[truth.rows(sweep)])
        solution = _MeasuredRun("exact", None, truth.at(sweep), bound)
        for group in _grouped(runs, rate):
            names, equal = tuple(run.name for run in group), _named(group, schemes, rate)
            scheme, also = next(iter(equal), None), tuple(equal[1:])
            exact = all(_alike(solution, group, rate))
            yield Cluster(judged.case.name, sweep.timestep, scheme, names, also, exact)
