"""Exudyn behind the protocol."""
