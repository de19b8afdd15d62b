"""``omegadot fit``: moments of inertia, bias and damping from a trace of omega."""
