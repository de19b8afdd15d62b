"""Pinocchio behind the protocol."""

from omegadot.adapters.pinocchio.adapter import PinocchioAdapter

__all__ = ["PinocchioAdapter"]
