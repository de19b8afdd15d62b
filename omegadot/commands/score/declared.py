"""How a trace was stepped, as far as that is declared."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.commands.score.trace import Trace
from omegadot.gates.bounds.scales import EPS
from omegadot.harness.usage import UsageError, nearest
from omegadot.reference_impl.flight.euler_angles import Angles
from omegadot.reference_impl.flight.schemes import FLIGHT_SCHEMES
from omegadot.reference_impl.schemes import COMMON, SCHEMES
from omegadot.reference_impl.system import Array
from omegadot.written import written

MOST_STEPS = 1_000_000
# A stamp this part of a step off a whole number of them is of an accumulated, or rounded, time.
NEARLY_WHOLE = 1e-3
ON_ANGLES = tuple(name for name, scheme in FLIGHT_SCHEMES.items() if scheme.angles)
USUAL = (*(name for name in FLIGHT_SCHEMES if name not in ON_ANGLES), *COMMON, *ON_ANGLES)
"""The schemes by name that a trace is compared with, the plainest first."""
OTHERS = tuple(name for name in SCHEMES if name not in COMMON)
"""Those that it is compared with where it is none of these: of one engine's coordinates each."""
KNOWN = (*USUAL, *OTHERS)


@dataclass(frozen=True)
class Declared:
    """How a trace was made, as declared. numbers: (n,), the steps that its samples stand at.

    off: s, how far the stamps lie off these at most.  angles: those that a scheme may step.
    """

    scheme: str | None
    timestep: float
    numbers: Array
    off: float = 0.0
    angles: Angles | None = None


def declared_of(
    trace: Trace, scheme: str | None, timestep: float | None, angles: Angles
) -> tuple[Trace, Declared | None]:
    """The declaration, if there is one and it can be, and the trace with what it leaves open.

    Stamps that are nearly whole numbers of steps are accepted, and how far they are off is open of
    them. Raises UsageError.
    """
    if scheme is not None and scheme not in KNOWN:
        raise UsageError(
            f"--integrator-scheme {scheme}: there is no such scheme; {nearest(scheme, KNOWN)}."
        )
    if timestep is None:
        if scheme is not None:
            raise UsageError(f"--integrator-scheme {scheme}: its step is missing; give --timestep.")
        return trace, None
    if not (np.isfinite(timestep) and timestep > 0.0):
        raise UsageError(
            f"--timestep {written(timestep)}: not a positive number of seconds; give one."
        )
    most = float(trace.times[-1]) / timestep
    if most > MOST_STEPS + 0.5:
        raise UsageError(
            f"--timestep {written(timestep)}: makes {most:.0f} steps; give at most {MOST_STEPS:,}."
        )
    ratio = trace.times / timestep
    numbers = np.round(ratio)
    # A stamp is off by its digits at most, and by the rounding of a sum of so many steps.
    known = trace.open["times"] / timestep + 4 * EPS * np.maximum(ratio, 1) ** 2
    off = np.abs(ratio - numbers)
    worst = int(np.argmax(off - known))
    if off[worst] > max(known[worst], NEARLY_WHOLE) or numbers[0] < 0.0:
        raise UsageError(
            f"--timestep {written(timestep)}: the sample at {written(trace.times[worst], 9)} s "
            "stands at no whole "
            "number of steps; give the step that the simulator took."
        )
    more = np.where(off > 4 * EPS * ratio, timestep * off, 0.0)
    opened = {**trace.open, "times": np.maximum(trace.open["times"], more)}
    declared = Declared(scheme, timestep, numbers, float(np.max(more)), angles)
    return replace(trace, open=opened), declared
