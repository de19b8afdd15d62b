"""Causes that are tried on an engine's own answers, one file a gate."""
