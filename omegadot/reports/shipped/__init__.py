"""Engines as shipped beside the same set up for physics, of a run in both setups."""
