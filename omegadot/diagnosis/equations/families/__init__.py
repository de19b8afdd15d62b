"""Wrong equations with numbers in them, fitted to an engine's accelerations."""

from __future__ import annotations

from omegadot.diagnosis.equations.families.family import Family, fit
from omegadot.diagnosis.equations.families.inertias import LEAST, SIX_NUMBERS
from omegadot.diagnosis.equations.families.one_number import ONE_NUMBER
from omegadot.diagnosis.equations.families.vectors import EXTRA, THREE_NUMBERS

__all__ = ["EXTRA", "LEAST", "ONE_NUMBER", "SIX_NUMBERS", "THREE_NUMBERS", "Family", "fit"]
