"""The reference as an engine like any other."""

from omegadot.adapters.reference.adapter import FEATURES, ReferenceAdapter

__all__ = ["FEATURES", "ReferenceAdapter"]
