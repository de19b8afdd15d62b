"""The reference as an engine like any other."""
