"""``omegadot engines``: what is installed and how each engine is set up."""
