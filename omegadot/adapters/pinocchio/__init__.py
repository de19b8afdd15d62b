"""Pinocchio behind the protocol."""
