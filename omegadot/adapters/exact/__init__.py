"""The exact solution as an engine."""

from omegadot.adapters.exact.adapter import ExactAdapter

__all__ = ["ExactAdapter"]
