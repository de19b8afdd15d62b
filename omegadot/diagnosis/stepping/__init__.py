"""Causes in how a state leads to the next: other schemes, steps, forces and limits."""
