"""Causes that are tried on an engine's own answers, a folder for each kind of mistake."""
