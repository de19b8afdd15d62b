"""The engine's end: a process that serves one adapter. NumPy and SciPy at most."""
