"""Causes in what is reported of sound steps: frames, orders, clocks and samples."""
