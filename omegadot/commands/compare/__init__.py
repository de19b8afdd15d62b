"""``omegadot compare``: what changed from one record to another."""
