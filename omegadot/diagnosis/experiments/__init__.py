"""Experiments: one thing of a system is changed at a time, and it is seen whether a fault stays."""
