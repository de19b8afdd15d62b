"""Wrong equations without a number in them: what engines are known to make of equation (8)."""

from __future__ import annotations

from omegadot.diagnosis.equations.hypotheses.body import (
    center_hypotheses,
    precision_hypotheses,
    report_hypotheses,
)
from omegadot.diagnosis.equations.hypotheses.damping import damping_hypotheses
from omegadot.diagnosis.equations.hypotheses.gravity import gravity_hypotheses
from omegadot.diagnosis.equations.hypotheses.hypothesis import Hypothesis, wrong_form
from omegadot.diagnosis.equations.hypotheses.inertia import inertia_hypotheses, spin_hypotheses
from omegadot.diagnosis.equations.hypotheses.levers import lever_hypotheses
from omegadot.diagnosis.equations.hypotheses.pivot import pivot_hypotheses
from omegadot.diagnosis.equations.hypotheses.torque import loads_hypotheses, torque_hypotheses
from omegadot.diagnosis.equations.hypotheses.unsymmetric import unsymmetric_hypotheses
from omegadot.reference_impl.system import System

__all__ = ["Hypothesis", "hypotheses", "wrong_form"]
FIXED: tuple[Hypothesis, ...] = (
    *spin_hypotheses(),
    *gravity_hypotheses(),
    *damping_hypotheses(),
    *torque_hypotheses(),
    *pivot_hypotheses(),
    *lever_hypotheses(),
    *center_hypotheses(),
    *report_hypotheses(),
    *precision_hypotheses(),
)


def hypotheses(system: System) -> list[Hypothesis]:
    """All of them, for one system; most make no difference to it."""
    own = (*inertia_hypotheses(system), *unsymmetric_hypotheses(system))
    return [*FIXED, *own, *loads_hypotheses(system)]
