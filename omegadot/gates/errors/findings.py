"""What the runs of one integrator at several steps show together, and what one is judged to be."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.errors.excess import excess_of
from omegadot.gates.errors.highest_order import highest_order
from omegadot.gates.errors.measured_run import CHANNELS, SATURATING, STATE, MeasuredRun
from omegadot.gates.errors.observed_order import ObservedOrder
from omegadot.gates.errors.orders import order_of
from omegadot.gates.errors.sweep_errors import FEWEST_STEPS, Errors
from omegadot.gates.errors.verdicts import BLOWN_UP_UNSEEN, Evidence, Finding, judge
from omegadot.gates.truth import scheme_key
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import System


@dataclass(frozen=True, eq=False)
class MeasuredSweep:
    """The measured runs of one integrator at several steps.

    What they show together is formed once, since each of them is judged by it: of a channel's
    errors, or of what is left of them after the declared scheme.
    """

    runs: tuple[MeasuredRun, ...]

    @cached_property
    def _errors(self) -> dict[tuple[str, bool], list[Errors]]:
        return {}

    @cached_property
    def _orders(self) -> dict[tuple[str, bool], ObservedOrder | None]:
        return {}

    def errors(self, channel: str, *, left: bool = False) -> list[Errors]:
        """The errors of all runs that have some, in the order of these."""
        if (channel, left) not in self._errors:
            errors = [errors_of(run, channel, left=left) for run in self.runs]
            self._errors[channel, left] = [one for one in errors if one is not None]
        return self._errors[channel, left]

    def order(self, channel: str, *, left: bool = False) -> ObservedOrder | None:
        """The order at which they shrink with the step; None where none is to be seen."""
        if (channel, left) not in self._orders:
            self._orders[channel, left] = order_of(self.errors(channel, left=left))
        return self._orders[channel, left]


def errors_of(run: MeasuredRun, channel: str, *, left: bool = False) -> Errors | None:
    """A run's errors in a channel, or what is left of them after the declared scheme."""
    if left and not run.against_scheme:
        return None
    size = run.against_scheme[channel] if left else run.error[channel]
    rounding = run.beside_scheme if left else run.round_off
    bound = np.maximum(rounding[channel], run.floor.get(channel, 0.0))
    largest, saturates = run.saturating_error, channel in SATURATING
    gained = run.gained if channel == "energy" and not left else None
    signed = None if gained is None else size * gained
    return Errors(run.sweep.timestep, run.sweep.times, size, bound, largest, saturates, signed)


def evidence_of(
    measured: MeasuredRun, sweep: MeasuredSweep, channel: str, declared: int | None = None
) -> Evidence:
    """What one run and the others of its sweep show in a channel. declared: its order."""
    left = measured.against_scheme.get(channel)
    orders: list[ObservedOrder | None] = []
    finer = sum(run.sweep.timestep < measured.sweep.timestep for run in sweep.runs)
    highest, excess = np.inf, 0.0
    for part in (False,) if left is None else (False, True):
        known = sweep.errors(channel, left=part)
        orders.append(sweep.order(channel, left=part))
        if measured.single:
            highest = min(highest, highest_order(known))
        if channel in STATE and declared is not None:
            own = next(one for one in known if one.timestep == measured.sweep.timestep)
            excess = max(excess, excess_of(own, known, declared + part))
    bound, floor = measured.round_off[channel], measured.floor.get(channel)
    stiffness = min(run.stiffness for run in sweep.runs)
    of_momentum, opened = measured.of_momentum.get(channel), measured.opened.get(channel)
    more = (excess, finer >= FEWEST_STEPS, highest, of_momentum, stiffness, opened)
    return Evidence(measured.error[channel], bound, left, tuple(orders), floor, *more)


@dataclass(frozen=True)
class Declared:
    """What an integrator is judged by: its scheme, and its order per channel (None: conserved)."""

    scheme: str | None
    orders: dict[str, int | None]


def orders_for(integrator: Integrator, system: System) -> dict[str, int | None]:
    """The declared orders; those of a known scheme are higher where the system is simple."""
    key = scheme_key(integrator, system)
    if key is None or key.scheme not in SCHEMES:
        return {c: integrator.orders.get(c) for c in CHANNELS}
    scheme = SCHEMES[key.scheme]
    return {c: scheme.order(c, system, key.coordinates) for c in CHANNELS}


def findings_of(
    measured: MeasuredRun, declared: Declared, sweep: MeasuredSweep
) -> dict[str, Finding]:
    """Judge every channel of one run; the other runs of its sweep show the orders.

    Where the state blows up as a scheme may, so do energy and angular momentum: these may show no
    order until then, as their errors cancel now and then.
    """
    found = {
        c: judge(evidence_of(measured, sweep, c, order), declared.scheme, order)
        for c, order in declared.orders.items()
    }
    lost = [found[c] for c in STATE if c in found and not np.all(np.isfinite(measured.error[c]))]
    if lost and all(finding.kind == "beyond" for finding in lost):
        follow = {c for c, finding in found.items() if finding == BLOWN_UP_UNSEEN}
        found |= dict.fromkeys(follow - {*STATE}, lost[0])
    return found
