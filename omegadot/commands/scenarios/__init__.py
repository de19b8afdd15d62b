"""``omegadot scenarios``: what is built in."""
