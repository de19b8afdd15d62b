"""Wrong equations that no list has: one product of known vectors and sizes, found by search."""

from omegadot.diagnosis.equations.formula.formula import Formula
from omegadot.diagnosis.equations.formula.search import AnyFormula, formulas
from omegadot.diagnosis.equations.formula.tensors import OtherInertia
from omegadot.diagnosis.equations.formula.together import Together

__all__ = ["AnyFormula", "Formula", "OtherInertia", "Together", "formulas"]
