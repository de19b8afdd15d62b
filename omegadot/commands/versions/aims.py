"""What is measured of every version: metrics by name, and the exact solution of each case."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from omegadot.adapters.protocol import Description
from omegadot.commands.versions.metric import RATIO, Name
from omegadot.diagnosis.scheme_study.probes import PROBES
from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.case import Case, Sweep
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.states.equation import random_acceleration, random_states
from omegadot.harness.arguments import case_of
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.solutions.exact_solution import exact_states
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.system import Acceleration, Array, State
from omegadot.reports.text.numbers import plain
from omegadot.scenarios import ScenarioLike, load_scenario, scenario

# On a free body, one with an offset, with damping, on a pivot and under a torque that turns with
# it, integrators may step different schemes; a flip multiplies what they differ by.
DEFAULT = ("box", "t-handle", "offset-com", "damped-tumble", "heavy-top", "driven-world")
BOX = "box"
BOX_FILE = Path(__file__).with_name("box.toml")
SAMPLES = 50
STATES = 32  # random states that the equations are evaluated at
SEED = (0, 1)


@dataclass(frozen=True)
class Exact:
    """A case's exact states at its samples, and the measure of distances from them.

    random, acceleration: where the equations are evaluated.
    """

    state: State
    growth: Array
    yardstick: Yardstick
    random: State
    acceleration: Acceleration


@dataclass
class Aims:
    """The cases that are run, each with a single step, and the integrators (all where none is)."""

    cases: tuple[Case, ...]
    integrators: tuple[str, ...] = ()
    _known: dict[str, Exact] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def truth(self, case: Case) -> Exact:
        """The truth of a case; versions that are measured side by side share it."""
        with self._lock:
            if case.name not in self._known:
                self._known[case.name] = _exact(case)
            return self._known[case.name]

    def chosen(self, description: Description) -> list[str]:
        """The integrators of a version that are looked at."""
        names = [integrator.name for integrator in description.integrators]
        return [name for name in names if not self.integrators or name in self.integrators]


def case_for(argument: ScenarioLike, timestep: float | None) -> Case:
    """A scenario at one step, its own middle one where none is given, with samples enough.

    Raises ScenarioError and UsageError.
    """
    chosen = load_scenario(BOX_FILE) if argument == BOX else scenario(argument)
    case = case_of(chosen, () if timestep is None else (timestep,))
    sweep = case.sweeps[len(case.sweeps) // 2]
    thinned = Sweep(sweep.timestep, sweep.steps, max(1, sweep.steps // SAMPLES))
    return Case(case.scenario, case.system, case.initial, (thinned,))


def aims_of(
    scenarios: Sequence[ScenarioLike], integrators: Sequence[str], timestep: float | None
) -> Aims:
    """What the arguments request. Raises ScenarioError and UsageError."""
    named = list(scenarios) or list(DEFAULT)
    once = [one for place, one in enumerate(named) if one not in named[:place]]
    cases = tuple(case_for(one, timestep) for one in once)
    return Aims(cases, tuple(dict.fromkeys(integrators)))


def check_integrators(aims: Aims, known: Sequence[str], engine: str) -> None:
    """Raise UsageError where an integrator is requested that no version has."""
    for name in aims.integrators:
        if known and name not in known:
            raise UsageError(
                f"--integrator {name}: no version of {engine} here has it; {nearest(name, known)}."
            )


def conserves_kinetic_energy(case: Case) -> bool:
    """Whether the energy is kinetic alone and stays, so that E/E0 states something."""
    load = case.system.load
    torques = load.torque_body.any() or load.torque_world.any()
    return not (load.gravity.any() or float(load.damping) or torques or load.pivot is not None)


def drift_names(case: Case, integrator: str) -> list[Name]:
    """One for each channel, and E/E0 at the end where that states something."""
    start = ("drift", case.name, integrator, plain(case.sweeps[0].timestep))
    ratio: list[Name] = [(*start, RATIO)] if conserves_kinetic_energy(case) else []
    return ratio + [(*start, channel) for channel in CHANNELS]


def equation_names(case: Case) -> list[Name]:
    """Forward and inverse dynamics at random states."""
    channels = ("omega_dot", "linear_momentum", "torque")
    return [("equation", case.name, channel) for channel in channels]


def probe_names(integrator: str, kind: str) -> list[Name]:
    """Which scheme an integrator steps on a probe, and its observed orders there."""
    orders: list[Name] = [("order", integrator, kind, channel) for channel in CHANNELS]
    return [("scheme", integrator, kind), *orders]


def names_of(aims: Aims, description: Description) -> Iterator[Name]:
    """Every name that needs steps or calls; what an engine reports of itself has other names."""
    for case in aims.cases:
        yield from equation_names(case)
    for integrator in aims.chosen(description):
        for probe in PROBES:
            yield from probe_names(integrator, probe.kind)
        for case in aims.cases:
            yield from drift_names(case, integrator)


def _exact(case: Case) -> Exact:
    times = case.sweeps[0].times
    _, state = exact_states(case.system, case.initial, times)
    yardstick = Yardstick(case.system, times, state)
    growth = growth_along(case.system, times, state, yardstick.rate)
    random = random_states(case, STATES, SEED)
    acceleration = random_acceleration(case.system, random, SEED)
    return Exact(state, np.asarray(growth), yardstick, random, acceleration)
