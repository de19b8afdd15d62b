"""``omegadot score``: a trajectory of any simulator or log, against the exact solution."""
