"""What one version answers, as figures: its drifts, its equations, its schemes and orders."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.adapters.protocol import Description, Integrator
from omegadot.commands.versions.aims import (
    Exact,
    conserves_kinetic_energy,
    drift_names,
    equation_names,
    probe_names,
)
from omegadot.commands.versions.metric import RATIO, Figure, Name
from omegadot.diagnosis.scheme_study.fingerprint import fingerprint
from omegadot.diagnosis.scheme_study.orders import global_errors, observe
from omegadot.diagnosis.scheme_study.probes import Probe
from omegadot.diagnosis.scheme_study.study import OWN_STEPS, Order, ProbeStudy
from omegadot.diagnosis.scheme_study.subject import NoAnswerError, Stepper
from omegadot.gates.case import Case
from omegadot.gates.errors.findings import orders_for
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.errors.observed_order import ORDER_TOLERANCE
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import forward_rows, inverse_rows
from omegadot.gates.states.model import body_rows, state_rows
from omegadot.gates.truth import scheme_key
from omegadot.harness.judging.judged_run import is_finite
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.system import Acceleration, State
from omegadot.workers.harness_end.process import Answer
from omegadot.workers.wire import body_from

Figures = dict[Name, Figure]
Wanted = Callable[[Name], bool]
ROUNDING = "rounding alone"
BLOWN_UP = Figure("blew up")
UNSUPPORTED = Figure("unsupported")
NOT_OFFERED = Answer("unsupported", "the engine offers no such call")


def reported_figures(description: Description, native: dict[str, dict[str, str]]) -> Figures:
    """What an engine reports and, where its adapter gives access, what its own functions return."""
    found: Figures = {}
    for part, kind in (("conventions", "convention"), ("defaults", "default")):
        for name, value in native.get(part, {}).items():
            found[kind, name] = Figure(value)
    for clause in description.switched_off:
        found["setup", "switched off", clause] = Figure("yes")
    for integrator in description.integrators:
        found["integrator", integrator.name] = Figure("there")
    return found


def drift_figures(case: Case, name: str, exact: Exact, step: Stepper) -> Figures:
    """The largest distance from the exact trajectory in each channel, and E/E0 at the end.

    The band is what rounding may have grown to, along the exact trajectory or the engine's own.
    Raises NoAnswerError.
    """
    sweep, names = case.sweeps[0], drift_names(case, name)
    state = step(case.initial, sweep.timestep, sweep.steps, sweep.every)
    if not is_finite(state):
        return dict.fromkeys(names, BLOWN_UP)
    yardstick = exact.yardstick
    own = growth_along(case.system, sweep.times, state, yardstick.rate)
    growth = np.maximum(own, exact.growth)
    bound = yardstick.round_off(sweep.timestep, sweep.sample_steps, growth)
    found: Figures = {}
    if conserves_kinetic_energy(case):
        energy = total_energy(case.system, state)
        found[names[0]] = Figure(float(energy[-1] / energy[0]), float(bound["energy"][-1]))
    for channel, metric in zip(CHANNELS, names[-len(CHANNELS) :], strict=True):
        distance = yardstick.distance(channel, state, exact.state)
        found[metric] = Figure(float(np.max(distance)), float(np.max(bound[channel])))
    assert set(found) == set(names), RATIO
    return found


def scheme_figures(
    probe: Probe, integrator: Integrator, step: Stepper, wanted: Wanted
) -> tuple[Figures, ProbeStudy]:
    """The schemes that an integrator equals on a probe, its orders there, and what is declared.

    Raises NoAnswerError, also where it controls its error: its steps are its own.
    """
    if integrator.knob != "timestep":
        raise NoAnswerError(Answer("unsupported", OWN_STEPS))
    found: Figures = {}
    matches, orders = None, {}
    scheme, *order_names = probe_names(integrator.name, probe.kind)
    declared, key = orders_for(integrator, probe.system), scheme_key(integrator, probe.system)
    if wanted(scheme):
        matches = tuple(fingerprint(probe, step))
        schemes = dict.fromkeys(match.scheme for match in matches)
        found[scheme] = Figure(" or ".join(schemes) or "unknown")
    if any(map(wanted, order_names)):
        errors = global_errors(probe, step)
        for channel, metric in zip(CHANNELS, order_names, strict=True):
            seen = observe(errors[channel])
            orders[channel] = Order(declared.get(channel), seen)
            order = seen.order if seen.kind == "settled" else None
            rounded = seen.kind == "floor"
            found[metric] = Figure(ROUNDING) if rounded else Figure(order, ORDER_TOLERANCE)
    fits = None if matches is None or key is None else any(m.key == key for m in matches)
    return found, ProbeStudy(Answer("ok"), integrator.scheme, fits, matches or (), orders)


def equation_figures(
    case: Case, exact: Exact, features: frozenset[str], request: Callable[..., Answer]
) -> tuple[Figures, list[Row]]:
    """Omega-dot, acceleration and torque at random states, against their bounds.

    features: of the engine; what is not among them is not requested of it, and is "unsupported".
    The rows are those of the equations, and those of the body and a state that are read back.
    Raises NoAnswerError.
    """
    system, random = case.system, exact.random
    first = State(*(values[0] for values in vars(random).values()))
    model = request("model", state=first)
    forward = inverse = NOT_OFFERED
    if "forward_dynamics" in features:
        forward = request("forward", states=random)
    if "inverse_dynamics" in features:
        inverse = request("inverse", states=random, acceleration=exact.acceleration)
    rows: list[Row] = []
    if forward.ok:
        rows += forward_rows(system, random, Acceleration(**forward.result), "residual")
    if inverse.ok:
        rows += inverse_rows(system, random, exact.acceleration, inverse.result["torque"])
    names = {name[-1]: name for name in equation_names(case)}
    found = dict.fromkeys(names.values(), UNSUPPORTED)
    found |= {names[row.channel]: Figure(row.value, row.bound or 0.0) for row in rows}
    if model.ok:
        bodies, state = model.result["bodies"], State(**model.result["state"])
        rows = body_rows(case, body_from(bodies[0])) + state_rows(case, first, state) + rows
    return found, rows
