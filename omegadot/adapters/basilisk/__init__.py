"""Basilisk behind the protocol."""
