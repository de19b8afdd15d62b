"""Rapier, by its bindings for Python, behind the protocol."""
