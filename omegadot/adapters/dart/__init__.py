"""DART behind the protocol."""

from omegadot.adapters.dart.adapter import DartAdapter

__all__ = ["DartAdapter"]
