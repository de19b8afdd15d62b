"""Requests beyond the runs of the plan: truth, first steps, restarts, repetitions."""
