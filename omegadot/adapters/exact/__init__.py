"""The exact solution as an engine."""
