"""``omegadot findings``: where engines diverge, measured in a record and again by a bare script."""
