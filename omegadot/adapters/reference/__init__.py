"""The reference as an engine like any other."""

from omegadot.adapters.reference.adapter import ReferenceAdapter

__all__ = ["ReferenceAdapter"]
